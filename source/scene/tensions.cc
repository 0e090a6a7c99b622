// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/forces/type_fractions.h>
#include <morula/effects/forces/type_tension.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/surface/surface_tension.h>
#include <morula/effects/surface/type_surface_tension.h>
#include <morula/scene/first_cells.h>
#include <morula/scene/tensions.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <sstream>
#include <vector>

namespace Morula
{
  namespace
  {
    /** A fraction that a type reaches in the middle of a domain 2 h wide. */
    constexpr double of_a_domain = 0.9;


    /** The largest fraction of each type at the founders. Collective. */
    template <int dim>
    std::vector<double>
    largest_fractions(const Scene               &scene,
                      const Founders<dim>       &founders,
                      const SurfacePatches<dim> &surface,
                      const MPI_Comm             comm)
    {
      // The founders of a rank may stand anywhere, so the sums of all ranks'
      // splines are joined; there are far fewer splines than cells.
      const unsigned int    n_types = scene.cell_types.types.size();
      const FirstCells<dim> cells(scene, founders, surface, comm);
      const GridBox<dim>    box({},
                                {},
                             scene.grid.spacing,
                             leading_components<dim>(scene.grid.offset));
      TypeFractions<dim>    mine(box, n_types), all(box, n_types);
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        {
          std::vector<double>    row  = cells.row(i);
          const PresentCell<dim> cell = cells.cell(row, i);
          mine.add(cell.position(), cell.cell().volume(), cell.type());
        }
      for (const auto &sums : Utilities::MPI::all_gather(comm, mine.sums))
        {
          TypeFractions<dim> part(box, n_types);
          part.sums = sums;
          all.add(part);
        }
      return all.largest();
    }
  } // namespace


  TypeTensions
  tensions_of(const Scene &scene)
  {
    TypeTensions tensions;
    tensions.between = scene.keys<TypeTensionParameters>().matrix();
    for (const Key<double> &key :
         scene.keys<TypeSurfaceTensionParameters>().tensions)
      tensions.with_surface.push_back(key);
    return tensions;
  }


  template <int dim>
  void
  review_tensions(const Scene               &scene,
                  const Founders<dim>       &founders,
                  const SurfacePatches<dim> &surface,
                  const MPI_Comm             comm,
                  Review                    &review)
  {
    const auto &keys = scene.keys<TypeTensionParameters>();
    // Exchanges of places make domains of a mixture.
    if (!keys.is_on() || scene.keys<RearrangementParameters>().is_on())
      return;
    const auto gamma   = keys.matrix();
    const auto largest = largest_fractions(scene, founders, surface, comm);
    for (unsigned int a = 0; a < gamma.size(); ++a)
      for (unsigned int b = 0; b < gamma.size(); ++b)
        // A type without founders may come later.
        if (gamma[a][b] > 0. && largest[a] > 0. && largest[a] < of_a_domain)
          {
            std::ostringstream why, value;
            value << gamma[a][b] << " kPa um";
            why << "cells of type " << keys.types[a] << " are at most "
                << static_cast<int>(100. * largest[a])
                << " % of the cells around a place at t = 0: their domains are "
                   "narrower than 2 grid spacings, and the tension hardly acts "
                   "on these (doc/theory.md, section 12.2).";
            review.warn("Cell types/" + keys.types[a] + "/Tension/With " +
                          keys.types[b],
                        value.str(),
                        why.str(),
                        "Take a smaller " + scene.grid.spacing.path() +
                          ", at least 2.5 cells, or let cells change places "
                          "(Rearrangement/Diffusion).");
            break;
          }
  }


  MORULA_INSTANTIATE(review_tensions);
} // namespace Morula
