// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/input_error.h>
#include <morula/effects/fate/divides_at_once.h>
#include <morula/effects/scene_keys.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace Morula
{
  namespace
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
        "Proliferation/Cell cycle about axes and daughters apply; "
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

      EffectFacts
      facts() const override
      {
        EffectFacts facts;
        facts.switch_key    = &volume;
        facts.divides_cells = true;
        return facts;
      }

      void
      check(const SceneKeys &scene, Review &) const override
      {
        if (is_on() && !scene.has_growth())
          volume.refuse("its default, as no cell grows",
                        "Set Growth/Law, or remove this key.");
      }
    };

    /** A cell that is due for more generations at once has a volume that is a
     *  mistake: without a limit there would soon be too many cells. */
    constexpr double most_divisions = 10.;

    /**
     * Cells that grow by a law divide when their grown volume V⁰ det F_g
     * reaches a threshold, which is drawn from the lineage key: doc/theory.md,
     * section 6.10. The event has an exact time, if the volume grows
     * exponentially within the step; a daughter may divide again in the same
     * step.
     */
    template <int dim>
    class DivisionBySize : public DividesAtOnce<dim>
    {
    public:
      using Parameters = DivisionBySizeParameters;

      DivisionBySize(const Parameters         &parameters,
                     const EffectSetting<dim> &setting)
        : DividesAtOnce<dim>(setting)
        , volume(setting.state.use(parameters.volume))
        , noise(setting.state.use(parameters.noise))
        , rounding(1024. * setting.slack)
        , whole_volume(setting.whole_volume)
      {
        CellColumns<dim> &columns = setting.columns;
        grown_volume              = columns.template add<double>(
          {"grown_volume",
                        "um^" + std::to_string(dim),
                        "grown volume at the end of the step, or "
                                     "when the cell divides",
                        0.,
                        AtDivision::halved});
        growth_rate = columns.template add<double>(
          {"volume_growth_rate",
           "1/day",
           "rate of the grown volume in the step"});
        this->declare_event(columns);
        if (whole_volume > 0.)
          share = columns.template add<double>(
            {"share_of_cell",
             "",
             "part of a whole cell that the surface left of the founder",
             1.});
      }

      /** Keeps which part of a whole cell a founder is. */
      void
      begin(const PresentCell<dim> &,
            const CellView<dim, double> &cell) const override
      {
        if (share.exists())
          cell.set(share, std::min(1., cell.initial_volume() / whole_volume));
      }

      bool
      follows_growth() const override
      {
        return true;
      }

      void
      grow(const PresentCell<dim>      &before,
           const CellView<dim, double> &row,
           const double                 ratio,
           const Stretch               &step) const override
      {
        // The volume is taken from F_g anew in each step, so that nothing adds
        // up.
        const CellView<dim, const double> &cell = before.cell();
        row.set(grown_volume,
                cell.initial_volume() * determinant(cell.growth()));
        row.set(growth_rate, std::log(ratio) / (step.end - step.begin));
      }

      std::optional<double>
      next(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch               &stretch) const override
      {
        // This is doc/theory.md (6.10a): the logarithm of the volume is linear
        // in time within the step. A cell that is beyond its threshold already,
        // as after a change of its type, divides at once. Times are rounded, so
        // that cells which are equal have equal times on any ranks and their
        // daughters are numbered in the same order.
        const double rate = cell.cell().get(growth_rate);
        const double left = std::log(threshold(cell, stretch.begin) /
                                     cell.cell().get(grown_volume));
        if (left < -most_divisions * std::log(2.))
          throw InputError(volume.key(),
                           volume.text(),
                           "at least a thousandth of a cell's grown volume, " +
                             std::to_string(cell.cell().get(grown_volume)) +
                             (dim == 3 ? " um^3" : " um^2"),
                           "The cell would divide ten times at once: raise the "
                           "volume.");
        std::optional<double> event;
        if (left <= 0.)
          event = stretch.begin;
        else if (left <= rate * (stretch.end - stretch.begin))
          {
            const double s = stretch.begin + left / rate;
            event =
              std::clamp(rounding > 0. ? std::round(s / rounding) * rounding :
                                         s,
                         stretch.begin,
                         stretch.end);
          }
        grow_until(event.value_or(stretch.end), cell, row, stretch);
        return event;
      }

      void
      pass(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch               &stretch,
           const double                 s) const override
      {
        grow_until(s, cell, row, stretch);
      }

      /** Refuses a founder of more than twice the volume at which it divides.
       */
      void
      check_cell(const PresentCell<dim> &founder,
                 const double            step) const override
      {
        const double mean = founder.value(volume, 0.);
        const double V0   = founder.cell().initial_volume();
        if (mean > 0. && V0 > 2. * mean)
          {
            std::ostringstream allowed;
            allowed
              << "at least half of the volume of a founder; that of the one "
                 "at ("
              << founder.cell().founder_position() << ") um is " << V0
              << (dim == 3 ? " um^3" : " um^2");
            throw InputError(
              volume.key(),
              volume.text(),
              allowed.str(),
              "Such a cell would divide more than once at t = 0: "
              "raise the volume, or lower Tissue/Cell spacing.");
          }
        DividesAtOnce<dim>::check_cell(founder, step);
      }

    private:
      /** The grown volume at which a cell divides, µm^dim; infinity: it does
       * not divide. @throws InputError */
      double
      threshold(const PresentCell<dim> &cell, const double t) const
      {
        // This is doc/theory.md (6.10): the mean is that of the key, whatever
        // the noise. A founder that the surface has cut is a part of a cell,
        // and so are its descendants: they divide at that part of the volume,
        // and stay as long along the surface as their neighbours.
        const double whole = cell.value(volume, t);
        if (whole == 0.)
          return std::numeric_limits<double>::infinity();
        const double mean =
          share.exists() ? whole * cell.cell().get(share) : whole;
        const double variation = cell.value(noise, t);
        if (variation == 0.)
          return mean;
        const double s2 = std::log1p(variation * variation);
        const double z  = Random::normal_of("division by size",
                                           this->random_seed,
                                           cell.lineage_key());
        return mean * std::exp(std::sqrt(s2) * z - 0.5 * s2);
      }

      /** Takes the grown volume from the beginning of the stretch, where @p
       * cell has it, to @p s, day. */
      void
      grow_until(const double                 s,
                 const PresentCell<dim>      &cell,
                 const CellView<dim, double> &row,
                 const Stretch               &stretch) const
      {
        const CellView<dim, const double> &begin = cell.cell();
        row.set(grown_volume,
                begin.get(grown_volume) *
                  std::exp(begin.get(growth_rate) * (s - stretch.begin)));
      }

      Expression     volume, noise;
      double         rounding;     // of times, day
      double         whole_volume; // µm^dim; 0: all founders are whole
      Column<double> grown_volume; // µm^dim
      Column<double> growth_rate;  // 1/day
      /** Which part of a whole cell a founder is, where the surface cuts some.
       */
      Column<double> share;
    };
  } // namespace


  void
  add_division_by_size(Catalogue &catalogue)
  {
    catalogue.add_own<DivisionBySize>(
      "division by size",
      {"Growth/Law=rate",
       "Growth/Rate/Rate=J_e + 0.1*X*Y",
       "Division by size/Volume=1.1",
       "Proliferation/Cell cycle/Division axis=random",
       "Proliferation/Cell cycle/Least anisotropy=1"});
  }
} // namespace Morula
