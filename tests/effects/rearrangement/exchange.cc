// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  using Pairs = std::map<std::pair<unsigned int, unsigned int>,
                         std::pair<double, double>>; // S and rate

  /** Places in any order of keys, with these pairs. */
  Places
  places_of_pairs(const unsigned int n, const Pairs &pairs)
  {
    Places                                 places;
    std::vector<std::vector<Places::Edge>> of_place(n);
    for (const auto &[pair, values] : pairs)
      {
        const auto [p, q] = pair;
        of_place[p].push_back({q, values.first, values.second});
        of_place[q].push_back({p, values.first, values.second});
      }
    places.offsets.push_back(0);
    for (unsigned int p = 0; p < n; ++p)
      {
        places.keys.push_back((p * 2654435761u) ^ 0x5bd1e995u);
        places.positions.push_back(Point<3>());
        places.free.push_back(0.);
        places.own.push_back(true);
        places.edges.insert(places.edges.end(),
                            of_place[p].begin(),
                            of_place[p].end());
        places.offsets.push_back(places.edges.size());
      }
    places.sort_edges();
    return places;
  }

  std::vector<Occupant>
  occupants_of(const Places &places, const std::vector<unsigned int> &types)
  {
    std::vector<Occupant> list;
    for (unsigned int p = 0; p < places.size(); ++p)
      list.push_back({places.keys[p], types[p], 1., {}, 0, p});
    return list;
  }

  /** A square lattice that closes on itself, D = a = 1. */
  Places
  torus(const unsigned int n)
  {
    Pairs pairs;
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
        {
          pairs[{i + n * j, (i + 1) % n + n * j}]   = {1., 1.};
          pairs[{i + n * j, i + n * ((j + 1) % n)}] = {1., 1.};
        }
    Places places = places_of_pairs(n * n, pairs);
    for (unsigned int p = 0; p < n * n; ++p)
      places.positions[p] = Point<3>(p % n, p / n, 0.);
    return places;
  }

  std::vector<Occupant>
  run_one(const Places                &places,
          const std::vector<Occupant> &occupants,
          const AdhesionEnergy        &energy,
          const std::uint64_t          seed,
          const double                 dt,
          const bool                   by_rounds = false)
  {
    ExchangeRounds rounds(places,
                          occupants,
                          attempts(places, occupants, seed, 0.5, dt),
                          energy);
    if (by_rounds)
      while (rounds.n_left() > 0)
        rounds.run_round();
    else
      rounds.run_in_order();
    return rounds.occupants();
  }

  /** Starts a new step: clocks follow the keys of the cells that are there. */
  void
  begin_step(Places &places, const std::vector<Occupant> &occupants)
  {
    for (unsigned int p = 0; p < places.size(); ++p)
      places.keys[p] = occupants[p].key;
    places.sort_edges();
  }

  TypeTensions
  two_types(const double gamma)
  {
    return {{{0., gamma}, {gamma, 0.}}, {0., 0.}};
  }
} // namespace


