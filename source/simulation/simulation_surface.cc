// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/piece_watch.h>
#include <morula/particles/surface_coarsening.h>
#include <morula/particles/surface_refinement.h>
#include <morula/seeding/surface_renewal.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

// How the surface follows the tissue, and what the user is told of pieces.

namespace Morula
{
  namespace
  {
    /** Part of the boundary points that a step may lose before the surface is
     *  made anew at once. */
    constexpr double largest_loss = 0.01;

    /** And |F|/√dim that a point may have come to since then: more is no motion
     *  of the tissue, but of a point that it has left behind. */
    constexpr double largest_stretch = 1.5;

    /** Whether a boundary point has a larger |F|. Collective. */
    template <int dim>
    bool
    is_stretched(const Tissue<dim> &tissue)
    {
      double largest = 0.;
      for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
        largest = std::max(largest, tissue.boundary_points().F(p).norm());
      return Utilities::MPI::max(largest, tissue.communicator()) >
             largest_stretch * std::sqrt(dim);
    }
  } // namespace

  template <int dim>
  void
  Simulation<dim>::tell_of_joined_pieces(const SplineSpace<dim> &space)
  {
    const std::optional<Point<dim>> place = piece_watch.joined(space);
    if (!place || pieces_have_joined)
      return;
    pieces_have_joined = true;
    std::ostringstream text;
    text << "Warning: at t = " << time_steps.time()
         << " day two parts of the tissue have come within a grid spacing of "
         << "each other near (" << *place << ") um. From now on they stick "
         << "together there, though their cells may not touch yet "
         << "(doc/faq.md, bodies that stick). A smaller Grid/Spacing lets them "
         << "come closer. Later ones are not told of.";
    files->message(text.str());
  }

  template <int dim>
  void
  Simulation<dim>::count_pieces(const SplineSpace<dim> &space)
  {
    if (development.death() == nullptr)
      return;
    const unsigned int n = pieces_with_cells(space);
    if (n_pieces > 0 && n > n_pieces && !pieces_have_parted)
      {
        pieces_have_parted = true;
        std::ostringstream text;
        text << "Warning: at t = " << time_steps.time()
             << " day the tissue has parted: it has " << n
             << " pieces now, and had " << n_pieces
             << ". Each of them moves on its own. The column pieces of "
                "statistics.csv has their number; later ones are not told of.";
        files->message(text.str());
      }
    n_pieces = n;
  }

  template <int dim>
  void
  Simulation<dim>::refine_surface(
    const std::function<bool(const Point<dim> &)> &crowded)
  {
    if (!scene.tissue.refine_surface)
      return;
    const TimerOutput::Scope section(timer, "surface refinement");
    PointList<dim>           points       = tissue.boundary_points().copy();
    const auto              &columns      = tissue.boundary_points().columns();
    const double             longest_edge = 0.5 * scene.grid.spacing;
    const bool               has_merged   = scene.tissue.coarsen_surface &&
                            coarsen_surface<dim>(
                              points,
                              columns,
                              longest_edge,
                              [this](const auto &a, const auto &b) {
                                return boundary_conditions.alike(a, b);
                              },
                              comm);
    const bool has_split = Morula::refine_surface(
      points, columns, longest_edge, crowded, next_boundary_id, comm);
    if (has_merged || has_split)
      tissue.replace_surface(points);
  }

  template <int dim>
  void
  Simulation<dim>::refine_stretched_surface(const SplineSpace<dim> &space,
                                            const PointList<dim>   &former)
  {
    try
      {
        refine_surface([&space](const Point<dim> &x) {
          return space.occupancy().crowded(x);
        });
      }
    catch (const SurfaceTorn &error)
      {
        if (renews_surface() && make_surface_anew(former))
          return;
        // This step is done; the next one could not be.
        complete_row(space);
        write_rows();
        ++n_steps;
        give_up(error.what() + std::string("."));
      }
  }

  template <int dim>
  bool
  Simulation<dim>::renews_surface() const
  {
    return scene.tissue.renew_surface > 0.;
  }

  template <int dim>
  void
  Simulation<dim>::renew_surface(const PointList<dim> &former, const double dt)
  {
    const double every = scene.tissue.renew_surface;
    const double slack = scene.time.slack();
    const double t     = time_steps.time();
    const bool   is_due =
      std::floor((t + slack) / every) > std::floor((t - dt + slack) / every);
    const auto n = Utilities::MPI::sum<std::uint64_t>(former.size(), comm);
    const auto n_left =
      Utilities::MPI::sum<std::uint64_t>(tissue.boundary_points().size(), comm);
    if (is_due || n - n_left > largest_loss * n || is_stretched(tissue))
      make_surface_anew(former);
  }

  template <int dim>
  bool
  Simulation<dim>::make_surface_anew(const PointList<dim> &former)
  {
    const TimerOutput::Scope   section(timer, "surface renewal");
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    const auto                 list   = renewed_surface(tissue.cells(),
                                      former,
                                      points.copy(),
                                      points.columns(),
                                      0.5 * scene.grid.spacing,
                                      next_boundary_id,
                                      comm);
    if (list)
      tissue.replace_surface(*list);
    return list.has_value();
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
