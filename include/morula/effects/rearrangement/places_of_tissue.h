// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_rearrangement_places_of_tissue_h
#define morula_effects_rearrangement_places_of_tissue_h

#include <morula/effects/rearrangement/exchange.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/tissue.h>

#include <vector>

namespace Morula
{
  /** The places of a rank's cells, and those of others that its events can
   *  feel: three edges around. */
  struct PlacesOfTissue
  {
    /** Those of this rank's cells first, in their order. */
    Places                places;
    std::vector<Occupant> occupants;
    /** Ranks that must be told of the events of an own place. */
    std::vector<std::vector<unsigned int>> listeners;
  };

  /** @param cells  of this rank
   *  @param search how far neighbours can be. Collective. */
  template <int dim>
  PlacesOfTissue
  places_of(const Tissue<dim>           &tissue,
            const std::vector<Occupant> &cells,
            NeighbourSearch              search = {});

  /** Runs all attempts, on all ranks together. Collective. */
  void
  run(ExchangeRounds       &rounds,
      const PlacesOfTissue &around,
      const MPI_Comm        comm);
} // namespace Morula

#endif