TEST(Exchange, HasTheProbabilitiesOfItsMasterEquation)
{
  // Eight places, three cells of one type and five of another: 56 states. The
  // probabilities are exp(M t) p, from the rates 2 ν / (1 + e^(ΔE/T)).
  constexpr unsigned int                 n = 8;
  std::mt19937                           generator(5);
  std::uniform_real_distribution<double> uniform(0.2, 1.);
  Pairs                                  pairs;
  for (unsigned int p = 0; p < n; ++p)
    for (unsigned int q = p + 1; q < n; ++q)
      if (q == p + 1 || generator() % 2 == 0)
        {
          const double S = uniform(generator), nu = uniform(generator);
          pairs[{p, q}] = {S, nu};
        }
  const Places         places = places_of_pairs(n, pairs);
  const AdhesionEnergy energy(two_types(1.), 0.5);

  std::vector<unsigned int> states, number(1u << n, 0);
  for (unsigned int s = 0; s < (1u << n); ++s)
    if (std::bitset<n>(s).count() == 3)
      {
        number[s] = states.size();
        states.push_back(s);
      }
  ASSERT_EQ(states.size(), 56u);
  const auto energy_of = [&](const unsigned int s) {
    double sum = 0.;
    for (const auto &[pair, values] : pairs)
      sum +=
        ((s >> pair.first) & 1) != ((s >> pair.second) & 1) ? values.first : 0.;
    return sum;
  };
  std::vector<std::vector<double>> M(56, std::vector<double>(56, 0.));
  for (const unsigned int s : states)
    for (const auto &[pair, values] : pairs)
      {
        const unsigned int a = (s >> pair.first) & 1,
                           b = (s >> pair.second) & 1;
        if (a == b)
          continue;
        const unsigned int to = s ^ (1u << pair.first) ^ (1u << pair.second);
        const double       rate =
          2. * values.second /
          (1. + std::exp((energy_of(to) - energy_of(s)) / 0.5));
        M[number[to]][number[s]] += rate;
        M[number[s]][number[s]] -= rate;
      }
  const std::vector<unsigned int> types = {1, 0, 1, 0, 0, 1, 0, 0};
  unsigned int                    first = 0;
  for (unsigned int p = 0; p < n; ++p)
    first |= types[p] << p;

  for (const double t : {0.1, 1., 4.})
    {
      // exp(M t) by many small steps of the fourth order.
      std::vector<double> exact(56, 0.);
      exact[number[first]]           = 1.;
      constexpr unsigned int n_steps = 400;
      for (unsigned int k = 0; k < n_steps; ++k)
        {
          std::vector<double> term = exact;
          for (unsigned int order = 1; order <= 4; ++order)
            {
              std::vector<double> next(56, 0.);
              for (unsigned int i = 0; i < 56; ++i)
                for (unsigned int j = 0; j < 56; ++j)
                  next[i] += M[i][j] * term[j] * t / n_steps / order;
              term = next;
              for (unsigned int i = 0; i < 56; ++i)
                exact[i] += term[i];
            }
        }
      constexpr unsigned int n_samples = 20000;
      std::vector<double>    found(56, 0.);
      const auto             occupants = occupants_of(places, types);
      for (unsigned int sample = 0; sample < n_samples; ++sample)
        {
          const auto   end = run_one(places, occupants, energy, sample, t);
          unsigned int s   = 0;
          for (unsigned int p = 0; p < n; ++p)
            s |= end[p].type << p;
          ++found[number[s]];
          if (sample % 20 == 0)
            {
              const auto other =
                run_one(places, occupants, energy, sample, t, true);
              for (unsigned int p = 0; p < n; ++p)
                EXPECT_EQ(other[p].key, end[p].key);
            }
        }
      // States that are too rare are taken together.
      double     chi = 0., rare = 0., rare_found = 0.;
      int        freedom = -1;
      const auto add     = [&](const double f, const double e) {
        chi += (f - e) * (f - e) / e;
        ++freedom;
      };
      for (unsigned int i = 0; i < 56; ++i)
        if (exact[i] * n_samples < 10.)
          rare += exact[i] * n_samples, rare_found += found[i];
        else
          add(found[i], exact[i] * n_samples);
      if (rare > 5.)
        add(rare_found, rare);
      // p > 0.01 by Wilson and Hilferty's approximation.
      const double z = (std::cbrt(chi / freedom) - 1. + 2. / (9. * freedom)) /
                       std::sqrt(2. / (9. * freedom));
      EXPECT_LT(z, 2.33) << "t = " << t << ", chi^2 = " << chi << " of "
                         << freedom;
    }
}


