// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/state/present_cell.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** The predictor asks how the rate answers if det F_g is larger by this
     * part. 1e-4 is small enough for a derivative, and the difference still
     * keeps twelve of sixteen digits. */
    constexpr double probe = 1e-4;

    /** A cell with a smaller det F_law counts as withered to nothing: its rate
     *  has no end, and the equilibrium would fail with a worse message. */
    constexpr double least_volume_ratio = 1e-6;

    /** Whether the expression's value changes if a cell grows in its place. */
    bool
    follows_elastic_state(const Expression &expression)
    {
      return std::any_of(expression.used().begin(),
                         expression.used().end(),
                         [](const Variable v) {
                           return v >= Variable::J_e && v <= Variable::energy;
                         });
    }

    std::string
    place_and_time_of(const std::string &what,
                      const double       value,
                      const std::string &X,
                      const double       t)
    {
      std::ostringstream place;
      place << what << " is " << value << " at the cell from (" << X
            << ") um, t = " << t << " day. ";
      return place.str();
    }

    template <int dim>
    std::string
    text_of(const Point<dim> &X)
    {
      std::ostringstream text;
      text << X;
      return text.str();
    }

    /** The components of σ in the space of the tissue. In plane strain σ_zz is
     *  left out, as cells do not grow across the plane. */
    template <int dim>
    SymmetricTensor<2, dim>
    in_tissue(const SymmetricTensor<2, 3> &stress)
    {
      SymmetricTensor<2, dim> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = i; j < dim; ++j)
          result[i][j] = stress[i][j];
      return result;
    }
  } // namespace


  RateGrowthParameters::RateGrowthParameters()
  {
    // The rate itself may be negative, as cells may wither; a negative
    // coefficient of homeostasis would drive the stress away from its target
    // and is refused. Expressions are evaluated once in each step.
    homeostatic_stress.needs({homeostasis.path()});
    share_along.needs({direction.path()});
    direction.needs({share_along.path()});
  }


  template <int dim>
  RateGrowth<dim>::RateGrowth(const RateGrowthParameters &parameters,
                              const EffectSetting<dim>   &setting)
    : rate(setting.state.use(parameters.rate))
    , predictor(parameters.predictor)
    , slack(setting.slack)
  {
    // The constructor reads the keys and declares the columns that this scene
    // needs. The memory of the place is for rates that fall under pressure,
    // doc/theory.md (10.6); what a step expected is for rates that follow the
    // state at all, (5.9). The latter is a tensor where the direction of growth
    // can turn, else one number.
    if (!parameters.direction.empty())
      direction.emplace(parameters.direction, setting);
    if (!parameters.share_along.empty())
      share = setting.state.use(parameters.share_along);
    if (share && !direction &&
        (!share->used().empty() ||
         std::abs(share->value(Point<dim>(), 0.) * dim - 1.) > 1e-6))
      throw InputError(share->key(),
                       share->text(),
                       dim == 2 ? "1/2 or empty without Growth/Rate/Direction" :
                                  "1/3 or empty without Growth/Rate/Direction",
                       "Say along which Direction, or leave both empty for "
                       "isotropic growth.");
    // The coefficient is read in any case, since a type of cells may set it.
    homeostasis = setting.state.use(parameters.homeostasis);
    if (homeostasis->is_always(0.))
      homeostasis.reset();
    else
      {
        homeostatic_stress = setting.state.use(parameters.homeostatic_stress);
        setting.state.need(Variable::tension);
      }
    follows_stress = follows_elastic_state(rate);
    if (predictor && (follows_stress || homeostasis))
      memory =
        Memory{setting.columns.template add<double>(
                 {"rate_place",
                  "",
                  "ln (J_e det F_law) at the beginning of the step before",
                  0.}),
               setting.columns.template add<double>(
                 {"rate_place_time", "day", "time of rate_place", 0.}),
               setting.columns.template add<double>(
                 {"rate_withheld",
                  "",
                  "ln det F_law that the first step withheld",
                  0.})};
    const bool turns = homeostasis || (share && share->follows_state()) ||
                       (direction && direction->follows_state());
    if (predictor && turns)
      expected =
        Expected{{},
                 setting.columns.template add<SymmetricTensor<2, dim>>(
                   {"rate_expected",
                    "1/day",
                    "rate of growth that the step before expected at its end",
                    SymmetricTensor<2, dim>()})};
    else if (predictor && rate.follows_state())
      expected = Expected{
        setting.columns.template add<double>(
          {"rate_expected",
           "1/day",
           "rate of the volume that the step before expected at its end",
           0.}),
        {}};
  }


  template <int dim>
  GrowthFeedback
  RateGrowth<dim>::Rates::all() const
  {
    return {of_rate.rate + of_homeostasis.rate,
            of_rate.damping + of_homeostasis.damping};
  }


  template <int dim>
  typename RateGrowth<dim>::Rates
  RateGrowth<dim>::rates(const PresentCell<dim> &cell,
                         const double            t0,
                         const double            t1) const
  {
    // Two rates are read from the cell's state of t0 with the time of the
    // middle of the step: that of the volume and the stress-regulated one. Each
    // gets its damping, by which the predictor foresees how growth in a
    // confined place lowers it. `dt` is 0 where only the rates are compared,
    // and no damping is needed then.
    const double t = (t0 + t1) / 2., dt = t1 - t0;
    Rates        rates;
    rates.of_rate.rate = cell.value(rate, t);
    if (predictor && follows_stress && dt > 0.)
      { // This is doc/theory.md (10.4), as a difference at the same F. A rate
        // that
        // rises with growth is not damped: that would make it run away.
        const double grown = cell.value_if_grown(rate, t, 1. + probe);
        rates.of_rate.damping =
          std::max(0., dt * (rates.of_rate.rate - grown) / std::log1p(probe));
      }
    if (homeostasis)
      { // This is doc/theory.md (10.3). Stress is in the present configuration
        // and L acts before F_e does, so it is rotated back by R. Growth in a
        // place that does not give way changes the stress by the moduli below.
        const double         kappa  = cell.value(*homeostasis, t);
        const double         target = cell.value(*homeostatic_stress, t);
        const Tensor<2, dim> R =
          project_onto_orthogonal_tensors(cell.elastic());
        const Tensor<2, dim> sigma(in_tissue<dim>(cell.quantities().stress));
        const auto           H = kappa * (symmetrize(transpose(R) * sigma * R) -
                                target * unit_symmetric_tensor<dim>());
        rates.of_homeostasis.rate = trace(H);
        rates.shape               = deviator(H);
        if (predictor)
          {
            const Lame lame = cell.lame();
            rates.of_homeostasis.damping =
              dt * kappa * (2. * lame.mu + dim * lame.lambda);
            rates.shape_damping = 2. * dt * kappa * lame.mu;
          }
      }
    return rates;
  }


  template <int dim>
  SymmetricTensor<2, dim>
  RateGrowth<dim>::directed(const double            k,
                            const PresentCell<dim> *cell,
                            const double            t) const
  {
    // The rate k of the volume is shared by doc/theory.md (10.2). The share is
    // checked at each cell, since it may be any expression; outside of [0, 1] a
    // cell would shrink in one direction while it grows in another.
    if (!share || !direction)
      return k / dim * unit_symmetric_tensor<dim>();
    if (cell == nullptr) // any direction does for the size of a step
      {
        Tensor<1, dim> x;
        x[0]           = 1.;
        const double s = share->value(Point<dim>(), t);
        return rate_along_and_across(x, s * k, (1. - s) * k / (dim - 1));
      }
    const double s = cell->value(*share, t);
    if (!(s >= 0. && s <= 1.))
      throw InputError(share->key(),
                       share->text(),
                       "a share from 0 to 1",
                       place_and_time_of(
                         "It", s, text_of(cell->cell().founder_position()), t) +
                         "The rest of the rate is growth across Direction.");
    return rate_along_and_across(direction->of(*cell, t),
                                 s * k,
                                 (1. - s) * k / (dim - 1));
  }


  template <int dim>
  SymmetricTensor<2, dim>
  RateGrowth<dim>::rate_of_growth(const GrowingCell<dim>        &cell,
                                  Rates                          now,
                                  const SymmetricTensor<2, dim> &missed,
                                  const double                   t0,
                                  const double                   t1) const
  {
    // First the predictor replaces both rates by their means over the step,
    // doc/theory.md (10.5). Then L is made of them. At last what the last step
    // missed is added, (5.9), with the same damping as growth has: added in
    // full, it would make a stiff feedback unstable. The trace and the deviator
    // have dampings of their own.
    const double         t   = (t0 + t1) / 2.;
    const GrowthFeedback all = now.all();
    const double         k = now.of_rate.rate, h = now.of_homeostasis.rate;
    if (memory)
      {
        const FirstStep past = seen_at_first_step(cell, t0);
        // What the first step withheld is made good by each part in proportion
        // to its rate.
        const double sum  = std::abs(k) + std::abs(h);
        const double of_k = sum > 0. ? std::abs(k) / sum : 0.;
        const double due  = past.due / (t1 - t0);
        now.of_rate.rate =
          predicted_rate(now.of_rate, all, past.widening) + of_k * due;
        now.of_homeostasis.rate =
          predicted_rate(now.of_homeostasis, all, past.widening) +
          (sum > 0. ? 1. - of_k : 0.) * due;
      }
    const double of_shape = mean_of_decay(now.shape_damping);
    now.shape *= of_shape;
    const SymmetricTensor<2, dim> L = tensor_of(now, *cell.present, t);
    if (!expected || !cell.present->reader().past.exists())
      return L;
    // The stress answers what is added now as it answers all growth.
    const double of_volume = mean_of_decay(all.damping) / (t1 - t0);
    // A correction of the volume alone goes along and across as the rate does.
    if (expected->volume.exists())
      return L + directed(of_volume * trace(missed), cell.present, t);
    return L + of_volume / dim * trace(missed) * unit_symmetric_tensor<dim>() +
           of_shape / (t1 - t0) * deviator(missed);
  }


  template <int dim>
  const Expression &
  RateGrowth<dim>::cause_of_size(const GrowingCell<dim> &cell,
                                 const double            t0,
                                 const double            t1) const
  {
    // This is called only for the message of an error: it finds the key that
    // the user should look at, the one behind the larger contribution.
    if (!homeostasis || cell.present == nullptr)
      return rate;
    const double t   = (t0 + t1) / 2.;
    const Rates  now = rates(*cell.present, t0, t1);
    // A rate that is no number counts as the larger one: it is the cause.
    if (std::abs(now.of_rate.rate) >= std::abs(now.of_homeostasis.rate))
      return rate;
    const double of_target = dim * cell.present->value(*homeostasis, t) *
                             cell.present->value(*homeostatic_stress, t);
    return 2. * std::abs(of_target) < std::abs(now.of_homeostasis.rate) ?
             *homeostasis :
             *homeostatic_stress;
  }


  template <int dim>
  Tensor<2, dim>
  RateGrowth<dim>::grown_at(const SymmetricTensor<2, dim> &L,
                            const GrowingCell<dim>        &cell,
                            const double                   t0,
                            const double                   t1) const
  {
    // The upper limit catches an exponential that overflows. The negated
    // comparison catches NaN as well.
    const Tensor<2, dim> F     = grown(cell.growth, L, t1 - t0);
    const double         ratio = determinant(F);
    if (!(ratio >= least_volume_ratio && std::isfinite(ratio)))
      {
        const Expression &cause = cause_of_size(cell, t0, t1);
        throw InputError(
          cause.key(),
          cause.text(),
          "a rate that leaves cells between 1e-6 and 1e300 of their volume",
          place_and_time_of(
            "det F_g of this law", ratio, text_of(cell.founder_position), t1) +
            "Let the rate end, e.g. by a factor of (growth > 0.1) for cells that "
            "wither.");
      }
    return F;
  }


  template <int dim>
  Tensor<2, dim>
  RateGrowth<dim>::growth(const GrowingCell<dim> &cell,
                          const double            t0,
                          const double            t1) const
  {
    // A law is asked without a cell for sizes before the run; then a rate of X
    // and t serves. With a cell, the whole tensor of its state does.
    if (t1 <= t0)
      return cell.growth;
    if (cell.present == nullptr)
      {
        const double t = (t0 + t1) / 2.;
        return grown_at(directed(rate.value(cell.founder_position, t),
                                 nullptr,
                                 t),
                        cell,
                        t0,
                        t1);
      }
    return grown_at(rate_of_growth(cell,
                                   rates(*cell.present, t0, t1),
                                   missed_tensor(cell),
                                   t0,
                                   t1),
                    cell,
                    t0,
                    t1);
  }


  template <int dim>
  GrowthOfStep<dim>
  RateGrowth<dim>::grow(const GrowingCell<dim>      &cell,
                        const double                 t0,
                        const double                 t1,
                        const CellView<dim, double> &after) const
  {
    // Rates are the costly part, with stresses and eigenvectors, and are
    // computed once for all that follows. What is remembered is written into
    // `after` and read from `cell`, so the order of the calls does not matter.
    if (t1 <= t0)
      return GrowthLaw<dim>::grow(cell, t0, t1, after);
    const Rates                   now = rates(*cell.present, t0, t1);
    const SymmetricTensor<2, dim> all = missed_tensor(cell);
    if (expected)
      expect(cell, now, t0, t1, after);
    if (memory)
      remember_place(cell, now, t0, t1, after);
    return {grown_at(rate_of_growth(cell, now, all, t0, t1), cell, t0, t1),
            size_of(all)};
  }


  template <int dim>
  void
  RateGrowth<dim>::check_cell(const PresentCell<dim> &founder,
                              const double            step) const
  {
    // The cell is taken through the first step from F_law = I, so that every
    // expression of the law is evaluated.
    const auto &view = founder.cell();
    growth({view.founder_position(),
            Tensor<2, dim>(unit_symmetric_tensor<dim>()),
            founder.elastic(),
            &view,
            &founder},
           0.,
           step);
  }


  template <int dim>
  void
  RateGrowth<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    if (is_known_before())
      GrowthLaw<dim>::review(scene, review);
  }


  void
  add_rate_growth(Catalogue &catalogue)
  {
    catalogue.add_own<RateGrowth>("rate",
                                  {"Growth/Law=rate",
                                   "Growth/Rate/Rate=J_e + 0.1*X*Y"});
  }


  template class RateGrowth<2>;
  template class RateGrowth<3>;
} // namespace Morula
