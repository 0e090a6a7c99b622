// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_division_by_size_h
#define morula_effects_fate_division_by_size_h

#include <morula/base/expression_key.h>
#include <morula/effects/fate/dividing_fate.h>

#include <memory>
#include <optional>

namespace Morula
{
  /** Section "Division by size". */
  struct DivisionBySizeParameters : public EffectKeys
  {
    ExpressionKey volume{
      {this, "Division by size/Volume"},
      "0",
      "Grown volume V0 det F_g at which a cell that grows by Growth/Law "
      "divides into two halves, without a cell cycle: the mean of cells "
      "that are alike; 2-D: area. Not negative; 0: it does not divide. "
      "An expression of the cell's state. The keys of "
      "Proliferation/Cell cycle about axes and daughters hold; "
      "Division axis is 'cell shape' unless it is set. Units: um^3.",
      Evaluated::event,
      not_negative("um^3 (2-D: um^2)", "0 means no division by size.")};

    ExpressionKey noise{
      {this, "Division by size/Noise"},
      "0",
      "Coefficient of variation of the volume at which cells divide, "
      "which has a log-normal distribution: each cell draws its own. 0 "
      "to 0.5. An expression of the cell's state.",
      Evaluated::event,
      {[](const double c) { return c >= 0. && c <= 0.5; },
       "a number from 0 to 0.5",
       "It is the standard deviation of the volume at division over "
       "its mean; cells of tissues have about 0.1."}};

    bool
    is_on() const override
    {
      return !volume.expression(3).is_always(0.);
    }

    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.switch_key    = &volume;
      facts.divides_cells = true;
      return facts;
    }

    void
    check(const SceneKeys &scene, Review &review) const override;

    std::string
    details() const override
    {
      return "volume = " + volume.text() +
             " um^3 (2-D: um^2), noise = " + noise.text();
    }
  };

  /**
   * Cells that grow by a law divide when their grown volume V⁰ det F_g reaches
   * a threshold, which is drawn from the lineage key: doc/theory.md, section
   * 6.10. There is no clock. V⁰ halves, F and F_g stay, so that no stress
   * changes. The event has an exact time, if the volume grows exponentially
   * within the step; a daughter may divide again in the same step.
   */
  template <int dim>
  class DivisionBySize : public DividingFate<dim>
  {
  public:
    using Parameters = DivisionBySizeParameters;

    /** Declares the columns. @throws InputError */
    DivisionBySize(const Parameters         &parameters,
                   const EffectSetting<dim> &setting);

    /** Keeps which part of a whole cell a founder is. */
    void
    begin(const CellView<dim, double> &cell) const override;

    bool
    follows_growth() const override
    {
      return true;
    }

    void
    grow(const PresentCell<dim>      &before,
         const CellView<dim, double> &row,
         const double                 ratio,
         const Stretch               &step) const override;

    std::optional<double>
    next(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch) const override;

    void
    pass(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch,
         const double                 s) const override;

    /** Chooses the axis, too. */
    LifeAfter
    happen(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch               &stretch,
           const double                 s,
           std::vector<CellEvent>      &events) const override;

    double
    time_of_division(const CellView<dim, const double> &cell,
                     const double                       t) const override;

    Tensor<1, dim>
    placement_axis(const CellView<dim, const double> &cell,
                   const unsigned int                 type) const override
    {
      return this->axes ? this->axes->placement(cell, cell.get(axis), type) :
                          cell.get(axis);
    }

    void
    inherit(const CellView<dim, double> &daughter,
            const StateColumns<dim>     &columns,
            const unsigned int           which,
            const double                 birth) const override;

    /** Refuses a founder of more than twice the volume at which it divides. */
    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override;

  private:
    /** The grown volume at which a cell divides, µm^dim; infinity: it does not
     *  divide. @throws InputError */
    double
    threshold(const PresentCell<dim> &cell, const double t) const;

    /** Takes the grown volume from the beginning of the stretch, where @p cell
     *  has it, to @p s, day. */
    void
    grow_until(const double                 s,
               const PresentCell<dim>      &cell,
               const CellView<dim, double> &row,
               const Stretch               &stretch) const;

    Expression             volume, noise;
    std::uint64_t          random_seed;
    double                 rounding;     // of times, day
    double                 whole_volume; // µm^dim; 0: all founders are whole
    Column<double>         grown_volume; // µm^dim
    Column<double>         growth_rate;  // 1/day
    Column<double>         time;         // day
    Column<Tensor<1, dim>> axis;
    /** Which part of a whole cell a founder is, where the surface cuts some. */
    Column<double> share;
  };
} // namespace Morula

#endif
