// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_extrusion_h
#define morula_effects_fate_extrusion_h

#include <morula/base/expression_key.h>
#include <morula/effects/fate/fate.h>
#include <morula/effects/fate/hazard.h>

#include <optional>

namespace Morula
{
  /** Section "Extrusion". */
  struct ExtrusionParameters : public EffectKeys
  {
    ExtrusionParameters();

    ExpressionKey rate; // 1/day

    bool
    is_on() const override;

    const AnyKey *
    switch_key() const override;

    std::string
    how_to_switch_on() const override;

    std::string
    details() const override;

    using Keys::list;
    KeyList
    list() override;
  };

  /**
   * How live cells leave the tissue: at a rate (1/day), a hazard with a
   * threshold of its own. The cell is whole until the end of the step of its
   * event and then goes with its grown volume; the cells of its grid cell take
   * over all the space that it had, so that their pressure falls and the tissue
   * closes up: doc/theory.md, section 6.9.
   */
  template <int dim>
  class Extrusion : public Fate<dim>
  {
  public:
    using Parameters = ExtrusionParameters;

    /** Declares the columns. @throws InputError */
    Extrusion(const Parameters &parameters, const EffectSetting<dim> &setting);

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

    bool
    is_deadly() const override;

    double
    time_of_death(const CellView<dim, const double> &cell) const override;

    double
    removal_time(const CellView<dim, const double> &cell) const override;

    bool
    shrinks(const CellView<dim, const double> &cell) const override;

    std::vector<const Expression *>
    rates(const unsigned int type) const override;

    void
    declare(Tables<dim> &tables) const override;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

  private:
    /** The chance of extrusion from the beginning of a stretch on, in a row of
     *  that time. @throws InputError for negative rates */
    Hazard
    hazard(const PresentCell<dim>            &cell,
           const CellView<dim, const double> &row,
           const Stretch                     &stretch) const;

    Expression     rate;
    std::uint64_t  random_seed;
    Column<double> integral;
    Column<double> expected; // if the rate follows the state
    Column<double> time;     // day
  };
} // namespace Morula

#endif
