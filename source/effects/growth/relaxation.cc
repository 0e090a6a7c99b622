// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/time_parameters.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/state/present_cell.h>
#include <morula/mechanics/relaxation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  template <int dim>
  Relaxation<dim>::Relaxation(const MaterialParameters &parameters,
                              StateColumns<dim>        &state)
    : time(state.use(parameters.relaxation_time))
    , yield_stress(state.use(parameters.yield_stress))
    , passes(parameters.relaxation_passes)
    , material(parameters)
  {}


  template <int dim>
  Tensor<2, dim>
  Relaxation<dim>::flow(const PresentCell<dim> &cell,
                        const Tensor<2, dim>   &F_g,
                        const double            t0,
                        const double            t1) const
  {
    const double t = 0.5 * (t0 + t1);
    Flow         flow{cell.value(time, t)};
    if (flow.relaxation_time == 0.)
      return Tensor<2, dim>(unit_symmetric_tensor<dim>());
    const Tensor<2, dim> F_e = cell.cell().F() * invert(F_g);
    flow.passes              = passes;
    // Of τ = V σ / W.
    flow.yield_stress =
      cell.value(yield_stress, t) * (material.per_grown_volume() ?
                                       determinant(F_e) :
                                       determinant(cell.cell().F()));
    return Tensor<2, dim>(
      flow_of_step<dim>(F_e, cell.lame(), material.material(), flow, t1 - t0));
  }


  template <int dim>
  void
  Relaxation<dim>::check_cell(const PresentCell<dim> &founder,
                              const double            step) const
  {
    founder.value(time, 0.5 * step);
    founder.value(yield_stress, 0.5 * step);
  }


  template <int dim>
  void
  Relaxation<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    // What depends on the state, only the run can tell.
    constexpr double none     = std::numeric_limits<double>::max();
    double           shortest = none;
    const auto       consider = [&](const double tau) {
      if (tau > 0.)
        shortest = std::min(shortest, tau);
    };
    if (!time.depends_on_state())
      for (const Point<dim> &X : scene.founders)
        consider(time.value(X, 0.5 * scene.step));
    for (const auto &[type, own] : time.types())
      consider(own.number().value_or(0.));
    shortest = Utilities::MPI::min(shortest, scene.comm);
    if (shortest < none && scene.step > 0.2 * shortest * (1. + 1e-9))
      review.warn(
        TimeParameters::step_path,
        as_text(scene.step) + " day",
        "under a load tissue creeps too slowly by the factor 1 + Step / " +
          time.key() + ", which is " + as_text(1. + scene.step / shortest) +
          " at a relaxation time of " + as_text(shortest) +
          " day (doc/theory.md, 8.2).",
        "Shorten the step to a fifth of the relaxation time, or less.");
  }


  template class Relaxation<2>;
  template class Relaxation<3>;
} // namespace Morula
