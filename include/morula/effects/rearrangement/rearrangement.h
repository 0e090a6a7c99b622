// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_rearrangement_rearrangement_h
#define morula_effects_rearrangement_rearrangement_h

#include <morula/effects/effect.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace Morula
{
  /** A cell, as far as exchanges of places ask for it. */
  struct Occupant
  {
    /** Its lineage key. */
    std::uint64_t key;
    unsigned int  type;
    /** D, µm²/day; 0: it keeps its place. */
    double diffusion;
    /** f, kPa µm^dim/µm. */
    Tensor<1, 3> drive;
    /** The rank of the cell, and its place there. */
    unsigned int rank, number;
  };

  /** Places of cells and their neighbourhood, which stay as they are while
   *  cells exchange them. */
  struct Places
  {
    /** A neighbouring place. */
    struct Edge
    {
      unsigned int other;
      /** S, µm^(dim-1). */
      double area;
      /** S/(l V̄), with its cap, per µm². */
      double rate;
    };

    /** Lineage keys of the cells that are there at the beginning. */
    std::vector<std::uint64_t> keys;
    std::vector<Point<3>>      positions; // µm
    std::vector<double>        free;      // free surface, µm^(dim-1)
    /** Edges of place p: [offsets[p], offsets[p + 1]), by the others' keys. */
    std::vector<unsigned int> offsets;
    std::vector<Edge>         edges;
    /** Whether events of a place are run here, rather than told by others. */
    std::vector<bool> own;
    /** Ranks that must be told of the events of an own place. */
    std::vector<std::vector<unsigned int>> listeners;

    std::size_t
    size() const
    {
      return keys.size();
    }

    /** Sorts the edges of each place. To be called when all are there. */
    void
    sort_edges()
    {
      for (std::size_t p = 0; p < size(); ++p)
        std::sort(edges.begin() + offsets[p],
                  edges.begin() + offsets[p + 1],
                  [this](const Edge &a, const Edge &b) {
                    return keys[a.other] < keys[b.other];
                  });
    }
  };

  /** The energy E = Σ γ S of the contacts between cells and of their free
   *  surface, and its changes: doc/theory.md (12.5). */
  class AdhesionEnergy
  {
  public:
    /** @param temperature T, kPa µm^dim */
    AdhesionEnergy(const TypeTensions &tensions, const double temperature)
      : tensions(tensions)
      , temperature(temperature)
    {}

    /** ΔE if the cells at two neighbouring places change them. */
    double
    change(const Places                &places,
           const std::vector<Occupant> &occupants,
           const unsigned int           p,
           const unsigned int           q) const;

    /** Whether an exchange that changes the energy so is accepted; @p u is
     *  uniform in (0, 1]. */
    bool
    accepts(const double change, const double u) const
    {
      if (temperature > 0.)
        return u * (1. + std::exp(change / temperature)) <= 1.;
      return change < 0. || (change == 0. && u <= 0.5);
    }

    /** γ between two types. */
    double
    between(const unsigned int a, const unsigned int b) const
    {
      return tensions.between.empty() ? 0. : tensions.between[a][b];
    }

    /** γ of the free surface of a type. */
    double
    with_surface(const unsigned int a) const
    {
      return tensions.with_surface.empty() ? 0. : tensions.with_surface[a];
    }

  private:
    const TypeTensions tensions;
    const double       temperature;
  };

  /** An attempt of two cells to exchange their places. */
  struct Attempt
  {
    /** When, from the beginning of the step, day. */
    double time;
    /** Which decides about acceptance. */
    double u;
    /** Places, that with the lower key first. */
    unsigned int p, q;
    /** Number among those of this pair. */
    unsigned int n;
  };

  /**
   * All attempts in a step of length @p dt (day), in the order of time: a
   * Poisson process for each edge, from the keys of the cells that stand there
   * at the beginning. doc/theory.md (12.4)
   * @param moment a number without a unit for the time of the step, which makes
   *               its draws its own
   */
  std::vector<Attempt>
  attempts(const Places                &places,
           const std::vector<Occupant> &occupants,
           const std::uint64_t          seed,
           const double                 moment,
           const double                 dt);

  /** What became of an attempt. */
  struct ExchangeResult
  {
    std::uint64_t p, q; // keys of the places
    unsigned int  n;
    bool          accepted;
    Occupant      at_p, at_q; // afterwards
  };

  /**
   * Runs attempts. An event of the places (p, q) reads the cells at them and
   * around them. It can run as soon as it is the first one that is left at each
   * of these places, so that all that can run at once do not disturb each
   * other: a round. The result is that in the order of time.
   */
  class ExchangeRounds
  {
  public:
    ExchangeRounds(const Places         &places,
                   std::vector<Occupant> occupants,
                   std::vector<Attempt>  attempts,
                   const AdhesionEnergy &energy);

    /** Runs everything in the order of time; all places must be own. */
    void
    run_in_order()
    {
      for (const Attempt &attempt : list)
        run(attempt);
    }

    /** Runs those attempts of own places that can run now. */
    std::vector<ExchangeResult>
    run_round();

    /** Takes what another rank has run. */
    void
    take(const ExchangeResult &result);

    /** How many attempts are left that are to be run here. */
    std::size_t
    n_left() const
    {
      return left;
    }

    /** Who is where. */
    const std::vector<Occupant> &
    occupants() const
    {
      return occupants_;
    }

    /** How often places have changed their cell. */
    const std::vector<unsigned int> &
    n_exchanges() const
    {
      return n_exchanges_;
    }

  private:
    /** The first attempt that is left at a place, or null. */
    const Attempt *
    first_at(const unsigned int place)
    {
      std::size_t &head = heads[place];
      while (head < of_place[place].size() && done[of_place[place][head]])
        ++head;
      return head < of_place[place].size() ? &list[of_place[place][head]] :
                                             nullptr;
    }
    bool
    can_run(const Attempt &attempt);
    bool
    run(const Attempt &attempt);

    const Places             &places;
    std::vector<Occupant>     occupants_;
    std::vector<Attempt>      list;
    const AdhesionEnergy     &energy;
    std::vector<unsigned int> n_exchanges_;
    std::vector<bool>         done;
    std::size_t               left = 0;
    /** Attempts of each place in the order of time, and the first that may be
     *  left. */
    std::vector<std::vector<std::size_t>> of_place;
    std::vector<std::size_t>              heads;
    /** Places by their keys, if others tell of them. */
    std::unordered_map<std::uint64_t, unsigned int> place_of;
  };

  /**
   * The places of this rank's cells, in their order, and behind them those of
   * others that its events can feel: three edges around. Collective.
   * @param cells  of this rank; the others are added
   * @param search how far neighbours can be
   */
  template <int dim>
  Places
  places_of(const Tissue<dim>     &tissue,
            std::vector<Occupant> &cells,
            NeighbourSearch        search = {});

  /** Runs all attempts, on all ranks together. Collective. */
  void
  run(ExchangeRounds &rounds, const Places &places, const MPI_Comm comm);

  /**
   * F of a cell that comes to a place: doc/theory.md (12.6). The place keeps
   * its volume, and its elastic deformation in shape.
   * @param F_e of the place, after what is released
   * @param V   of the place, µm^dim
   * @param F_g of the cell
   * @param V0  of the cell, µm^dim
   */
  template <int dim>
  Tensor<2, dim>
  deformation_at(const Tensor<2, dim> &F_e,
                 const double          V,
                 const Tensor<2, dim> &F_g,
                 const double          V0);

  /** F_e whose logarithmic shear is multiplied by @p part; its volume and
   *  rotation stay. */
  template <int dim>
  Tensor<2, dim>
  with_less_shear(const Tensor<2, dim> &F_e, const double part);
} // namespace Morula

#endif