TEST(Exchange, DriftsByTheHyperbolicTangent)
{
  Places places = torus(64);
  for (const double force : {0.2, 2.})
    {
      std::vector<unsigned int> types(64 * 64, 0);
      auto                      occupants = occupants_of(places, types);
      std::set<std::uint64_t>   driven;
      for (unsigned int p = 0; p < occupants.size(); p += 31)
        {
          occupants[p].drive[0] = force;
          driven.insert(occupants[p].key);
        }
      // Across the seam the force is felt the wrong way; cells there do not
      // count, nor does any that is driven into it.
      const AdhesionEnergy energy(TypeTensions(), 1.);
      double               way = 0., n = 0.;
      for (unsigned int step = 0; step < 60; ++step)
        {
          begin_step(places, occupants);
          std::map<std::uint64_t, double> before;
          for (unsigned int p = 0; p < occupants.size(); ++p)
            if (driven.count(occupants[p].key))
              before[occupants[p].key] = places.positions[p][0];
          occupants = run_one(places, occupants, energy, 1000 + step, 1.);
          for (unsigned int p = 0; p < occupants.size(); ++p)
            if (driven.count(occupants[p].key))
              {
                const double from = before[occupants[p].key];
                if (from < 20. || from > 44.)
                  continue;
                way += places.positions[p][0] - from;
                ++n;
              }
        }
      const double exact = 2. * std::tanh(0.5 * force);
      // 3 %, and the statistical error of a walk with two steps a unit of time.
      EXPECT_NEAR(way / n, exact, 0.03 * exact + 2.5 * std::sqrt(2. / n));
    }
}


TEST(Exchange, NeverRaisesTheEnergyWithoutFluctuations)
{
  const AdhesionEnergy energy(two_types(1.), 0.);
  EXPECT_TRUE(energy.accepts(-1e-9, 1.));
  EXPECT_FALSE(energy.accepts(1e-9, 1e-9));
  EXPECT_TRUE(energy.accepts(0., 0.5));
  EXPECT_FALSE(energy.accepts(0., 0.51));
}


TEST_2D_3D(Exchange, LeavesSpaceAndShearWithThePlace)
{
  std::mt19937         generator(2);
  const Tensor<2, dim> F_e =
    unit_tensor<dim>() + 0.3 * random_tensor<2, dim>(generator);
  const Tensor<2, dim> F_g =
    1.1 * unit_tensor<dim>() + 0.1 * random_tensor<2, dim>(generator);
  // The place keeps its space whatever comes.
  const Tensor<2, dim> F = deformation_at(F_e, 17., F_g, 9.);
  EXPECT_NEAR(9. * determinant(F), 17., 1e-12);
  const Tensor<2, dim> found = F * invert(F_g);
  EXPECT_LT((found / std::pow(determinant(found), 1. / dim) -
             F_e / std::pow(determinant(F_e), 1. / dim))
              .norm(),
            1e-13);
  // With its own cell nothing changes.
  EXPECT_LT(
    (deformation_at(F_e, 5. * determinant(F_e) * determinant(F_g), F_g, 5.) -
     F_e * F_g)
      .norm(),
    1e-14);
  // Shear is released, not the volume and not the rotation.
  const Tensor<2, dim> half  = with_less_shear(F_e, 0.5);
  const Tensor<2, dim> twice = with_less_shear(half, 0.5);
  EXPECT_NEAR(determinant(half), determinant(F_e), 1e-13);
  EXPECT_LT((twice - with_less_shear(F_e, 0.25)).norm(), 1e-12);
  EXPECT_LT((with_less_shear(F_e, 1.) - F_e).norm(), 1e-12);
  const Tensor<2, dim> none = with_less_shear(F_e, 0.);
  EXPECT_LT((none * transpose(none) -
             std::pow(determinant(F_e), 2. / dim) * unit_tensor<dim>())
              .norm(),
            1e-12);
  const Tensor<2, dim> stretch = F_e * invert(none);
  EXPECT_LT((stretch - transpose(stretch)).norm(), 1e-12);
}
