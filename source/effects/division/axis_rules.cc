// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/division/directions.h>
#include <morula/effects/state/present_cell.h>

#include <optional>
#include <sstream>

// The library's own rules for `Proliferation/Cell cycle/Division axis`. If a
// cell has no state yet, as before the run, or its state singles out no
// direction, they take its random direction.

namespace Morula
{
  FixedAxisParameters::FixedAxisParameters()
  {
    axis.admit_commas();
  }

  namespace
  {
    /** `Division axis = fixed`: along a vector in the reference configuration.
     *  @throws InputError from axis() if the vector is zero */
    template <int dim>
    class FixedAxis : public DivisionRule<dim>
    {
    public:
      using Parameters = FixedAxisParameters;

      FixedAxis(const Parameters &parameters, const EffectSetting<dim> &setting)
        : direction(setting.state.use(parameters.axis))
      {
        // A vector that is zero for every cell is refused as the keys are read.
        // One that is zero for some cells is found as they enter S.
        if (direction.is_always(0., dim))
          parameters.axis.refuse(allowed(), remedy);
      }

      Tensor<1, dim>
      axis(const CellAtOnset<dim> &cell) const override
      {
        if (cell.present == nullptr)
          return cell.random;
        const Tensor<1, dim> vector =
          cell.present->vector(direction, cell.time);
        if (vector.norm() > 0.)
          return vector;
        std::ostringstream place;
        place << cell.founder_position;
        throw InputError(direction.key(),
                         direction.text(),
                         allowed() +
                           "; it is zero for the cell whose founder was at (" +
                           place.str() + ") um",
                         remedy);
      }

      /** Does nothing: check_cell() checks the founders that proliferate. */
      void
      check(const Preview<dim> &) const override
      {}

    private:
      static std::string
      allowed()
      {
        return "a vector of " + std::to_string(dim) +
               " components that is not zero";
      }

      static constexpr const char *remedy =
        "Give the direction along which cells divide, or set Division axis = "
        "random.";

      const Expression direction;
    };

    /** A rule that gives the axis of a present cell in the present
     *  configuration. */
    template <int dim>
    class PresentAxis : public DivisionRule<dim>
    {
    public:
      using Parameters = EffectKeys;

      bool
      is_present() const override
      {
        return true;
      }

      Tensor<1, dim>
      axis(const CellAtOnset<dim> &cell) const override
      {
        return cell.present == nullptr ?
                 cell.random :
                 this->direction(*cell.present, cell).value_or(cell.random);
      }

    protected:
      /** Of any length but zero, or nothing: at random. */
      virtual std::optional<Tensor<1, dim>>
      direction(const PresentCell<dim> &present,
                const CellAtOnset<dim> &cell) const = 0;
    };

    /** What a rule without keys follows, each by the value of `Division axis`.
     */
    enum class Along
    {
      /** The largest elastic stretch, (6.3a). */
      stretch,
      /** The most tensile stress, (6.3b): that at the beginning of the step,
       *  since the step is still to be solved. */
      stress,
      /** The normal n of (6.3c): what is stored is N of the point that was
       *  nearest to the founder at t = 0; F carries it to now. */
      surface_normal,
      /** The surface, uniform, m of (6.3c). */
      tangential,
      /** The longest axis of the cell, Hertwig's rule, doc/theory.md (6.10b). A
       *  cell's shape is the one that its founder's cube has got by the
       *  tissue's deformation, halved at each division across the axis. */
      cell_shape
    };

    template <Along along>
    struct AxisAlong
    {
      template <int dim>
      class Rule : public PresentAxis<dim>
      {
      public:
        Rule(const EffectKeys &, const EffectSetting<dim> &setting)
        {
          // The columns for normal and shape exist only where an effect asks
          // for them.
          if (along == Along::surface_normal || along == Along::tangential)
            setting.state.need_surface_normal();
          else
            setting.state.need(Variable::tension); // it follows the strain
          if (along == Along::cell_shape)
            setting.columns.need_shape();
        }

