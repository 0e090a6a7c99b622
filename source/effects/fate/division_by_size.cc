// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/fate/division_by_size.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/state/present_cell.h>

#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace Morula
{
  namespace
  {
    /** The column of the time of division has this value while a cell does not
     *  divide. */
    constexpr double undivided = -1.;

    /** A cell that is due for more generations at once has a volume that is a
     *  mistake: without a limit there would soon be too many cells. */
    constexpr double most_divisions = 10.;

    /** A normally distributed number, of mean 0 and deviation 1, from one that
     *  is exponentially distributed with mean 1. */
    double
    as_normal(const double exponential)
    {
      // The share of larger numbers is kept off 0 and 1, where the normal
      // number would be infinite.
      const double share =
        std::clamp(std::exp(-exponential), 0x1p-53, 1. - 0x1p-53);
      return std::sqrt(2.) * boost::math::erfc_inv(2. * share);
    }
  } // namespace


  void
  DivisionBySizeParameters::check(const SceneKeys &scene, Review &) const
  {
    if (is_on() && !scene.has_growth())
      volume.refuse("its default, as no cell grows",
                    "Set Growth/Law, or remove this key.");
  }


  template <int dim>
  DivisionBySize<dim>::DivisionBySize(const Parameters         &parameters,
                                      const EffectSetting<dim> &setting)
    : volume(setting.state.use(parameters.volume))
    , noise(setting.state.use(parameters.noise))
    , random_seed(setting.random_seed)
    , rounding(1024. * setting.slack)
    , whole_volume(setting.whole_volume)
  {
    // With parent and generation a cell's box is that of F_e, doc/theory.md
    // (2.2b): F alone says nothing of the shape of cells that grow and divide.
    CellColumns<dim> &columns = setting.columns;
    columns.need_growth();
    columns.need_lineage();
    columns.need_lineage_key();
    columns.need_shape();
    grown_volume =
      columns.template add<double>({"grown_volume",
                                    "um^" + std::to_string(dim),
                                    "grown volume at the end of the step, or "
                                    "when the cell divides",
                                    0.,
                                    AtDivision::halved});
    growth_rate = columns.template add<double>(
      {"volume_growth_rate", "1/day", "rate of the grown volume in the step"});
    time = columns.template add<double>({"division_time",
                                         "day",
                                         "when the cell divides; -1: not yet",
                                         undivided,
                                         AtDivision::reset});
    axis = columns.template add<Tensor<1, dim>>(
      {"division_axis", "", "axis along which the cell divides"});
    if (whole_volume > 0.)
      share = columns.template add<double>(
        {"share_of_cell",
         "",
         "part of a whole cell that the surface left of the founder",
         1.});
  }


  template <int dim>
  void
  DivisionBySize<dim>::begin(const CellView<dim, double> &cell) const
  {
    if (share.exists())
      cell.set(share, std::min(1., cell.initial_volume() / whole_volume));
  }


  template <int dim>
  void
  DivisionBySize<dim>::grow(const PresentCell<dim>      &before,
                            const CellView<dim, double> &row,
                            const double                 ratio,
                            const Stretch               &step) const
  {
    // The volume is taken from F_g anew in each step, so that nothing adds up.
    const CellView<dim, const double> &cell = before.cell();
    row.set(grown_volume, cell.initial_volume() * determinant(cell.growth()));
    row.set(growth_rate, std::log(ratio) / (step.end - step.begin));
  }


  template <int dim>
  double
  DivisionBySize<dim>::threshold(const PresentCell<dim> &cell,
                                 const double            t) const
  {
    // This is doc/theory.md (6.10): the mean is that of the key, whatever the
    // noise. A founder that the surface has cut is a part of a cell, and so are
    // its descendants: they divide at that part of the volume, and stay as long
    // along the surface as their neighbours.
    const double whole = cell.value(volume, t);
    if (whole == 0.)
      return std::numeric_limits<double>::infinity();
    const double mean = share.exists() ? whole * cell.cell().get(share) : whole;
    const double variation = cell.value(noise, t);
    if (variation == 0.)
      return mean;
    const double s2 = std::log1p(variation * variation);
    const double z  = as_normal(Random::threshold_of("division by size",
                                                    random_seed,
                                                    cell.lineage_key()));
    return mean * std::exp(std::sqrt(s2) * z - 0.5 * s2);
  }


  template <int dim>
  void
  DivisionBySize<dim>::grow_until(const double                 s,
                                  const PresentCell<dim>      &cell,
                                  const CellView<dim, double> &row,
                                  const Stretch               &stretch) const
  {
    const CellView<dim, const double> &begin = cell.cell();
    row.set(grown_volume,
            begin.get(grown_volume) *
              std::exp(begin.get(growth_rate) * (s - stretch.begin)));
  }


  template <int dim>
  std::optional<double>
  DivisionBySize<dim>::next(const PresentCell<dim>      &cell,
                            const CellView<dim, double> &row,
                            const Stretch               &stretch) const
  {
    // This is doc/theory.md (6.10a): the logarithm of the volume is linear in
    // time within the step. A cell
    // that is beyond its threshold already, as after a change of its type,
    // divides at once. Times are rounded, so that cells which are equal have
    // equal times on any ranks and their daughters are numbered in the same
    // order.
    const double rate = cell.cell().get(growth_rate);
    const double left =
      std::log(threshold(cell, stretch.begin) / cell.cell().get(grown_volume));
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
          std::clamp(rounding > 0. ? std::round(s / rounding) * rounding : s,
                     stretch.begin,
                     stretch.end);
      }
    grow_until(event.value_or(stretch.end), cell, row, stretch);
    return event;
  }


  template <int dim>
  void
  DivisionBySize<dim>::pass(const PresentCell<dim>      &cell,
                            const CellView<dim, double> &row,
                            const Stretch               &stretch,
                            const double                 s) const
  {
    grow_until(s, cell, row, stretch);
  }


  template <int dim>
  LifeAfter
  DivisionBySize<dim>::happen(const PresentCell<dim>      &cell,
                              const CellView<dim, double> &row,
                              const Stretch &,
                              const double s,
                              std::vector<CellEvent> &) const
  {
    row.set(time, s);
    row.set(axis,
            this->axes ?
              this->axes->choose(cell, s) :
              Random::direction<dim>(random_seed, cell.lineage_key()));
    return LifeAfter::divides;
  }


  template <int dim>
  double
  DivisionBySize<dim>::time_of_division(const CellView<dim, const double> &cell,
                                        const double) const
  {
    const double t = cell.get(time);
    return t == undivided ? std::numeric_limits<double>::infinity() : t;
  }


  template <int dim>
  void
  DivisionBySize<dim>::inherit(const CellView<dim, double> &daughter,
                               const StateColumns<dim>     &columns,
                               const unsigned int           which,
                               const double) const
  {
    // The key and the type in the row are still the mother's: the fate of types
    // is the last.
    const Column<std::uint64_t> &key = daughter.columns().lineage_key;
    daughter.set(key,
                 Random::daughter_key(random_seed,
                                      daughter.get(key),
                                      which == 0 ?
                                        Random::Draw::first_daughter :
                                        Random::Draw::second_daughter));
    this->halve(daughter, columns);
  }


  template <int dim>
  void
  DivisionBySize<dim>::check_cell(const PresentCell<dim> &founder,
                                  const double            step) const
  {
    const double mean = founder.value(volume, 0.);
    founder.value(noise, 0.);
    const double V0 = founder.cell().initial_volume();
    if (mean > 0. && V0 > 2. * mean)
      {
        std::ostringstream allowed;
        allowed << "at least half of the volume of a founder; that of the one "
                   "at ("
                << founder.cell().founder_position() << ") um is " << V0
                << (dim == 3 ? " um^3" : " um^2");
        throw InputError(volume.key(),
                         volume.text(),
                         allowed.str(),
                         "Such a cell would divide more than once at t = 0: "
                         "raise the volume, or lower Tissue/Cell spacing.");
      }
    if (const DivisionRule<dim> *const rule = this->rule(founder.type()))
      rule->check_cell(founder, step);
  }


  template <int dim>
  void
  DivisionBySize<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    // Where types have numbers of their own the largest counts: some founders
    // may then be too large, but not all of them.
    DividingFate<dim>::review(scene, review);
    double mean = volume.number().value_or(0.);
    for (const auto &[type, own] : volume.types())
      mean = std::max(mean, own.number().value_or(0.));
    if (mean > 0. && mean <= (1. + 1e-9) * scene.largest_volume)
      review.warn(volume.key(),
                  volume.text(),
                  "founders have up to " + as_text(scene.largest_volume) +
                    (dim == 3 ? " um^3" : " um^2") +
                    " and divide at once, until they are smaller.",
                  "Choose a volume above that of the founders, such as twice "
                  "as much.");
  }


  template class DivisionBySize<2>;
  template class DivisionBySize<3>;
} // namespace Morula
