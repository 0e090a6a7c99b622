// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_cell_types_h
#define morula_effects_fate_cell_types_h

#include <morula/effects/fate/cell_hazard.h>
#include <morula/effects/fate/cell_type_parameters.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * The types of cells, and how cells change their type. Each way out of a type
   * has a rate r (1/day), an expression of the cell's state at the beginning of
   * the step, and is taken when ∫ r dt since the cell got its type reaches a
   * number that is exponentially distributed with mean 1, drawn from the
   * lineage key: doc/theory.md, section 6.8. So events have exact times, and if
   * the rates do not depend on steps, neither do the events.
   */
  template <int dim>
  class CellTypes : public Fate<dim>
  {
  public:
    /** The scene must have at least one type. @throws InputError */
    CellTypes(const CellTypesParameters &parameters,
              const EffectSetting<dim>  &setting);

    /** The type of a founder at @p X: the last one whose `Where` holds, or the
     *  first. */
    unsigned int
    founder_type(const Point<dim> &X) const;

    void
    make_good(const PresentCell<dim>      &cell,
              const CellView<dim, double> &row) const override;

    std::optional<double>
    next(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch) const override;

    void
    pass(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch,
         const double                 s) const override;

    LifeAfter
    happen(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch               &stretch,
           const double                 s,
           std::vector<CellEvent>      &events) const override;

    void
    expect(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const double                 t,
           const bool                   is_whole) const override;

    void
    inherit(const CellView<dim, double> &daughter,
            const StateColumns<dim>     &columns,
            const unsigned int           which,
            const double                 birth) const override;

    void
    declare(Tables<dim> &tables) const override;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override;

    std::vector<const Expression *>
    rates(const unsigned int type) const override;

    /** Number of types. */
    unsigned int
    size() const
    {
      return transitions.size();
    }

  private:
    struct Transition
    {
      unsigned int    to;
      CellHazard<dim> hazard;
    };

    /** The ways out of a cell's type in a stretch, and the first that is taken.
     */
    struct Outlook
    {
      std::vector<Hazard>         ways;
      std::optional<double>       time; // day
      std::optional<unsigned int> to;   // number of the type
    };

    /** @param row that of the beginning of the stretch. @throws InputError for
     *  negative rates */
    Outlook
    outlook(const PresentCell<dim>            &cell,
            const CellView<dim, const double> &row,
            const Stretch                     &stretch) const;

    /** Keeps the integrals of the ways at @p s, day. */
    void
    integrate(const Outlook               &outlook,
              const Stretch               &stretch,
              const double                 s,
              const CellView<dim, double> &row) const;

    std::vector<std::string>                           names;
    std::uint64_t                                      random_seed;
    std::vector<std::optional<Expression>>             where;
    std::vector<std::pair<unsigned int, unsigned int>> daughters_;
    std::vector<std::vector<Transition>>               transitions; // by type
    Column<unsigned int>                               n_changes;
    std::vector<Column<double>>                        hazards;
    /** Rates that the last step saw, by the number of the way; a column exists
     *  if the rate of some type's way of this number follows the state. */
    std::vector<Column<double>> expected;
  };
} // namespace Morula

#endif
