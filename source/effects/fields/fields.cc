// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/fields/fields.h>

#include <deal.II/base/mpi.h>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/strong_components.hpp>
#include <boost/property_map/property_map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace Morula
{
  namespace
  {
    /** Fields that depend on each other are found again until they change by so
     *  little, relative to the largest value, but not more often. */
    constexpr double       small_difference = 1e-9;
    constexpr double       exact_difference = 1e-11;
    constexpr unsigned int most_turns       = 50;

    /** Refuses a condition that holds at @p n boundary points of this rank, and
     *  at none of others. Collective. */
    void
    check_holds(const ExpressionKey         &where,
                const types::particle_index &n,
                const MPI_Comm               comm)
    {
      // A condition that holds nowhere is most likely a mistake.
      if (!where.empty() && Utilities::MPI::sum(n, comm) == 0)
        where.refuse("a condition that holds at some boundary point",
                     "It is positive at none: correct it, or leave it empty. "
                     "Boundary points sit at centers of surface patches, not "
                     "on edges or corners.");
    }
  } // namespace


  template <int dim>
  Fields<dim>::Fields(const FieldsParameters   &parameters,
                      const EffectSetting<dim> &setting)
    : parameters_(parameters)
  {
    // Numbers follow the order of the names; the order in which fields are
    // found is another one.
    for (const FieldKeys &keys : parameters.fields)
      fields.emplace_back(keys, fields.size(), setting);
    order();
    setting.state.declare_fields(setting.columns);
    columns   = setting.state.fields;
    gradients = setting.state.gradients;
  }


  template <int dim>
  void
  Fields<dim>::begin(const CellView<dim, double> &cell) const
  {
    const Point<dim> X = cell.founder_position();
    for (unsigned int k = 0; k < fields.size(); ++k)
      {
        cell.set(columns[k], fields[k].initial(X));
        if (!gradients[k].exists())
          continue;
        // Founders that divide along a gradient ask for it before any step.
        const double   delta = std::pow(cell.initial_volume(), 1. / dim) / 100.;
        Tensor<1, dim> gradient;
        for (unsigned int d = 0; d < dim; ++d)
          {
            Point<dim> before(X), behind(X);
            before[d] -= delta;
            behind[d] += delta;
            gradient[d] =
              (fields[k].initial(behind) - fields[k].initial(before)) /
              (2. * delta);
          }
        cell.set(gradients[k], gradient);
      }
  }


  template <int dim>
  void
  Fields<dim>::check_cell(const PresentCell<dim> &founder, const double) const
  {
    for (unsigned int k = 0; k < fields.size(); ++k)
      {
        // Each expression is evaluated once, so that a bad one is refused
        // before the run begins. The uptake sets the field, so it gets a cell
        // of its own.
        PresentCell<dim> cell(founder);
        fields[k].diffusion(cell, 0.);
        fields[k].production(cell, 0.);
        fields[k].uptake(cell, 0., founder.cell().get(columns[k]), 1.);
      }
  }


  template <int dim>
  void
  Fields<dim>::check_surface(const std::vector<Point<dim>> &X,
                             const MPI_Comm                 comm) const
  {
    for (unsigned int k = 0; k < fields.size(); ++k)
      {
        // Values are evaluated for their rules; that a point is fixed or takes
        // a flux is counted over all ranks.
        types::particle_index n_fixed = 0, n_of_flux = 0;
        everywhere(comm, [&]() {
          for (const Point<dim> &place : X)
            if (fields[k].acts_on(place))
              {
                n_fixed += fields[k].is_fixed(place);
                n_of_flux += fields[k].takes_flux(place);
                fields[k].value(place, 0.);
                fields[k].transfer(place, 0.);
                fields[k].flux(place, 0.);
              }
        });
        check_holds(parameters_.fields[k].fixed_where, n_fixed, comm);
        check_holds(parameters_.fields[k].flux_where, n_of_flux, comm);
      }
  }


  template <int dim>
  FieldsOfStep<dim>
  Fields<dim>::find(const FieldKind   kind,
                    FieldSolver<dim> &solver,
                    const double      t0,
                    const double      t1) const
  {
    // Groups come in an order in which each finds what it depends on. All
    // fields of a group are of one kind.
    FieldsOfStep<dim> found;
    for (const auto &group : groups)
      if (fields[group.front()].kind() == kind)
        for (FieldSolution<dim> &field : find_group(group, solver, t0, t1))
          found.push_back(std::move(field));
    return found;
  }


  template <int dim>
  void
  Fields<dim>::order()
  {
    // Boost's strong components are sets of fields that depend on each other,
    // in the order that is wanted: what others depend on first. Fields of the
    // other kind have their values already.
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS> uses(
      fields.size());
    for (unsigned int k = 0; k < fields.size(); ++k)
      for (unsigned int other = 0; other < fields.size(); ++other)
        if (fields[k].kind() == fields[other].kind() &&
            fields[k].depends_on(other))
          boost::add_edge(k, other, uses);
    std::vector<unsigned int> component(fields.size());
    groups.resize(boost::strong_components(
      uses,
      boost::make_iterator_property_map(
        component.begin(), boost::get(boost::vertex_index, uses))));
    for (unsigned int k = 0; k < fields.size(); ++k)
      groups[component[k]].push_back(k);
  }


  template <int dim>
  FieldsOfStep<dim>
  Fields<dim>::find_group(const std::vector<unsigned int> &group,
                          FieldSolver<dim>                &solver,
                          const double                     t0,
                          const double                     t1) const
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
        return fields[k].kind() == FieldKind::steady ||
               fields[k].is_nonlinear();
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


  template <int dim>
  void
  Fields<dim>::set(Tissue<dim> &tissue, const FieldsOfStep<dim> &of_step) const
  {
    for (const FieldSolution<dim> &field : of_step)
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        {
          const CellView<dim, double> cell = tissue.cell(p);
          cell.set(columns[field.number], field.values[p]);
          if (gradients[field.number].exists())
            cell.set(gradients[field.number], field.gradients[p]);
        }
  }


  template <int dim>
  void
  Fields<dim>::describe(const Tissue<dim> &tissue, NamedNumbers &numbers) const
  {
    const Cells<dim> &cells = tissue.cells();
    for (unsigned int k = 0; k < fields.size(); ++k)
      {
        // One pass over the cells of this rank for each field; the mean is over
        // the volume, as that of an amount.
        double least = std::numeric_limits<double>::infinity(), most = -least;
        double amount = 0., volume = 0.;
        for (unsigned int p = 0; p < cells.size(); ++p)
          {
            const double c = cells[p].get(columns[k]);
            least          = std::min(least, c);
            most           = std::max(most, c);
            amount += c * cells.volume(p);
            volume += cells.volume(p);
          }
        const MPI_Comm comm = tissue.communicator();
        least               = Utilities::MPI::min(least, comm);
        most                = Utilities::MPI::max(most, comm);
        amount              = Utilities::MPI::sum(amount, comm);
        volume              = Utilities::MPI::sum(volume, comm);
        // Without cells all quantities are 0.
        const std::string &name = fields[k].name();
        numbers[name + "_min"]  = volume > 0. ? least : 0.;
        numbers[name + "_mean"] = volume > 0. ? amount / volume : 0.;
        numbers[name + "_max"]  = volume > 0. ? most : 0.;
      }
  }


  template class Fields<2>;
  template class Fields<3>;
} // namespace Morula
