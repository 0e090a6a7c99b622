// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/displacement_field.h>
#include <morula/particles/boundary_state.h>
#include <morula/simulation.h>
#include <morula/step_checks.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The largest displacement (µm) and step deformation |f| of points. */
    struct Motion
    {
      double u = std::numeric_limits<double>::infinity();
      double f = std::numeric_limits<double>::infinity();
    };

    /**
     * Moves the points of a store with the field, calling update(i, f) for
     * each before; none farther than the limit, and without update above it.
     * @param points copies of the store's points, moved
     * @return the largest motion over all ranks. Collective.
     */
    template <int dim, typename Update>
    Motion
    move_points(const PointStore<dim>        &store,
                const SplineSpace<dim>       &space,
                const DisplacementField<dim> &displacement,
                const Motion                 &limit,
                const MPI_Comm                comm,
                PointList<dim>               &points,
                const Update                 &update)
    {
      Motion       largest{0., 0.};
      unsigned int c = 0;
      for (const auto &cell : store.cells())
        {
          while (space.cells()[c].number != cell.number)
            ++c;
          const LocalField<dim> field = displacement.on_cell(c);
          const GridIndex<dim>  index = space.box().index(cell.number);
          for (unsigned int p = cell.begin; p < cell.end; ++p)
            {
              const SplineValues<dim> splines(
                space.box().unit_position(points.positions[p], index),
                space.box().spacing());
              const Tensor<2, dim> f = field.step_deformation(splines);
              if (f.norm() <= limit.f)
                update(p, f);
              const Tensor<1, dim> u    = field.value(splines);
              const double         size = u.norm();
              points.positions[p] += size > limit.u ? limit.u / size * u : u;
              largest.u = std::max(largest.u, size);
              largest.f = std::max(largest.f, f.norm());
            }
        }
      return {Utilities::MPI::max(largest.u, comm),
              Utilities::MPI::max(largest.f, comm)};
    }
  } // namespace

  template <int dim>
  void
  Simulation<dim>::commit(const SplineSpace<dim>    &space,
                          const Equilibrium::Vector &u)
  {
    const TimerOutput::Scope     section(timer, "commit");
    const DisplacementField<dim> displacement(space, u, comm);
    PointList<dim>               cells   = tissue.cells().copy();
    PointList<dim>               surface = tissue.boundary_points().copy();
    const std::vector<double>    volumes = elastic_volumes(space, displacement);

    const auto update_cell = [&](const unsigned int    p,
                                 const Tensor<2, dim> &f) {
      const CellView<dim, double> cell(
        ArrayView<double>(&cells.properties[p * cells.n_slots], cells.n_slots),
        tissue.slots());
      if (growth.present())
        growth.commit(cell,
                      time_steps.time(),
                      time_steps.next(),
                      growth_of_step.current[p]);
      Tensor<2, dim> F = f * cell.deformation();
      if (!volumes.empty())
        F *= std::pow(volumes[p] * determinant(cell.growth()) / determinant(F),
                      1. / dim);
      cell.set_tensor(tissue.slots().deformation, F);
    };
    const auto update_surface = [&](const unsigned int    p,
                                    const Tensor<2, dim> &f) {
      deform_boundary_point<dim>(
        ArrayView<double>(&surface.properties[p * surface.n_slots],
                          surface.n_slots),
        f);
    };
    const Motion largest = move_points(
      tissue.cells(), space, displacement, Motion(), comm, cells, update_cell);
    // Where the surface stands off from the cells the field is extrapolated: no
    // reason to move farther, or to deform more, than the cells do. See also
    // take_back_strays().
    move_points(tissue.boundary_points(),
                space,
                displacement,
                Motion{2. * largest.u + space.box().spacing(), 2. * largest.f},
                comm,
                surface,
                update_surface);

    const std::string reason =
      why_torn(cells.positions, surface.positions, tissue.grid().box(), comm);
    if (!reason.empty())
      give_up(reason + ".");
    tissue.place(cells, surface);
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