      protected:
        std::optional<Tensor<1, dim>>
        direction(const PresentCell<dim> &present,
                  const CellAtOnset<dim> &cell) const override
        {
          using namespace Directions;
          const double least = cell.least_anisotropy;
          if (along == Along::stretch)
            return of_largest_stretch(cell.elastic, least, cell.random);
          if (along == Along::stress)
            return of_largest_stress(present.quantities().stress,
                                     present.lame().mu,
                                     least,
                                     cell.random);
          if (along == Along::cell_shape)
            return of_largest_stretch(present.cell().shape(),
                                      least,
                                      cell.random);
          const Tensor<1, dim> normal =
            carried_normal(present.cell().F(), present.surface_normal());
          return along == Along::tangential ? across(normal, cell.random) :
                                              normal;
        }
      };
    };

    /** Key of `Division axis = radial`. */
    struct RadialAxisParameters : public EffectKeys
    {
      ExpressionKey center{
        {this, "Proliferation/Cell cycle/Radial center"},
        "0; 0; 0",
        "Point from which n_s points away for Division axis = radial. "
        "Expressions; 2-D: the first two. Units: um.",
        Evaluated::event,
        3};
    };

    /** `Division axis = radial`: from a point to where the cell is now. */
    template <int dim>
    class RadialAxis : public PresentAxis<dim>
    {
    public:
      using Parameters = RadialAxisParameters;

      RadialAxis(const Parameters         &parameters,
                 const EffectSetting<dim> &setting)
        : center(setting.state.use(parameters.center))
      {}

    protected:
      std::optional<Tensor<1, dim>>
      direction(const PresentCell<dim> &present,
                const CellAtOnset<dim> &cell) const override
      {
        const Tensor<1, dim> away =
          present.position() - Point<dim>(present.vector(center, cell.time));
        // A cell exactly at the center has no way out from it.
        return away.norm() > 0. ? away : cell.random;
      }

    private:
      const Expression center;
    };

    /** See gradient_axis(). */
    template <int dim>
    class GradientAxis : public PresentAxis<dim>
    {
    public:
      GradientAxis(const std::string &field, const EffectSetting<dim> &setting)
        : number(setting.state.need_gradient(field))
      {}

    protected:
      std::optional<Tensor<1, dim>>
      direction(const PresentCell<dim> &present,
                const CellAtOnset<dim> &cell) const override
      {
        const Tensor<1, dim> gradient = present.gradient(number);
        return gradient.norm() > 0. ? gradient : cell.random;
      }

    private:
      const unsigned int number; // of the field
    };

    /** Adds a rule, by which small balls of growing cells divide. */
    template <template <int> class Rule>
    void
    add_rule(Catalogue &catalogue, const std::string &name)
    {
      catalogue.add_own<Rule>(name,
                              {"Growth/Law=rate",
                               "Growth/Rate/Rate=J_e + 0.1*X*Y",
                               "Division by size/Volume=1.1",
                               "Proliferation/Cell cycle/Division axis=" + name,
                               "Proliferation/Cell cycle/Least anisotropy=1"});
    }
  } // namespace


  template <int dim>
  std::unique_ptr<const DivisionRule<dim>>
  gradient_axis(const std::string &field, const EffectSetting<dim> &setting)
  {
    return std::make_unique<const GradientAxis<dim>>(field, setting);
  }


  void
  add_division_rules(Catalogue &catalogue)
  {
    catalogue.add_own<FixedAxis>(
      "fixed",
      {"Proliferation/Law=cell cycle",
       "Proliferation/Cell cycle/Start=together",
       "Proliferation/Cell cycle/Duration=0.4",
       "Proliferation/Cell cycle/Division axis=fixed",
       "Proliferation/Cell cycle/Fixed axis=1; 1; 0"});
    add_rule<AxisAlong<Along::stretch>::Rule>(catalogue, "stretch");
    add_rule<AxisAlong<Along::stress>::Rule>(catalogue, "stress");
    add_rule<RadialAxis>(catalogue, "radial");
    add_rule<AxisAlong<Along::surface_normal>::Rule>(catalogue,
                                                     "surface normal");
    add_rule<AxisAlong<Along::tangential>::Rule>(catalogue, "tangential");
    add_rule<AxisAlong<Along::cell_shape>::Rule>(catalogue, "cell shape");
  }


  MORULA_INSTANTIATE(gradient_axis);
} // namespace Morula
