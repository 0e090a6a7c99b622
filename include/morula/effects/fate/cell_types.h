// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_cell_types_h
#define morula_effects_fate_cell_types_h

#include <morula/effects/effect.h>
#include <morula/effects/fate/cell_type_parameters.h>

#include <optional>
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
  class CellTypes
  {
  public:
    /** Only with at least one type. @throws InputError */
    CellTypes(const CellTypesParameters &parameters,
              const EffectSetting<dim>  &setting);

    /** The type of a founder at @p X: the last one whose `Where` holds, or the
     *  first. */
    unsigned int
    founder_type(const Point<dim> &X) const;

    /** The types of the daughters of a cell of this type, -n_s daughter first.
     */
    std::pair<unsigned int, unsigned int>
    daughters(const unsigned int type) const;

    /** A change that is due. */
    struct Change
    {
      double       time; // day
      unsigned int to;   // number of the type
    };

    /**
     * The first change of type in (t0, t1], if there is one; until then, or t1,
     * the integrals go on. The rates are those of the cell's present type.
     * @param cell  in its state, but of its present type
     * @param after the row that keeps the integrals
     * @throws InputError for negative rates
     */
    std::optional<Change>
    next_change(const PresentCell<dim>      &cell,
                const CellView<dim, double> &after,
                const double                 t0,
                const double                 t1) const;

    /** Adds what the last step missed of the rates' integrals, where rates
     *  follow the state: doc/theory.md (5.9). */
    void
    make_good(const PresentCell<dim>      &cell,
              const CellView<dim, double> &row) const;

    /** Keeps the rates for the time @p t (day), the middle of the step, if the
     *  next step is to compare them: if the cell has @p is_whole lived the step
     *  without an event. */
    void
    expect_rates(const PresentCell<dim>      &cell,
                 const CellView<dim, double> &row,
                 const double                 t,
                 const bool                   is_whole) const;

    /** Gives a cell another type. @param time day */
    void
    change(const CellView<dim, double> &cell,
           const StateColumns<dim>     &columns,
           const unsigned int           to,
           const double                 time) const;

    /** Refuses negative rates of a founder in its state. @throws InputError */
    void
    check_cell(const PresentCell<dim> &founder) const;

    /** The rates with which cells of a type leave it. */
    std::vector<const Expression *>
    rates(const unsigned int type) const;

    /** Number of types. */
    unsigned int
    size() const;

  private:
    struct Transition
    {
      unsigned int to;
      Expression   rate;
    };

    std::uint64_t                                      random_seed;
    std::vector<std::optional<Expression>>             where;
    std::vector<std::pair<unsigned int, unsigned int>> daughters_;
    std::vector<std::vector<Transition>>               transitions; // by type
    Column<unsigned int>                               n_changes;
    std::vector<Column<double>>                        hazards;
    /** Where the rate of some type's way of this number follows the state. */
    std::vector<Column<double>> expected;
  };
} // namespace Morula

#endif
