// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/rearrangement/rearrangement.h>

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace Morula
{
  namespace
  {
    using Philox = r123::Philox4x32;

    std::uint32_t
    low(const std::uint64_t x)
    {
      return static_cast<std::uint32_t>(x);
    }

    std::uint32_t
    high(const std::uint64_t x)
    {
      return static_cast<std::uint32_t>(x >> 32);
    }

    /** 128 random bits of a key and a counter. */
    std::array<std::uint64_t, 2>
    bits(const std::uint64_t key, const std::uint64_t a, const std::uint64_t b)
    {
      const auto words =
        Philox()(Philox::ctr_type{{low(a), high(a), low(b), high(b)}},
                 Philox::key_type{{low(key), high(key)}});
      const auto join = [](const std::uint32_t x, const std::uint32_t y) {
        return x | (static_cast<std::uint64_t>(y) << 32);
      };
      return {{join(words[0], words[1]), join(words[2], words[3])}};
    }

    /** In (0, 1]. */
    double
    uniform(const std::uint64_t random_bits)
    {
      return std::ldexp(static_cast<double>((random_bits >> 11) + 1), -53);
    }

    /** Of a pair of cells in a step: the same for any order of evaluation. */
    std::uint64_t
    key_of_pair(const std::uint64_t seed,
                const std::uint64_t lower,
                const std::uint64_t higher,
                const double        moment)
    {
      std::uint64_t bits_of_moment;
      std::memcpy(&bits_of_moment, &moment, sizeof(moment));
      constexpr std::uint64_t purpose = 0x65786368616e6765; // "exchange"
      return bits(bits(seed, lower, higher)[0], bits_of_moment, purpose)[0];
    }
  } // namespace


  double
  AdhesionEnergy::change(const Places                &places,
                         const std::vector<Occupant> &occupants,
                         const unsigned int           p,
                         const unsigned int           q) const
  {
    // The contact of the two cells with each other stays. The sums go through
    // the neighbours in the order of their keys, p being the place with the
    // lower key, so that they have the same bits on any rank.
    const Occupant &i = occupants[p], &j = occupants[q];
    double          sum = 0.;
    const auto      add = [&](const unsigned int place,
                         const unsigned int other,
                         const unsigned int leaves,
                         const unsigned int comes) {
      for (unsigned int e = places.offsets[place];
           e < places.offsets[place + 1];
           ++e)
        if (const unsigned int r = places.edges[e].other; r != other)
          sum += places.edges[e].area * (between(comes, occupants[r].type) -
                                         between(leaves, occupants[r].type));
      sum += places.free[place] * (with_surface(comes) - with_surface(leaves));
    };
    if (i.type != j.type)
      {
        add(p, q, i.type, j.type);
        add(q, p, j.type, i.type);
      }
    for (unsigned int d = 0; d < 3; ++d)
      sum -= (i.drive[d] - j.drive[d]) *
             (places.positions[q][d] - places.positions[p][d]);
    return sum;
  }


  std::vector<Attempt>
  attempts(const Places                &places,
           const std::vector<Occupant> &occupants,
           const std::uint64_t          seed,
           const double                 moment,
           const double                 dt)
  {
    // Attempts come at the rate 2 ν, as half of them are accepted where the
    // energy stays, doc/theory.md (12.4). Each edge is seen from both of its
    // places, and is taken from the one with the lower key.
    std::vector<Attempt> list;
    for (unsigned int p = 0; p < places.size(); ++p)
      for (unsigned int e = places.offsets[p]; e < places.offsets[p + 1]; ++e)
        {
          const unsigned int q = places.edges[e].other;
          if (places.keys[q] <= places.keys[p])
            continue;
          const double D_p = occupants[p].diffusion,
                       D_q = occupants[q].diffusion;
          if (D_p <= 0. || D_q <= 0.)
            continue;
          const double rate =
            2. * places.edges[e].rate * 2. * D_p * D_q / (D_p + D_q);
          if (rate <= 0.)
            continue;
          const std::uint64_t key =
            key_of_pair(seed, places.keys[p], places.keys[q], moment);
          double time = 0.;
          for (unsigned int n = 0;; ++n)
            {
              const auto random = bits(key, n, 0);
              time -= std::log(uniform(random[0])) / rate;
              if (time > dt)
                break;
              list.push_back({time, uniform(random[1]), p, q, n});
            }
        }
    std::sort(list.begin(),
              list.end(),
              [&](const Attempt &a, const Attempt &b) {
                if (a.time != b.time)
                  return a.time < b.time;
                return std::make_pair(places.keys[a.p], places.keys[a.q]) <
                       std::make_pair(places.keys[b.p], places.keys[b.q]);
              });
    return list;
  }


  ExchangeRounds::ExchangeRounds(const Places         &places,
                                 std::vector<Occupant> occupants,
                                 std::vector<Attempt>  attempts,
                                 const AdhesionEnergy &energy)
    : places(places)
    , occupants_(std::move(occupants))
    , list(std::move(attempts))
    , energy(energy)
    , n_exchanges_(places.size(), 0)
    , done(list.size(), false)
    , of_place(places.size())
    , heads(places.size(), 0)
  {
    for (std::size_t k = 0; k < list.size(); ++k)
      {
        of_place[list[k].p].push_back(k);
        of_place[list[k].q].push_back(k);
        left += places.own[list[k].p];
      }
  }


  bool
  ExchangeRounds::run(const Attempt &attempt)
  {
    const bool accepted =
      energy.accepts(energy.change(places, occupants_, attempt.p, attempt.q),
                     attempt.u);
    if (accepted)
      {
        std::swap(occupants_[attempt.p], occupants_[attempt.q]);
        ++n_exchanges_[attempt.p];
        ++n_exchanges_[attempt.q];
      }
    done[&attempt - list.data()] = true;
    --left;
    return accepted;
  }


  bool
  ExchangeRounds::can_run(const Attempt &attempt)
  {
    // The list is sorted, so that an earlier attempt stands before.
    for (const unsigned int place : {attempt.p, attempt.q})
      {
        if (first_at(place) != &attempt)
          return false;
        for (unsigned int e = places.offsets[place];
             e < places.offsets[place + 1];
             ++e)
          if (const Attempt *first = first_at(places.edges[e].other);
              first != nullptr && first < &attempt)
            return false;
      }
    return true;
  }


  std::vector<ExchangeResult>
  ExchangeRounds::run_round()
  {
    // First all that can run are found, with nothing changed, then they run.
    std::vector<const Attempt *> ready;
    for (unsigned int p = 0; p < places.size(); ++p)
      if (places.own[p])
        if (const Attempt *first = first_at(p);
            first != nullptr && first->p == p && can_run(*first))
          ready.push_back(first);
    std::vector<ExchangeResult> results;
    for (const Attempt *attempt : ready)
      {
        const bool accepted = run(*attempt);
        results.push_back({places.keys[attempt->p],
                           places.keys[attempt->q],
                           attempt->n,
                           accepted,
                           occupants_[attempt->p],
                           occupants_[attempt->q]});
      }
    return results;
  }


  void
  ExchangeRounds::take(const ExchangeResult &result)
  {
    // Another rank may tell of a pair of which only one place is known here.
    // That place is at the rim, and gets the cell that it has now.
    if (place_of.empty())
      for (unsigned int p = 0; p < places.size(); ++p)
        place_of[places.keys[p]] = p;
    const auto p = place_of.find(result.p), q = place_of.find(result.q);
    const auto occupy = [&](const auto place, const Occupant &occupant) {
      if (place == place_of.end())
        return;
      occupants_[place->second] = occupant;
      n_exchanges_[place->second] += result.accepted;
    };
    occupy(p, result.at_p);
    occupy(q, result.at_q);
    if (p == place_of.end() || q == place_of.end())
      return;
    for (const std::size_t k : of_place[p->second])
      if (!done[k] && list[k].p == p->second && list[k].q == q->second &&
          list[k].n == result.n)
        {
          done[k] = true;
          break;
        }
  }
} // namespace Morula
