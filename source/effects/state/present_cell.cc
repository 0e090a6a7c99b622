// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/random.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/symmetric_tensor.h>

#include <array>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** The von Mises stress. */
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
    constexpr unsigned int does_not_proliferate = 9;
    return cycle == nullptr ? does_not_proliferate :
                              cycle->phase_number(clock->load(cell),
                                                  cell.founder_position(),
                                                  time);
  }


  template <int dim>
  PresentCell<dim>::PresentCell(const CellView<dim, const double> &cell,
                                const types::particle_index        id,
                                const Point<dim>                  &position,
                                const CellReader<dim>             &reader)
    : cell_(cell)
    , id_(id)
    , position_(position)
    , reader_(reader)
  {}


  template <int dim>
  types::particle_index
  PresentCell<dim>::id() const
  {
    return id_;
  }


  template <int dim>
  const CellReader<dim> &
  PresentCell<dim>::reader() const
  {
    return reader_;
  }


  template <int dim>
  const CellView<dim, const double> &
  PresentCell<dim>::cell() const
  {
    return cell_;
  }


  template <int dim>
  const Point<dim> &
  PresentCell<dim>::position() const
  {
    return position_;
  }


  template <int dim>
  unsigned int
  PresentCell<dim>::type() const
  {
    return reader_.columns.type.exists() ? cell_.get(reader_.columns.type) : 0;
  }


  template <int dim>
  std::uint64_t
  PresentCell<dim>::lineage_key() const
  {
    // Without a cell cycle every cell is its own founder.
    return reader_.clock != nullptr ?
             reader_.clock->lineage_key(cell_) :
             Random::founder_key(reader_.random_seed, id_);
  }


  template <int dim>
  Tensor<1, dim>
  PresentCell<dim>::surface_normal() const
  {
    return cell_.get(reader_.columns.surface_normal);
  }


  template <int dim>
  Tensor<1, dim>
  PresentCell<dim>::gradient(const unsigned int field) const
  {
    return cell_.get(reader_.columns.gradients[field]);
  }


  template <int dim>
  void
  PresentCell<dim>::set_field(const unsigned int field, const double value)
  {
    // No other variable depends on fields.
    const auto variable = static_cast<unsigned int>(field_variable(field));
    values[variable]    = value;
    known |= std::uint64_t(1) << variable;
  }


  template <int dim>
  Tensor<2, dim>
  PresentCell<dim>::elastic() const
  {
    return cell_.elastic_deformation();
  }


  template <int dim>
  Lame
  PresentCell<dim>::lame() const
  {
    const TissueMaterial &material = reader_.material;
    if (!material.depends_on_state())
      return material.lame_at(cell_.founder_position());
    return Morula::lame(value(material.youngs_modulus(), reader_.time),
                        value(material.poissons_ratio(), reader_.time));
  }


  template <int dim>
  CellScalars
  PresentCell<dim>::scalars() const
  {
    return has_quantities ?
             quantities_ :
             cell_scalars(cell_, reader_.material.material(), lame());
  }


  template <int dim>
  const CellQuantities &
  PresentCell<dim>::quantities() const
  {
    if (!has_quantities)
      quantities_ = cell_quantities(cell_,
                                    reader_.material.material(),
                                    lame(),
                                    reader_.material.per_grown_volume());
    has_quantities = true;
    return quantities_;
  }


  template <int dim>
  double
  PresentCell<dim>::value(const Expression  &expression,
                          const double       t,
                          const unsigned int component) const
  {
    provide(expression.used(), t);
    return expression.value(values, component);
  }


  template <int dim>
  Tensor<1, dim>
  PresentCell<dim>::vector(const Expression &expression, const double t) const
  {
    provide(expression.used(), t);
    Tensor<1, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = expression.value(values, d);
    return result;
  }


  template <int dim>
  VariableValues
  PresentCell<dim>::variables(const Expression &expression,
                              const double      t) const
  {
    provide(expression.used(), t);
    return values;
  }


  template <int dim>
  double
  PresentCell<dim>::value_if_grown(const Expression &expression,
                                   const double      t,
                                   const double      ratio) const
  {
    const CellColumns<dim>     &columns = cell_.columns();
    std::vector<double>         row(cell_.row().begin(), cell_.row().end());
    const CellView<dim, double> grown(make_array_view(row), columns);
    grown.set(columns.growth, std::pow(ratio, 1. / dim) * cell_.growth());
    return PresentCell(grown, id_, position_, reader_).value(expression, t);
  }


  template <int dim>
  void
  PresentCell<dim>::provide(const std::vector<Variable> &variables,
                            const double                 t) const
  {
    if (variables.empty())
      return;
    // Messages give them in any case.
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
        // Ages have changed if the time has.
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
    const StateColumns<dim> &columns = reader_.columns;
    if (is_field(variable))
      return cell_.get(columns.fields[field_number(variable)]);
    switch (variable)
      {
        case Variable::x:
          return position_[0];
        case Variable::y:
          return position_[1];
        case Variable::z:
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
          return eigenvalues(quantities().stress)[0];
        case Variable::shear:
          return von_mises(quantities().stress);
        case Variable::energy:
          return quantities().energy_density;
        case Variable::depth:
          return cell_.get(columns.depth);
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
    const Cells<dim> &cells = tissue.cells();
    return {cells[p], cells.id(p), cells.position(p), reader};
  }


  template struct CellReader<2>;
  template struct CellReader<3>;
  template class PresentCell<2>;
  template class PresentCell<3>;
  template PresentCell<2>
  present_cell(const Tissue<2> &, const unsigned int, const CellReader<2> &);
  template PresentCell<3>
  present_cell(const Tissue<3> &, const unsigned int, const CellReader<3> &);
} // namespace Morula
