// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/rounded_sums.h>
#include <morula/particles/places.h>
#include <morula/simulation/redistribution.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** k: how fast volumes go to their space, by the strain of the step. */
    constexpr double rate_of_volumes = 5.;

    /** Brings the volumes that cells carry in line with their space,
     *  doc/theory.md (6.11c), and returns the root of the mean square of ln φ
     *  before. Collective. */
    template <int dim>
    double
    fit_volumes(Tissue<dim> &tissue)
    {
      const SpaceOfCells space   = space_of_cells(tissue);
      const auto        &columns = tissue.cells().columns();
      RoundedSums        sums(2, tissue.communicator());
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        {
          const CellView<dim, double> cell   = tissue.cell(p);
          const double                misfit = std::log(space.fill[p]);
          const double                part =
            -space.inside[p] *
            std::expm1(-rate_of_volumes * cell.get(columns.step_strain));
          sums.add(0, 1.);
          sums.add(1, misfit * misfit);
          if (part > 0.)
            cell.set(columns.carried,
                     cell.get(columns.carried) * std::exp(-part * misfit));
        }
      const std::vector<double> all = sums.all();
      return all[0] > 0. ? std::sqrt(all[1] / all[0]) : 0.;
    }


    /** Puts cells that stand in an obstacle on its surface. Only the surface of
     *  the tissue feels obstacles: where it is rounder than a corner, cells
     *  beyond it would be squeezed out, and live on there. Collective. */
    template <int dim>
    void
    keep_out(Tissue<dim>                   &tissue,
             const BoundaryConditions<dim> &conditions,
             const double                   t)
    {
      std::vector<Point<dim>> positions;
      bool                    moves = false;
      for (const auto &named : conditions.list())
        for (const auto &place : named.condition->forbidden(t))
          {
            if (positions.empty())
              positions = tissue.cells().positions();
            for (Point<dim> &x : positions)
              if (const Tensor<1, dim> way = place.second(x); way.norm() > 0.)
                {
                  x += way;
                  moves = true;
                }
          }
      if (Utilities::MPI::logical_or(moves, tissue.communicator()))
        tissue.move(positions, tissue.boundary_points().positions());
    }
  } // namespace


  template <int dim>
  void
  redistribute(Tissue<dim>            &tissue,
               const TissueModel<dim> &model,
               const double            t,
               const bool              has_surface,
               NamedNumbers           &numbers)
  {
    if (model.redistribution.places)
      {
        numbers["close_neighbours"] = keep_apart(tissue);
        keep_out(tissue, model.boundary_conditions, t);
      }
    if (model.redistribution.volumes && has_surface)
      numbers["density_error"] = fit_volumes(tissue);
  }

  MORULA_INSTANTIATE(redistribute);
} // namespace Morula
