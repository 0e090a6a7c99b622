// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/growth_law.h>
#include <morula/effects/scene_keys.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <cmath>

namespace Morula
{
  namespace
  {
    /** The largest stretch of a tensor near a multiple of the identity. The
     * norm of F Fᵀ bounds its largest eigenvalue from above and is that without
     *  shear. */
    template <int dim>
    double
    largest_stretch(const Tensor<2, dim> &F)
    {
      return std::sqrt(l1_norm(F * transpose(F)));
    }

    /**
     * Largest growth of any cell in one step, as a ratio of lengths, where
     * cells are free of stress. Where there are many cells and steps, only some
     * cells are asked.
     */
    template <int dim>
    double
    largest_growth(const GrowthLaw<dim> &law, const Preview<dim> &scene)
    {
      // Some founders of this rank are taken through all steps of the run, free
      // of stress, so that F_e is the identity. Each step is compared with the
      // one before in both directions, as withering deforms the tissue like
      // growth. A law that depends on the past needs all steps in turn, so
      // cells are left out instead of steps.
      constexpr double most_evaluations = 2e5;
      const double     n_steps          = std::ceil(
        scene.keys.time.end_time / scene.keys.time.step * (1. - time_slack));
      // Not even one cell could be taken through all steps: then nothing is
      // said.
      if (n_steps > most_evaluations)
        return 1.;
      const std::size_t every = std::max<std::size_t>(
        1, std::ceil(n_steps * scene.founders.size() / most_evaluations));
      const Tensor<2, dim> identity(unit_symmetric_tensor<dim>());
      double               largest = 1.;
      for (std::size_t i = 0; i < scene.founders.size(); i += every)
        {
          const Point<dim> &X = scene.founders[i];
          // Cells begin at their initial size, whatever the law says of t = 0.
          Tensor<2, dim> before = identity;
          double         t      = 0.;
          for (double n = 1.; n <= n_steps; ++n)
            {
              const double         next = std::min(n * scene.keys.time.step,
                                           scene.keys.time.end_time.value());
              const Tensor<2, dim> now =
                law.growth({X, before, identity}, t, next);
              largest = std::max({largest,
                                  largest_stretch(now * invert(before)),
                                  largest_stretch(before * invert(now))});
              before  = now;
              t       = next;
            }
        }
      return largest;
    }
  } // namespace


  template <int dim>
  void
  GrowthLaw<dim>::check(const Preview<dim> &scene) const
  {
    // The law is evaluated for all founders of this rank, in the first step and
    // at the end, for the errors that it throws. The values are not used.
    const Tensor<2, dim> identity(unit_symmetric_tensor<dim>());
    const double         first_step =
      std::min(scene.keys.time.step.value(), scene.keys.time.end_time.value());
    for (const Point<dim> &X : scene.founders)
      {
        growth({X, identity, identity}, 0., first_step);
        growth({X, identity, identity},
               scene.keys.time.end_time - first_step,
               scene.keys.time.end_time);
      }
  }


  template <int dim>
  void
  GrowthLaw<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    // The search may throw on one rank only. So the exception is caught before
    // the collective maximum, which all ranks must reach.

    // A law may have no value at some time in mid-run; then the run says so
    // when it gets there.
    double ratio = 1.;
    try
      {
        ratio = largest_growth(*this, scene);
      }
    catch (const std::exception &)
      {}
    ratio = Utilities::MPI::max(ratio, scene.comm);
    // A clamp does not grow with the tissue, so steps have to be shorter beside
    // it. The two limits are the largest steps that were measured; 1e-9 is for
    // rounding.
    if (ratio > (scene.is_clamped ? 1.2 : 1.4) + 1e-9)
      review.warn(
        TimeParameters::step_path,
        as_text(scene.keys.time.step) + " day",
        "in one step cells grow (or wither) by a factor of up to " +
          as_text(ratio) +
          "; we have tested up to 1.2 beside a clamp (where 1.1 suffices) "
          "and 1.4 elsewhere "
          "(doc/accuracy-and-cost.md, advice).",
        "Shorten the step, unless you have compared with shorter "
        "ones.");
  }


  template class GrowthLaw<2>;
  template class GrowthLaw<3>;
} // namespace Morula
