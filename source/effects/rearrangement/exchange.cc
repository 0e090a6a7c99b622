// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace Morula
{
  namespace
  {
    using Random::bits, Random::uniform;

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


  namespace
  {
    /** S/l is at most this times a^(dim-2): to exchange daughters that stand
     *  close changes nothing. */
    constexpr double largest_ratio = 10.;
    /** The least facet across which cells exchange their places, as a part of a
     *  cell's mean surface: smaller than that of neighbours, as together the
     *  smallest facets still count for the diffusion coefficient. */
    constexpr double least_part = 1e-3;
    /** How many edges away a place can be of which an event must know. */
    constexpr double n_edges = 3.;

    /** What ranks tell each other of a cell at its place: key, type, D, f, free
     *  surface, rank and number. */
    using Told = std::tuple<std::uint64_t,
                            unsigned int,
                            double,
                            Tensor<1, 3>,
                            double,
                            unsigned int,
                            unsigned int>;

    /** An edge of another rank's place. */
    struct EdgeRecord
    {
      types::particle_index place, other; // ids
      double                area, distance;
    };

    /** The edges of this rank's places, and of those of others that this rank
     *  asks for by their numbers there. Collective.
     *  @param listeners get the ranks that have asked for a place */
    template <int dim>
    std::vector<EdgeRecord>
    edges_around(
      const PointList<dim>                                    &list,
      const NeighbourGraph<dim>                               &graph,
      const std::map<unsigned int, std::vector<unsigned int>> &wanted,
      std::vector<std::vector<unsigned int>>                  &listeners,
      const MPI_Comm                                           comm)
    {
      std::map<unsigned int, std::vector<EdgeRecord>> edges_to;
      for (const auto &[rank, numbers] : send_records(wanted, comm))
        for (const unsigned int p : numbers)
          {
            listeners[p].push_back(rank);
            graph.for_neighbours(p, [&, rank = rank](const auto &e) {
              edges_to[rank].push_back(
                {list.ids[p], graph.points.ids[e.other], e.area, e.distance});
            });
          }
      std::vector<EdgeRecord> edges;
      for (unsigned int p = 0; p < list.size(); ++p)
        graph.for_neighbours(p, [&](const auto &e) {
          edges.push_back(
            {list.ids[p], graph.points.ids[e.other], e.area, e.distance});
        });
      for (const auto &[rank, of_rank] : send_records(edges_to, comm))
        edges.insert(edges.end(), of_rank.begin(), of_rank.end());
      return edges;
    }

    /** Gives places their edges; those of which one end is not known here are
     *  left out. @param spacing a, µm */
    template <int dim>
    void
    join_edges(const std::vector<EdgeRecord>               &edges,
               const std::array<const PointList<dim> *, 2> &parts,
               const double                                 spacing,
               Places                                      &around)
    {
      std::unordered_map<types::particle_index, unsigned int> place_of;
      for (const PointList<dim> *part : parts)
        for (const auto id : part->ids)
          place_of.emplace(id, place_of.size());
      std::vector<std::vector<Places::Edge>> of_place(around.size());
      const double                           V = std::pow(spacing, dim);
      const double cap = largest_ratio * std::pow(spacing, dim - 2);
      for (const EdgeRecord &edge : edges)
        if (const auto other = place_of.find(edge.other);
            other != place_of.end())
          of_place[place_of.at(edge.place)].push_back(
            {other->second,
             edge.area,
             std::min(edge.area / edge.distance, cap) / V});
      around.offsets.push_back(0);
      for (const auto &of_one : of_place)
        {
          around.edges.insert(around.edges.end(), of_one.begin(), of_one.end());
          around.offsets.push_back(around.edges.size());
        }
      around.sort_edges();
    }
  } // namespace


  template <int dim>
  Places
  places_of(const Tissue<dim>     &tissue,
            std::vector<Occupant> &cells,
            NeighbourSearch        search)
  {
    // First each rank finds the edges of its own places. Then it gets the
    // places of others around, and asks their owners for the edges of these:
    // that also tells the owners who listens to them. An edge of which one end
    // is not known here is left out: no event here can feel it.
    const MPI_Comm            comm = tissue.communicator();
    const std::vector<double> free = free_surfaces(tissue);
    PointList<dim>            list(Flat<Told>::n);
    for (unsigned int p = 0; p < cells.size(); ++p)
      list.add_value(tissue.cells().id(p),
                     tissue.cells().position(p),
                     Told(cells[p].key,
                          cells[p].type,
                          cells[p].diffusion,
                          cells[p].drive,
                          free[p],
                          cells[p].rank,
                          cells[p].number));
    search.least_part               = least_part;
    const NeighbourGraph<dim> graph = neighbours(tissue, list, search);
    const PointList<dim>      ghosts =
      halo(list, tissue.grid(), n_edges * graph.longest);

    const std::array<const PointList<dim> *, 2> parts = {{&list, &ghosts}};
    const std::size_t                           n_own = cells.size();
    Places                                      around;
    std::map<unsigned int, std::vector<unsigned int>> wanted; // by rank
    for (const PointList<dim> *part : parts)
      for (std::size_t i = 0; i < part->size(); ++i)
        {
          const auto [key, type, D, f, free_area, rank, number] =
            part->template value<Told>(i);
          around.keys.push_back(key);
          around.positions.emplace_back();
          for (unsigned int d = 0; d < dim; ++d)
            around.positions.back()[d] = part->positions[i][d];
          around.free.push_back(free_area);
          around.own.push_back(part == &list);
          if (part == &list)
            continue;
          cells.push_back({key, type, D, f, rank, number});
          wanted[rank].push_back(number);
        }
    around.listeners.resize(n_own);
    join_edges(edges_around(list, graph, wanted, around.listeners, comm),
               parts,
               graph.spacing,
               around);
    return around;
  }


  void
  run(ExchangeRounds &rounds, const Places &places, const MPI_Comm comm)
  {
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      {
        rounds.run_in_order();
        return;
      }
    // After each round the ranks tell each other what they have run. The owner
    // of a place knows who listens to it.
    std::unordered_map<std::uint64_t, unsigned int> own;
    for (unsigned int p = 0; p < places.listeners.size(); ++p)
      own[places.keys[p]] = p;
    while (Utilities::MPI::sum(rounds.n_left(), comm) > 0)
      {
        std::map<unsigned int, std::vector<ExchangeResult>> results_to;
        for (const ExchangeResult &result : rounds.run_round())
          for (const unsigned int rank : places.listeners[own.at(result.p)])
            results_to[rank].push_back(result);
        for (const auto &[rank, results] : send_records(results_to, comm))
          for (const ExchangeResult &result : results)
            rounds.take(result);
      }
  }


  MORULA_INSTANTIATE(places_of);
} // namespace Morula
