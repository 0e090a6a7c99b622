// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/key.h>
#include <morula/effects/fields/fields.h>

#include <deal.II/base/mpi.h>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/strong_components.hpp>
#include <boost/property_map/property_map.hpp>

#include <algorithm>
#include <vector>

namespace Morula
{
  namespace
  {
    /** k c is differentiated by such differences of c, relative to c and to the
     *  field's scale. They are so small that k does not change its kind, as at
     *  a threshold, and so large that k is told from rounding. */
    constexpr double difference = 1e-6, smallest_difference = 1e-9;
  } // namespace


  template <int dim>
  Field<dim>::Field(const FieldKeys          &keys,
                    const unsigned int        number,
                    const EffectSetting<dim> &setting)
    : name(keys.name)
    , kind(keys.is_steady() ? FieldKind::steady : FieldKind::transient)
    , diffusion(setting.state.use(keys.diffusion))
    , production(setting.state.use(keys.production))
    , initial(keys.initial.expression(dim))
    , value(keys.value.expression(dim))
    , number(number)
    , diluted(keys.dilution)
    , consumption(setting.state.use(keys.consumption))
    , fixed_where(keys.fixed_where.optional(dim))
    , transfer_(keys.transfer.optional(dim))
    , flux_(keys.flux.optional(dim))
    , flux_where(keys.flux_where.optional(dim))
  {}


  template <int dim>
  Uptake
  Field<dim>::uptake(PresentCell<dim> &cell,
                     const double      t,
                     const double      c,
                     const double      scale) const
  {
    // A rate that does not read the field has itself as its slope.
    if (!consumption.uses(field_variable(number)))
      {
        const double k = cell.value(consumption, t);
        return {k * c, k};
      }
    // The difference goes upwards, so that c stays in the range that the
    // expression was written for. A negative slope would make the matrix
    // indefinite, so it counts as 0: doc/theory.md (11.4).
    const double more =
      c + std::max(difference * c, smallest_difference * scale);
    const double used_more = used(cell, t, more), used_now = used(cell, t, c);
    return {used_now, std::max(0., (used_more - used_now) / (more - c))};
  }


  template class Field<2>;
  template class Field<3>;


  template <int dim>
  unsigned int
  FieldSolver<dim>::check_sink(const Field<dim> &field) const
  {
    // Nothing diffuses from piece to piece, so each needs a sink of its own.
    // The sums of all ranks are added up, as a piece may run through several:
    // what takes from the field, what gives to it, and the number of cells.
    const unsigned int  n = space.n_pieces();
    std::vector<double> sums(3 * n, 0.);
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        const auto   &grid_cell = space.grid_cells()[c];
        double *const of =
          &sums[3 * space.piece(grid_cell.number, grid_cell.part)];
        for (unsigned int k = equation.cell_places.offsets[c];
             k < equation.cell_places.offsets[c + 1];
             ++k)
          {
            of[0] += equation.cells[k].volume * equation.cells[k].rate;
            of[1] += equation.cells[k].volume * equation.cells[k].load;
            of[2] += 1.;
          }
        if (equation.surface.empty())
          continue;
        for (unsigned int k = equation.surface_places.offsets[c];
             k < equation.surface_places.offsets[c + 1];
             ++k)
          {
            const FieldAtSurface<dim> &point = equation.surface[k];
            of[0] += point.weight + point.fixed;
            of[1] += point.inflow;
          }
      }
    Utilities::MPI::sum(sums, tissue.communicator(), sums);
    unsigned int n_nothing = 0, n_determined = 0;
    bool         grows = false;
    for (unsigned int p = 0; p < n; ++p)
      {
        const bool has_cells = sums[3 * p + 2] > 0., sinks = sums[3 * p] > 0.;
        n_determined += sinks;
        n_nothing += has_cells && !sinks;
        grows = grows || (has_cells && !sinks && sums[3 * p + 1] > 0.);
      }
    if (n_determined == 0 || grows)
      throw InputError(
        "Fields/" + field.name + "/Consumption",
        "",
        "a rate > 0 1/day at some cell, or a value or a transfer > 0 at some "
        "boundary point, of each separate part of the tissue in which "
        "something makes the field",
        "Without a sink a steady field has no level: any constant could be "
        "added to it. Dead cells take nothing.");
    return n_nothing;
  }

  template class FieldSolver<2>;
  template class FieldSolver<3>;


  template <int dim>
  std::vector<std::vector<unsigned int>>
  groups_of(const std::vector<Field<dim>> &fields)
  {
    // Boost's strong components are sets of fields that depend on each other,
    // in the order that is wanted: what others depend on first. Fields of the
    // other kind have their values already.
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS> uses(
      fields.size());
    for (unsigned int k = 0; k < fields.size(); ++k)
      for (unsigned int other = 0; other < fields.size(); ++other)
        if (fields[k].kind == fields[other].kind && fields[k].depends_on(other))
          boost::add_edge(k, other, uses);
    std::vector<unsigned int>              component(fields.size());
    std::vector<std::vector<unsigned int>> groups(boost::strong_components(
      uses,
      boost::make_iterator_property_map(
        component.begin(), boost::get(boost::vertex_index, uses))));
    for (unsigned int k = 0; k < fields.size(); ++k)
      groups[component[k]].push_back(k);
    return groups;
  }


  namespace
  {
    /** Fields that depend on each other are found again until they change by so
     *  little, relative to the largest value, but not more often. */
    constexpr double       small_difference = 1e-9;
    constexpr double       exact_difference = 1e-11;
    constexpr unsigned int most_turns       = 50;
  } // namespace


  template <int dim>
  FieldsOfStep<dim>
  find_group(const std::vector<Field<dim>>   &fields,
             const std::vector<unsigned int> &group,
             FieldSolver<dim>                &solver,
             const double                     t0,
             const double                     t1)
  {
    // A field that depends on none of its group is solved once. Fields that
    // depend on each other are solved in turns, each with the latest values of
    // the others, until none changes any more. If they do not agree after many
    // turns all are marked, and the caller says so.
    const auto solve = [&]() {
      FieldsOfStep<dim> found;
      for (const unsigned int k : group)
        found.push_back(solver.field(fields[k], k, t0, t1));
      return found;
    };
    FieldsOfStep<dim> found = solve();
    if (group.size() == 1)
      return found;
    std::vector<double> first;
    for (const FieldSolution<dim> &field : found)
      first.push_back(solver.size(field.values));
    // Each sees the latest values of the others. Where all are linear their
    // amounts can be balanced to rounding.
    const bool is_exact =
      std::none_of(group.begin(), group.end(), [&](const unsigned int k) {
        return fields[k].kind == FieldKind::steady || fields[k].is_nonlinear();
      });
    for (unsigned int turn = 0; turn < most_turns; ++turn)
      {
        const FieldsOfStep<dim> before = std::move(found);
        found                          = solve();
        double change                  = 0.;
        for (std::size_t i = 0; i < found.size(); ++i)
          {
            found[i].change =
              solver.relative_change(before[i].values, found[i].values);
            found[i].iterations += before[i].iterations;
            change = std::max(change, found[i].change);
          }
        // The last change is what the amounts of the group miss.
        if (change <= (is_exact ? exact_difference : small_difference))
          return found;
      }
    for (std::size_t i = 0; i < found.size(); ++i)
      {
        found[i].converged = false;
        if (first[i] > 0.)
          found[i].growth = solver.size(found[i].values) / first[i];
      }
    return found;
  }


  MORULA_INSTANTIATE(groups_of);
  MORULA_INSTANTIATE(find_group);
} // namespace Morula
