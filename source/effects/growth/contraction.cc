// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/growth/contraction.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <cmath>

namespace Morula
{
  template <int dim>
  Tensor<2, dim>
  active_strain(const Tensor<1, dim> &a,
                const double          gamma,
                const bool            keep_volume)
  {
    // This is doc/theory.md (9.1). The exponent makes the determinant 1: there
    // are dim - 1 directions across, which share what the length along `a`
    // gives up.
    const double across = keep_volume ? std::pow(gamma, -1. / (dim - 1)) : 1.;
    return across * Tensor<2, dim>(unit_symmetric_tensor<dim>()) +
           (gamma - across) * outer_product(a, a);
  }


  namespace
  {
    /** Cells that contract, as a part of F_g: doc/theory.md, section 9. */
    template <int dim>
    class Contraction : public GrowthFactor<dim>
    {
    public:
      using Parameters = ContractionParameters;

      Contraction(const Parameters         &parameters,
                  const EffectSetting<dim> &setting)
        : stretch(setting.state.use(parameters.stretch))
        , direction(parameters.direction, setting)
        , keep_volume(parameters.keep_volume)
      {
        // The column is written for the outputs only; the factor is computed
        // anew in each step and never from its value before.
        setting.columns.need_growth();
        column = setting.columns.template add<double>(
          {"contraction",
           "",
           "length along Contraction/Direction that the cell would have free of "
           "stress, as a ratio to that without contraction",
           1.,
           AtDivision::copied,
           true});
      }

      /**
       * F_a at @p t1 (day), with the state at the beginning of the step. Writes
       * γ into the column `contraction` of @p after.
       * @throws InputError if γ is not positive
       */
      Tensor<2, dim>
      factor(const PresentCell<dim>      &before,
             const CellView<dim, double> &after,
             const double,
             const double t1) const override
      {
        // The active strain is that of the end of the step, doc/theory.md
        // (9.1), with the state of its beginning. It is not multiplied by that
        // of the step before, so it goes back to the identity as the stretch
        // returns to 1.
        const double gamma = before.value(stretch, t1);
        after.set(column, gamma);
        return active_strain(direction.of(before, t1), gamma, keep_volume);
      }

      void
      check_cell(const PresentCell<dim> &founder,
                 const double            step) const override
      {
        direction.of(founder, step);
      }

      /** Warns of steps in which γ changes by more than the steps that were
       *  measured. */
      void
      review(const Preview<dim> &scene, Review &review) const override
      {
        // The loop goes through all steps of the run for some founders of this
        // rank and looks for the largest change of the stretch in a step. The
        // number of evaluations has a limit, so that the review takes a
        // fraction of a second in large scenes. The maximum over all ranks is
        // collective, so every rank reaches it, whether it looped or not.

        // A stretch that depends on the state is known only in the run.
        constexpr double most_evaluations = 2e5;
        const double     n_steps          = std::ceil(
          scene.keys.time.end_time / scene.keys.time.step * (1. - time_slack));
        double largest = 0.;
        if (!stretch.depends_on_state() && n_steps <= most_evaluations)
          {
            const std::size_t every = std::max<std::size_t>(
              1, std::ceil(n_steps * scene.founders.size() / most_evaluations));
            for (std::size_t i = 0; i < scene.founders.size(); i += every)
              {
                double before = 1.;
                for (double n = 1.; n <= n_steps; ++n)
                  {
                    const double now =
                      stretch.value(scene.founders[i],
                                    std::min(n * scene.keys.time.step,
                                             scene.keys.time.end_time.value()));
                    largest = std::max(largest, std::abs(now - before));
                    before  = now;
                  }
              }
          }
        largest = Utilities::MPI::max(largest, scene.comm);
        // A change by 0.1 deforms like growth by the factor 1.1, the step that
        // is enough beside a clamp. The slack admits rounding in the
        // differences.
        if (largest > 0.1 + 1e-9)
          review.warn(
            TimeParameters::step_path,
            as_text(scene.keys.time.step) + " day",
            "in one step " + stretch.key() + " changes by up to " +
              as_text(largest) +
              "; such steps are as large as growth by a factor of 1.1 "
              "(doc/accuracy-and-cost.md, advice).",
            "Shorten the step, or ramp the stretch over several steps.");
      }

    private:
      Expression           stretch;
      DirectionOfCell<dim> direction;
      bool                 keep_volume;
      /** γ. */
      Column<double> column;
    };
  } // namespace


  void
  add_contraction(Catalogue &catalogue)
  {
    catalogue.add_own<Contraction>("contraction",
                                   {"Contraction/Stretch=1 - 0.2*t",
                                    "Contraction/Direction=1; 1; 0"});
  }


  MORULA_INSTANTIATE(active_strain);
} // namespace Morula
