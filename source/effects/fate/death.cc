// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/end_at_rate.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/scene_keys.h>

#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    /** Section "Death". */
    struct DeathParameters : public EffectKeys
    {
      ExpressionKey rate{
        {this, "Death/Rate"},
        "0",
        "Rate at which cells die, an expression of their state; not "
        "negative. Units: 1/day.",
        Evaluated::step,
        not_negative("1/day", "0 lets cells live.")};

      /** > 0: at once */
      ExpressionKey when{
        {this, "Death/When"},
        "0",
        "Cells for which this is > 0 at the beginning of a step die then, "
        "those with Shrinking time = 0 at the end of one: an expression of "
        "their state. E.g. abs(X) < 20 && t >= 1, for a cut.",
        Evaluated::step};

      ExpressionKey shrinking_time{
        {this, "Death/Shrinking time"},
        "0.36",
        "How long a dead cell shrinks, linearly in its volume, until it is "
        "removed; not negative. 0: it is removed at once, as in a cut. An "
        "expression of the cell's state. Units: day.",
        Evaluated::event,
        not_negative("day", "0 removes cells at once.")};

      /** of that at death */
      ExpressionKey final_volume{
        {this, "Death/Final volume"},
        "0.05",
        "Part of its volume at death that a cell has when it is removed; > 0 "
        "and at most 1. An expression of the cell's state.",
        Evaluated::event,
        {[](const double part) { return part > 0. && part <= 1.; },
         "a number > 0 and at most 1",
         "It is the part of the cell's volume that is left."}};

      ExpressionKey keep_debris{
        {this, "Death/Keep debris"},
        "false",
        "Where this is true, dead cells stay at their final volume. "
        "false, true, or an expression of the cell's state, which is "
        "true if it is > 0.",
        Evaluated::event};

      bool
      is_on() const override
      {
        // Death has two switches: a rate or a condition that may ever hold.
        return !(rate.expression(3).is_always(0.) &&
                 when.expression(3).is_always(0.));
      }

      EffectFacts
      facts() const override
      {
        return {&rate};
      }

      bool
      loses_cells() const override
      {
        // What is taken away at t = 0 alone is part of the seeding.
        const auto condition = when.expression(3);
        return !rate.expression(3).is_always(0.) ||
               !shrinking_time.expression(3).is_always(0.) ||
               condition.depends_on_state() || condition.depends_on_time();
      }

      /** Refuses dead cells that shrink with the stiffness of whole ones. */
      void
      check(const SceneKeys &scene, Review &) const override
      {
        // Cells that go at once are never part of the balance of momentum as
        // dead ones, so they may have any weight. A cell that shrinks needs a
        // weight that shrinks with it.
        const bool shrink = !shrinking_time.expression(3).is_always(0.) ||
                            keep_debris.is_changed();
        if (is_on() && shrink && !scene.material.per_grown_volume())
          scene.material.energy_per.refuse(
            "grown volume, as cells die (" + rate.path() + " or " +
              when.path() + ") and shrink",
            "A shrunken cell would pull with the stiffness of a whole one. Cells "
            "may also go at once: " +
              shrinking_time.path() + " = 0.");
      }
    };

    /**
     * How cells die: at a rate (1/day), or at once if a condition holds at the
     * beginning of a step. A dead cell neither grows nor divides nor changes
     * its type; its volume falls linearly from that at death to a final
     * fraction, and then the cell is removed, or stays as debris:
     * doc/theory.md, section 6.9.
     */
    template <int dim>
    class Death : public EndAtRate<dim>
    {
    public:
      using Parameters = DeathParameters;

      Death(const Parameters &parameters, const EffectSetting<dim> &setting)
        : EndAtRate<dim>(parameters.rate,
                         setting,
                         Random::death_threshold,
                         "death",
                         "when the cell died; -1: it lives",
                         true)
        , when(setting.state.use(parameters.when))
        , shrinking_time(setting.state.use(parameters.shrinking_time))
        , final_volume(setting.state.use(parameters.final_volume))
        , keep_debris(setting.state.use(parameters.keep_debris))
        , has_condition(!when.is_always(0.))
        , slack(setting.slack)
      {
        // What is fixed at the moment of death is stored with the cell, as the
        // expressions go on changing.
        CellColumns<dim> &columns = setting.columns;
        remaining =
          columns.template add<double>({"remaining_volume",
                                        "",
                                        "part of its grown volume at death "
                                        "that the cell has left; 1: it lives",
                                        1.,
                                        AtDivision::reset,
                                        true});
        duration = columns.template add<double>(
          {"shrinking_time", "day", "how long the dead cell shrinks"});
        least = columns.template add<double>(
          {"final_volume", "", "remaining volume at the end"});
        stays = columns.template add<unsigned int>(
          {"is_debris", "", "whether the dead cell stays"});
      }

      LifeAfter
      happen(const PresentCell<dim>      &cell,
             const CellView<dim, double> &row,
             const Stretch &,
             const double            s,
             std::vector<CellEvent> &events) const override
      {
        this->end(cell, row, s, events, "rate");
        set_remains(cell, row, s);
        return LifeAfter::ends;
      }

      bool
      strikes(const PresentCell<dim> &cell, const double t) const override
      {
        return has_condition && cell.value(when, t) > 0.;
      }

      void
      strike(const PresentCell<dim>      &cell,
             const CellView<dim, double> &row,
             const double                 t,
             std::vector<CellEvent>      &events) const override
      {
        this->end(cell, row, t, events, "when", true);
        set_remains(cell, row, t);
      }

      bool
      may_strike() const override
      {
        // A shrinking time that is a positive constant rules out that cells go
        // at once; an expression may be zero somewhere.
        return has_condition && !(shrinking_time.is_constant() &&
                                  shrinking_time.number().value_or(0.) > 0.);
      }

      double
      shrink(const CellView<dim, double> &row, const double t) const override
      {
        const double whole = row.get(duration);
        // A cell that is removed at the end of this step is whole until then: a
        // collapse before would pull at its neighbours.
        if (whole == 0. && row.get(stays) == 0)
          return 1.;
        // This is s of doc/theory.md (6.9), as a ratio to what the last step
        // left: F_g has the former shrinking in it already.
        const double part =
          whole > 0. ?
            std::clamp((t - this->time_of_death(row)) / whole, 0., 1.) :
            1.;
        const double before = row.get(remaining);
        const double after  = 1. - (1. - row.get(least)) * part;
        row.set(remaining, after);
        return std::pow(after / before, 1. / dim);
      }

      double
      removal_time(const CellView<dim, const double> &cell) const override
      {
        // Cells that live, and debris, are never removed.
        return this->has_ended(cell) && cell.get(stays) == 0 ?
                 this->time_of_death(cell) + cell.get(duration) :
                 std::numeric_limits<double>::infinity();
      }

      bool
      is_due_for_removal(const CellView<dim, const double> &cell,
                         const double                       t) const override
      {
        return removal_time(cell) <= t + slack;
      }

      bool
      shrinks(const CellView<dim, const double> &cell) const override
      {
        return this->has_ended(cell) && cell.get(duration) > 0.;
      }

      void
      declare(Tables<dim> &tables) const override
      {
        tables.add_sum("dying", [this](const PresentCell<dim> &cell) {
          return this->has_ended(cell.cell()) ? 1. : 0.;
        });
        EndAtRate<dim>::declare(tables);
      }

    private:
      /** What becomes of a cell that dies at @p t (day) is evaluated then.
       *  @throws InputError */
      void
      set_remains(const PresentCell<dim>      &cell,
                  const CellView<dim, double> &row,
                  const double                 t) const
      {
        row.set(duration, cell.value(shrinking_time, t));
        row.set(least, cell.value(final_volume, t));
        row.set(stays, cell.value(keep_debris, t) > 0.);
      }

      Expression           when, shrinking_time, final_volume;
      Expression           keep_debris;
      bool                 has_condition;
      double               slack;
      Column<double>       remaining; // s
      Column<double>       duration;  // T_s
      Column<double>       least;     // s_end
      Column<unsigned int> stays;
    };
  } // namespace


  void
  add_death(Catalogue &catalogue)
  {
    catalogue.add_own<Death>("death",
                             {"Material/Energy per=grown volume",
                              "Death/When=abs(X*Y - 0.75) < 0.1 && t > 0.05",
                              "Death/Shrinking time=0.2"});
  }
} // namespace Morula
