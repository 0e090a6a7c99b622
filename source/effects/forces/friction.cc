// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/step_failed.h>
#include <morula/effects/fields/fields.h>
#include <morula/effects/scene_keys.h>
#include <morula/mechanics/point_term.h>

namespace Morula
{
  namespace
  {
    /** Section "Friction". */
    struct FrictionParameters : public EffectKeys
    {
      FrictionParameters()
      {
        per.needs({coefficient.path()});
        per.with("paper", "initial volume");
      }

      ExpressionKey coefficient{
        {this, "Friction/Coefficient"},
        "0",
        "Friction of cells, also inside of the tissue, with surroundings at "
        "rest: the force on a cell per volume (see Per) is minus this times "
        "its velocity; >= 0. An expression. Units: kPa day/um^2.",
        Evaluated::step,
        not_negative("kPa day/um^2", "0 is no friction.")};

      Key<std::string> per{
        {this, "Friction/Per"},
        "current volume",
        "The volume to which Coefficient refers. current volume: that of the "
        "cell at the beginning of the step, so that grown tissue has more "
        "friction. initial volume: it is halved at every division.",
        {"current volume|initial volume"}};

      bool
      is_on() const override
      {
        // A type of cells may set the key in its own section and leave the
        // scene's at its default.
        return coefficient.is_changed();
      }
    };

    /** Friction of cells with surroundings that stand still: doc/theory.md
     * (4.7a). Its coefficient is that of the cell's state at the beginning of a
     * step. */
    template <int dim>
    class Friction : public Force<dim>
    {
    public:
      using Parameters = FrictionParameters;

      /** @throws InputError for an expression that cannot be parsed */
      Friction(const Parameters &parameters, const EffectSetting<dim> &setting)
        : coefficient(setting.state.use(parameters.coefficient))
        , per_current_volume(parameters.per == "current volume")
      {}

      std::unique_ptr<Term<dim>>
      term(const Tissue<dim>        &tissue,
           const CellReader<dim>    &reader,
           const GroupedPoints<dim> &positions,
           const double              t0,
           const double              t1) const override
      {
        // The velocity of backward Euler's method is u/Δt, so that friction
        // acts as a spring of stiffness V ζ/Δt from where the cell is at the
        // beginning of the step: doc/theory.md (4.7a). In no time nothing moves
        // against it.
        if (!(t1 > t0))
          throw StepFailed("friction takes time");
        std::vector<double> stiffnesses = friction(tissue, reader, t0);
        for (unsigned int p = 0; p < tissue.cells().size(); ++p)
          stiffnesses[p] *=
            (per_current_volume ? tissue.cells()[p].carried_volume() :
                                  tissue.cells().initial_volume(p)) /
            (t1 - t0);
        return std::make_unique<Drag<dim>>(positions, std::move(stiffnesses));
      }

      std::vector<double>
      friction(const Tissue<dim>     &tissue,
               const CellReader<dim> &reader,
               const double           t0) const override
      {
        // These values also tell the equilibrium which pieces friction holds: a
        // rigid motion against it is not taken out of the step.
        std::vector<double> list;
        for (unsigned int p = 0; p < tissue.cells().size(); ++p)
          list.push_back(*friction_of(present_cell(tissue, p, reader), t0));
        return list;
      }

      std::optional<double>
      friction_of(const PresentCell<dim> &cell, const double t0) const override
      {
        return cell.value(coefficient, t0);
      }

      void
      check(const Preview<dim> &scene) const override
      {
        if (coefficient.depends_on_state())
          return;
        // The end time is one sample: a coefficient that falls with time is
        // smallest there.
        for (const Point<dim> &X : scene.founders)
          coefficient.value(X, scene.keys.time.end_time);
      }

    private:
      const Expression coefficient;
      const bool       per_current_volume;
    };
  } // namespace


  void
  add_friction(Catalogue &catalogue)
  {
    catalogue.add_own<Friction>(
      "friction",
      {"Growth/Law=isotropic",
       "Growth/Isotropic/Stretch=1 + 0.1*t*(1 + 0.1*X*Y)",
       "Friction/Coefficient=0.1"});
  }
} // namespace Morula
