// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/division/directions.h>
#include <morula/effects/fate/random.h>

#include <deal.II/base/numbers.h>

#include <Random123/philox.h>
#include <boost/crc.hpp>
#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula::Random
{
  using namespace dealii;

  std::array<std::uint64_t, 2>
  bits(const std::uint64_t key, const std::uint64_t a, const std::uint64_t b)
  {
    // A generator by counters has no state: the same numbers come from the
    // same arguments, on any rank, in any order and after a restart.
    const auto low = [](const std::uint64_t x) {
      return static_cast<std::uint32_t>(x);
    };
    const auto high = [](const std::uint64_t x) {
      return static_cast<std::uint32_t>(x >> 32);
    };
    const auto join = [](const std::uint32_t low, const std::uint32_t high) {
      return low | (static_cast<std::uint64_t>(high) << 32);
    };

    const r123::Philox4x32::ctr_type counter = {
      {low(a), high(a), low(b), high(b)}};
    const auto words = r123::Philox4x32()(counter, {{low(key), high(key)}});
    return {{join(words[0], words[1]), join(words[2], words[3])}};
  }


  double
  uniform(const std::uint64_t random_bits)
  {
    return std::ldexp(static_cast<double>((random_bits >> 11) + 1), -53);
  }


  namespace
  {
    /** The purpose of a random number; every cell draws each at most once. */
    enum class Draw : std::uint32_t
    {
      wait,
      axis,
      first_daughter,
      second_daughter,
      axis_spread,      // the angle
      axis_spread_side, // which way
      noise,
      phase,
      death,
      // and from here on, one for each entry into a type and each way out of it
      transition = 0x1000,
      // and from here on, by the names of effects
      named = 0x80000000
    };

    /** The fourth word of the counter. It keeps the ids of founders apart from
     *  lineage keys, which may be equal numbers. */
    enum class Domain : std::uint32_t
    {
      lineage,
      founder
    };

    std::array<std::uint64_t, 2>
    bits(const std::uint64_t seed,
         const std::uint64_t number,
         const std::uint32_t draw,
         const Domain        domain)
    {
      return Random::bits(seed,
                          number,
                          draw | static_cast<std::uint64_t>(domain) << 32);
    }

    std::array<std::uint64_t, 2>
    bits(const std::uint64_t seed, const std::uint64_t key, const Draw draw)
    {
      return bits(seed, key, static_cast<std::uint32_t>(draw), Domain::lineage);
    }

    /** Exponentially distributed with mean 1. */
    double
    exponential_of(const std::array<std::uint64_t, 2> &random_bits)
    {
      return std::abs(std::log(uniform(random_bits[0])));
    }

    /** Uniform on the unit sphere (2-D: circle). */
    template <int dim>
    Tensor<1, dim>
    on_sphere(const std::array<std::uint64_t, 2> &random_bits)
    {
      const double angle = 2. * numbers::PI * uniform(random_bits[0]);

      Tensor<1, dim> n;
      if constexpr (dim == 2)
        {
          n[0] = std::cos(angle);
          n[1] = std::sin(angle);
        }
      else
        {
          // Archimedes: the height is uniform in (-1, 1] and independent of the
          // angle. With u = (1 + height)/2, the radius is 2 sqrt(u (1-u)).
          const double u      = uniform(random_bits[1]);
          const double radius = 2. * std::sqrt(u * (1. - u));
          n[0]                = radius * std::cos(angle);
          n[1]                = radius * std::sin(angle);
          n[2]                = 2. * u - 1.;
        }
      // The norm is 1 but for rounding, which is removed.
      return n / n.norm();
    }

    /**
     * 1 - cos of the angle to the axis on the sphere in 3-D. The cosine's
     * distribution function (e^{κ cos} - e^{-κ}) / (e^κ - e^{-κ}) is inverted
     * exactly, in a form that holds its digits for small and for large κ.
     */
    double
    von_mises_fisher(const double        kappa,
                     const std::uint64_t seed,
                     const std::uint64_t key)
    {
      // The number is in [0, 1), doc/theory.md (6.3d). The cosine is computed
      // as 1 minus this result, so small angles keep their digits.
      const double u = 1. - uniform(bits(seed, key, Draw::axis_spread)[0]);
      return std::min(2., -std::log1p(u * std::expm1(-2. * kappa)) / kappa);
    }

    /**
     * 1 - cos of the angle to the axis on the circle, by the rejection method
     * of Best and Fisher (1979), which accepts two of three trials or more. The
     * number of the trial stands in the upper half of the draw's word.
     */
    double
    von_mises(const double        kappa,
              const std::uint64_t seed,
              const std::uint64_t key)
    {
      // ρ = (τ - √(2 τ)) / (2 κ) with τ = 1 + root, without the differences.
      const double root = std::sqrt(1. + 4. * kappa * kappa);
      const double tau  = 1. + root;
      const double rho  = 2. * kappa * std::sqrt(tau) /
                         ((std::sqrt(tau) + std::sqrt(2.)) * (root + 1.));
      // This is r - 1 for the r of Best and Fisher.
      const double excess = (1. - rho) * (1. - rho) / (2. * rho);
      const auto   draw   = static_cast<std::uint32_t>(Draw::axis_spread);
      for (std::uint32_t trial = 0;; ++trial)
        {
          const auto random_bits =
            bits(seed, key, draw + (trial << 16), Domain::lineage);
          // The formulas are z = cos(π u); 1 - f = (r - 1)(1 - z) / (r + z), c
          // = κ (r - f)
          const double half_sine =
            std::sin(0.5 * numbers::PI * uniform(random_bits[0]));
          const double one_minus_z = 2. * half_sine * half_sine;
          const double one_minus_f =
            excess * one_minus_z / (2. + excess - one_minus_z);
          const double c = kappa * (excess + one_minus_f);
          const double u = uniform(random_bits[1]);
          // The first test accepts most trials without a logarithm.
          if (c * (2. - c) > u || std::log(c / u) + 1. >= c)
            return one_minus_f;
        }
    }
  } // namespace


  std::uint64_t
  founder_key(const std::uint64_t seed, const std::uint64_t id)
  {
    return bits(seed, id, 0, Domain::founder)[0];
  }


  std::uint64_t
  daughter_key(const std::uint64_t seed,
               const std::uint64_t mother_key,
               const unsigned int  which)
  {
    Assert(which < 2, ExcInternalError());
    return bits(seed,
                mother_key,
                which == 0 ? Draw::first_daughter : Draw::second_daughter)[0];
  }


  double
  exponential(const std::uint64_t seed,
              const std::uint64_t key,
              const double        rate)
  {
    // A rate of zero never ends the wait.
    if (rate == 0.)
      return std::numeric_limits<double>::infinity();
    return exponential_of(bits(seed, key, Draw::wait)) / rate;
  }


  double
  transition_threshold(const std::uint64_t seed,
                       const std::uint64_t key,
                       const unsigned int  n_changes,
                       const unsigned int  which)
  {
    // Each change of type and each way out has a draw of its own. The words of
    // different numbers of changes do not overlap as long as there are fewer
    // ways than the value of Draw::transition.
    const std::uint32_t draw =
      static_cast<std::uint32_t>(Draw::transition) * (1 + n_changes) + which;
    return exponential_of(bits(seed, key, draw, Domain::lineage));
  }


  double
  death_threshold(const std::uint64_t seed, const std::uint64_t key)
  {
    return exponential_of(bits(seed, key, Draw::death));
  }


  double
  part_of_phase(const std::uint64_t seed, const std::uint64_t key)
  {
    return 1. - uniform(bits(seed, key, Draw::phase)[0]);
  }

  std::uint64_t
  past_key(const std::uint64_t seed, const std::uint64_t founder_key)
  {
    return bits(seed, founder_key, Draw::phase)[0];
  }

  double
  threshold_of(const std::string  &name,
               const std::uint64_t seed,
               const std::uint64_t key,
               const unsigned int  n)
  {
    // A program's own fate draws by its name. The checksum of the name and the
    // number makes a word, and the bit of Draw::named keeps it apart from the
    // library's own draws.
    boost::crc_32_type word;
    word.process_bytes(name.data(), name.size());
    word.process_bytes(&n, sizeof(n));
    const auto draw = static_cast<std::uint32_t>(Draw::named) | word.checksum();
    return exponential_of(bits(seed, key, draw, Domain::lineage));
  }


  double
  normal_of(const std::string  &name,
            const std::uint64_t seed,
            const std::uint64_t key)
  {
    // The share of larger numbers is kept off 0 and 1, where the normal number
    // would be infinite.
    const double share = std::clamp(std::exp(-threshold_of(name, seed, key)),
                                    0x1p-53,
                                    1. - 0x1p-53);
    return std::sqrt(2.) * boost::math::erfc_inv(2. * share);
  }


  double
  noise(const std::uint64_t seed, const std::uint64_t key)
  {
    // The half keeps the number within (0, 1), without the ends.
    const std::uint64_t random_bits = bits(seed, key, Draw::noise)[0];
    return std::ldexp(static_cast<double>(random_bits >> 11) + 0.5, -53);
  }


  template <int dim>
  Tensor<1, dim>
  direction(const std::uint64_t seed, const std::uint64_t key)
  {
    return on_sphere<dim>(bits(seed, key, Draw::axis));
  }


  template <int dim>
  Tensor<1, dim>
  direction_around(const Tensor<1, dim> &axis,
                   const double          concentration,
                   const std::uint64_t   seed,
                   const std::uint64_t   key)
  {
    Assert(concentration > 0., ExcInternalError());
    // Below 1e-8 the distribution is uniform, and above 1e12 the spread is a
    // millionth of a radian: no use needs more, and the formulas hold in
    // between.
    const double kappa         = std::clamp(concentration, 1e-8, 1e12);
    const double one_minus_cos = dim == 2 ? von_mises(kappa, seed, key) :
                                            von_mises_fisher(kappa, seed, key);
    const double cos           = 1. - one_minus_cos;
    const double sin          = std::sqrt(one_minus_cos * (2. - one_minus_cos));
    const Tensor<1, dim> side = Directions::across(
      axis, on_sphere<dim>(bits(seed, key, Draw::axis_spread_side)));
    const Tensor<1, dim> n = cos * axis + sin * side;
    return n / n.norm();
  }


  MORULA_INSTANTIATE(direction);
  MORULA_INSTANTIATE(direction_around);
} // namespace Morula::Random
