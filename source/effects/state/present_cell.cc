// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/fate/proliferation.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/symmetric_tensor.h>

namespace Morula
{
  namespace
  {
    /** The von Mises stress. It has all components in plane strain, too: σ_zz
     * is not zero there. */
    double
    von_mises(const SymmetricTensor<2, 3> &sigma)
    {
      return std::sqrt(1.5) * deviator(sigma).norm();
    }
  } // namespace


  template <int dim>
  unsigned int
  CellReader<dim>::phase(const CellView<dim, const double> &cell) const
  {
    // This is the number that the outputs have for cells outside any cycle.
    constexpr unsigned int does_not_proliferate = 9;
    return cycle == nullptr ?
             does_not_proliferate :
             cycle->cycle().phase_number(cycle->clock(cell),
                                         cell.founder_position(),
                                         time);
  }


  template <int dim>
  const CellQuantities &
  PresentCell<dim>::quantities() const
  {
    // Stress and energy are computed at most once for a cell, as several
    // expressions may ask for them. A PresentCell is made anew for each cell
    // and step, so they cannot become stale.
    if (!quantities_)
      quantities_ = cell_quantities(cell_,
                                    reader_.material.material(),
                                    lame(),
                                    reader_.material.per_grown_volume());
    return *quantities_;
  }


  template <int dim>
  void
  PresentCell<dim>::provide(const std::vector<Variable> &variables,
                            const double                 t) const
  {
    // Variables are computed when an expression asks for them and kept in
    // `values`, with one bit in `known` for each. X and t are cheap and are
    // always set; ages and t follow the time and are set anew.
    if (variables.empty())
      return;
    // Messages of errors name X in any case, whether the expression uses it or
    // not.
    const Point<dim> X = cell_.founder_position();
    for (unsigned int d = 0; d < 3; ++d)
      values[d] = d < dim ? X[d] : 0.;
    values[static_cast<unsigned int>(Variable::t)] = t;
    for (const Variable variable : variables)
      {
        static_assert(n_variables + most_fields <= 64, "Bits of `known`.");
        const auto bit = std::uint64_t(1)
                         << static_cast<unsigned int>(variable);
        if (variable <= Variable::t)
          continue;
        // Ages depend on the time of this call, so what is known of them may be
        // of another time.
        if ((known & bit) != 0 && variable != Variable::age &&
            variable != Variable::type_age)
          continue;
        values[static_cast<unsigned int>(variable)] = compute(variable, t);
        known |= bit;
      }
  }


  template <int dim>
  double
  PresentCell<dim>::compute(const Variable variable, const double t) const
  {
    // Positions are present ones, while X is the founder's. Stresses are Cauchy
    // stresses per present area; pressure is positive where tissue is squeezed.
    // Columns that are read exist, because the expression announced its
    // variables to StateColumns.
    const StateColumns<dim> &columns = reader_.columns;
    if (is_field(variable))
      {
        const unsigned int k        = field_number(variable);
        const unsigned int n_fields = columns.field_names().size();
        const unsigned int n        = columns.n_before_neighbours();
        if (k < n)
          return cell_.get(k < n_fields ? columns.fields[k] :
                                          columns.numbers[k - n_fields]);
        const NeighbourVariable &told = columns.neighbour_variables()[k - n];
        return told.kind == NeighbourVariable::slope ?
                 gradient(told.number).norm() :
                 cell_.get(columns.neighbours[k - n]);
      }
    switch (variable)
      {
        case Variable::x:
          return position_[0];
        case Variable::y:
          return position_[1];
        case Variable::z:
          // The index is valid in 2-D as well, where this branch is compiled
          // but not taken.
          return dim == 3 ? position_[dim - 1] : 0.;
        case Variable::generation:
          return cell_.generation();
        case Variable::age:
          return t - cell_.get(columns.birth_time);
        case Variable::type_age:
          return t - cell_.get(columns.type_since);
        case Variable::cycle_phase:
          return reader_.phase(cell_);
        case Variable::type:
          return type();
        case Variable::volume:
          return cell_.volume();
        case Variable::growth:
          return determinant(cell_.growth());
        case Variable::J_e:
          return cell_.elastic_volume_ratio();
        case Variable::pressure:
          return -trace(quantities().stress) / 3.;
        case Variable::tension:
          // deal.II sorts eigenvalues in descending order: the first is the
          // most tensile.
          return eigenvalues(quantities().stress)[0];
        case Variable::shear:
          return von_mises(quantities().stress);
        case Variable::energy:
          return quantities().energy_density;
        case Variable::depth:
          return cell_.get(columns.depth);
        case Variable::present_depth:
          return cell_.get(columns.present_depth);
        case Variable::noise:
          return Random::noise(reader_.random_seed, lineage_key());
        default:
          Assert(false, ExcInternalError());
          return 0.;
      }
  }


  template <int dim>
  PresentCell<dim>
  present_cell(const Tissue<dim>     &tissue,
               const unsigned int     p,
               const CellReader<dim> &reader)
  {
    // The number p is that of the store of this rank; the id is global.
    const Cells<dim> &cells = tissue.cells();
    return {cells[p], cells.id(p), cells.position(p), reader};
  }


  template struct CellReader<2>;
  template struct CellReader<3>;
  template class PresentCell<2>;
  template class PresentCell<3>;
  MORULA_INSTANTIATE(present_cell);
} // namespace Morula
