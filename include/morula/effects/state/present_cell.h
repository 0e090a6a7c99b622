// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_present_cell_h
#define morula_effects_state_present_cell_h

#include <morula/base/past_step.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/state/state_columns.h>
#include <morula/mechanics/elastic_point.h>
#include <morula/mechanics/material.h>
#include <morula/particles/tissue.h>

#include <deal.II/particles/property_pool.h>

#include <cmath>
#include <cstdint>
#include <optional>

namespace Morula
{
  using namespace dealii;

  template <int dim>
  class Proliferation;

  /** What all cells of a scene share at one moment, for code that reads their
   *  variables. Refers to objects that must outlive it. */
  template <int dim>
  struct CellReader
  {
    /** The columns of the cells' state. */
    const StateColumns<dim> &columns;
    /** The cells' material. */
    const TissueMaterial &material;
    /** The cell cycle, or null. */
    const Proliferation<dim> *cycle;
    /** The seed of the scene. */
    std::uint64_t random_seed;
    /** The time of the cells' state, day. */
    double time;
    /** The step that led to it. */
    PastStep past = {};

    /** The phase of a cell, by its number in cells-NNNN.csv. */
    unsigned int
    phase(const CellView<dim, const double> &cell) const;
  };

  /**
   * A cell in its state at one moment, as effects and their expressions see it.
   * Its values are computed when they are first asked for. Does not own the
   * cell's row, nor the reader.
   */
  template <int dim>
  class PresentCell
  {
  public:
    /**
     * @param position x, µm
     * @param reader   must outlive this
     */
    PresentCell(const CellView<dim, const double> &cell,
                const types::particle_index        id,
                const Point<dim>                  &position,
                const CellReader<dim>             &reader)
      : cell_(cell)
      , id_(id)
      , position_(position)
      , reader_(reader)
    {}

    /** The cell's id. */
    types::particle_index
    id() const
    {
      return id_;
    }

    /** The reader that evaluates its expressions. */
    const CellReader<dim> &
    reader() const
    {
      return reader_;
    }

    /** The cell with all its columns. */
    const CellView<dim, const double> &
    cell() const
    {
      return cell_;
    }

    /** x, µm. */
    const Point<dim> &
    position() const
    {
      return position_;
    }

    /** Number of the type; 0 if the scene has no types. */
    unsigned int
    type() const
    {
      // Without types in the scene there is no column, and all cells are of
      // type 0.
      return reader_.columns.type.exists() ? cell_.get(reader_.columns.type) :
                                             0;
    }

    /** Key of the cell's random numbers. */
    std::uint64_t
    lineage_key() const
    {
      // Where nothing divides, every cell is its own founder and its key
      // follows from its id.
      const Column<std::uint64_t> &key = cell_.columns().lineage_key;
      return key.exists() ? cell_.get(key) :
                            Random::founder_key(reader_.random_seed, id_);
    }

    /** Outward unit normal of the surface near the founder, at t = 0. Only if
     *  StateColumns::need_surface_normal() asked for it. */
    Tensor<1, dim>
    surface_normal() const
    {
      return cell_.get(reader_.columns.surface_normal);
    }

    /** Gradient of a field by its number, per µm, in the configuration in which
     *  the field was solved; zero before. Only if StateColumns::need_gradient()
     *  asked for it. */
    Tensor<1, dim>
    gradient(const unsigned int field) const
    {
      return cell_.get(reader_.columns.gradients[field]);
    }

    /** Sets the value of a field, which is given by its number, in this object.
     */
    void
    set_field(const unsigned int field, const double value)
    {
      // The value is put where provide() would put it, and counts as known. No
      // other variable depends on fields, so nothing else has to be computed
      // again.
      const auto variable = static_cast<unsigned int>(field_variable(field));
      values[variable]    = value;
      known |= std::uint64_t(1) << variable;
    }

    /** F_e, equation (1.3). */
    Tensor<2, dim>
    elastic() const
    {
      return cell_.elastic_deformation();
    }

    /** Volumes and Ψ: cheaper than quantities(). */
    CellScalars
    scalars() const
    {
      // If the stress was computed before, the scalars are part of it;
      // otherwise the cheaper computation without the tensors is enough.
      return quantities_ ?
               *quantities_ :
               cell_scalars(cell_, reader_.material.material(), lame());
    }

    /** Volumes, Ψ and the true stress σ, kPa. */
    const CellQuantities &
    quantities() const;

    /** λ and μ, kPa. @throws InputError for E or ν out of range */
    Lame
    lame() const
    {
      // Moduli that depend on X alone are those of the founder and need no
      // state. Else they are expressions of the present cell; they cannot read
      // the stress, which needs them.
      const TissueMaterial &material = reader_.material;
      if (!material.depends_on_state())
        return material.lame_at(cell_.founder_position());
      return Morula::lame(value(material.youngs_modulus(), reader_.time),
                          value(material.poissons_ratio(), reader_.time));
    }

    /** The value of an expression that came from StateColumns::use(), at time
     *  @p t (day). @throws InputError if it is not finite */
    double
    value(const Expression  &expression,
          const double       t,
          const unsigned int component = 0) const
    {
      provide(expression.used(), t);
      return expression.value(values, component);
    }

    /** The value of a variable that some effect has announced to StateColumns,
     *  at @p t (day). */
    double
    value(const Variable variable, const double t) const
    {
      provide({variable}, t);
      return values[static_cast<unsigned int>(variable)];
    }

    /** The first dim components. @throws InputError */
    Tensor<1, dim>
    vector(const Expression &expression, const double t) const
    {
      provide(expression.used(), t);
      Tensor<1, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = expression.value(values, d);
      return result;
    }

    /** The values of the variables of an expression at @p t, for code that
     *  changes some of them and evaluates it again. */
    VariableValues
    variables(const Expression &expression, const double t) const
    {
      provide(expression.used(), t);
      return values;
    }

    /** The value that an expression would have if the cell had grown
     *  isotropically by the factor @p ratio in volume while F stayed, as in a
     *  confined cell. @throws InputError */
    double
    value_if_grown(const Expression &expression,
                   const double      t,
                   const double      ratio) const
    {
      // The cell is copied with a larger F_g and the same F, as if it had grown
      // in a place that does not give way: doc/theory.md (10.4). The volume of
      // growth is multiplied by `ratio`, so each length by its root.
      const CellColumns<dim>     &columns = cell_.columns();
      std::vector<double>         row(cell_.row().begin(), cell_.row().end());
      const CellView<dim, double> grown(make_array_view(row), columns);
      grown.set(columns.growth, std::pow(ratio, 1. / dim) * cell_.growth());
      return PresentCell(grown, id_, position_, reader_).value(expression, t);
    }

  private:
    /** Sets the values that are in the list, if they are not yet known. */
    void
    provide(const std::vector<Variable> &variables, const double t) const;
    double
    compute(const Variable variable, const double t) const;

    CellView<dim, const double>           cell_;
    types::particle_index                 id_;
    Point<dim>                            position_;
    const CellReader<dim>                &reader_;
    mutable VariableValues                values;
    mutable std::uint64_t                 known = 0; // a bit for each variable
    mutable std::optional<CellQuantities> quantities_;
  };

  /** Cell number @p p of the tissue as it is now. */
  template <int dim>
  PresentCell<dim>
  present_cell(const Tissue<dim>     &tissue,
               const unsigned int     p,
               const CellReader<dim> &reader);
} // namespace Morula

#endif
