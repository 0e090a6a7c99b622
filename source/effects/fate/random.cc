// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/random.h>

#include <deal.II/base/numbers.h>

#include <Random123/philox.h>

#include <array>
#include <cmath>
#include <limits>

namespace Morula::Random
{
  using namespace dealii;

  namespace
  {
    /** Fourth counter word: keeps founder ids apart from lineage keys. */
    enum class Domain : std::uint32_t
    {
      lineage,
      founder
    };

    /**
     * 128 random bits. Philox key: the two halves of the seed; counter: the two
     * halves of @p number, @p draw, @p domain.
     */
    std::array<std::uint64_t, 2>
    bits(const std::uint64_t seed,
         const std::uint64_t number,
         const std::uint32_t draw,
         const Domain        domain)
    {
      const auto low = [](const std::uint64_t x) {
        return static_cast<std::uint32_t>(x);
      };
      const auto high = [](const std::uint64_t x) {
        return static_cast<std::uint32_t>(x >> 32);
      };
      const auto join = [](const std::uint32_t low, const std::uint32_t high) {
        return low | (static_cast<std::uint64_t>(high) << 32);
      };

      r123::Philox4x32::ctr_type counter = {
        {low(number), high(number), draw, static_cast<std::uint32_t>(domain)}};
      r123::Philox4x32::key_type key = {{low(seed), high(seed)}};

      const auto words = r123::Philox4x32()(counter, key);
      return {{join(words[0], words[1]), join(words[2], words[3])}};
    }

    std::array<std::uint64_t, 2>
    bits(const std::uint64_t seed, const std::uint64_t key, const Draw draw)
    {
      return bits(seed, key, static_cast<std::uint32_t>(draw), Domain::lineage);
    }

    /** The upper 53 bits as (k + 1) 2^-53, k = 0...2^53 - 1: in (0, 1]. */
    double
    uniform(const std::uint64_t random_bits)
    {
      return std::ldexp(static_cast<double>((random_bits >> 11) + 1), -53);
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
               const Draw          which)
  {
    Assert(which == Draw::first_daughter || which == Draw::second_daughter,
           ExcInternalError());
    return bits(seed, mother_key, which)[0];
  }


  double
  exponential(const std::uint64_t seed,
              const std::uint64_t key,
              const double        rate)
  {
    if (rate == 0.)
      return std::numeric_limits<double>::infinity();
    return std::abs(std::log(uniform(bits(seed, key, Draw::wait)[0]))) / rate;
  }


  template <int dim>
  Tensor<1, dim>
  direction(const std::uint64_t seed, const std::uint64_t key)
  {
    const auto   random_bits = bits(seed, key, Draw::axis);
    const double angle       = 2. * numbers::PI * uniform(random_bits[0]);

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
    return n / n.norm();
  }


  template Tensor<1, 2>
  direction<2>(const std::uint64_t, const std::uint64_t);
  template Tensor<1, 3>
  direction<3>(const std::uint64_t, const std::uint64_t);
} // namespace Morula::Random
