// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/rounded_sums.h>
#include <morula/particles/places.h>
#include <morula/particles/space_of_cells.h>
#include <morula/simulation/redistribution.h>

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** k: how fast volumes go to their space, by the strain of the step. */
    constexpr double rate_of_volumes = 5.;

    /** Makes the volume of a cell larger by a factor. Its amounts stay. */
    template <int dim>
    void
    scale_volume(const CellView<dim, double> &cell,
                 const double                 factor,
                 const TissueModel<dim>      &model)
    {
      cell.set(cell.columns().deformation,
               std::pow(factor, 1. / dim) * cell.F());
      model.dilute(cell, factor);
    }


    /** Brings volumes in line with their space, doc/theory.md (6.11c), and
     *  returns the root of the mean square of ln φ before. Collective. */
    template <int dim>
    double
    fit_volumes(Tissue<dim> &tissue, const TissueModel<dim> &model)
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
            scale_volume(cell, std::exp(-part * misfit), model);
        }
      const std::vector<double> all = sums.all();
      return all[0] > 0. ? std::sqrt(all[1] / all[0]) : 0.;
    }
  } // namespace


  template <int dim>
  double
  displacing_strain(const CellView<dim, const double> &cell,
                    const unsigned int                 p,
                    const Tensor<2, dim>              &f,
                    const DevelopmentOfStep<dim>      &of_step,
                    const bool                         flows)
  {
    // A flow has a share in each cell in which it acts.
    double strain  = 0.;
    bool   relaxes = false;
    if (of_step.present)
      {
        strain = std::abs(std::log(determinant(cell.growth()) /
                                   determinant(of_step.previous[p])));
        const std::size_t n =
          of_step.flow_shares.size() / of_step.previous.size();
        for (std::size_t k = 0; k < n; ++k)
          relaxes = relaxes || of_step.flow_shares[p * n + k] > 0.;
      }
    if (flows || relaxes)
      strain += deviator(symmetrize(f)).norm();
    return strain;
  }


  template <int dim>
  void
  redistribute(Tissue<dim>            &tissue,
               const TissueModel<dim> &model,
               const bool              has_surface,
               NamedNumbers           &numbers)
  {
    if (model.redistribution.places)
      numbers["close_neighbours"] = keep_apart(tissue);
    if (model.redistribution.volumes && has_surface)
      numbers["density_error"] = fit_volumes(tissue, model);
  }

  MORULA_INSTANTIATE(displacing_strain);
  MORULA_INSTANTIATE(redistribute);
} // namespace Morula
