// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/state/present_cell.h>
#include <morula/mechanics/relaxation.h>

#include <deal.II/base/symmetric_tensor.h>

#include <cmath>

namespace Morula
{
  namespace
  {
    /** U to the power @p n, where U is the stretch whose square is fᵀf, given
     * as
     *  @p squared. */
    template <int dim>
    SymmetricTensor<2, dim>
    stretch(const SymmetricTensor<2, dim> &squared, const double n)
    {
      // Most steps move little. Then the binomial series of (I + x)^(n/2) is
      // faster than eigenvectors. With a norm of at most 0.05 and n of at most
      // 2, what is left out after eight terms is below 1e-12.
      constexpr double     small   = 0.05;
      constexpr int        n_terms = 8;
      const Tensor<2, dim> I(unit_symmetric_tensor<dim>());
      const Tensor<2, dim> x = Tensor<2, dim>(squared) - I;
      if (x.norm() <= small && n <= 2.)
        {
          Tensor<2, dim> sum = I;
          for (int k = n_terms; k > 0; --k)
            sum = I + (0.5 * n - k + 1.) / k * (x * sum);
          return symmetrize(sum);
        }
      SymmetricTensor<2, dim> result;
      for (const auto &[value, axis] : eigenvectors(squared))
        result +=
          std::pow(value, 0.5 * n) * symmetrize(outer_product(axis, axis));
      return result;
    }
  } // namespace


  RelaxationParameters::RelaxationParameters()
  {
    yield_stress.needs({time.path()});
    passes.needs({yield_stress.path()});
  }


  namespace
  {
    /**
     * Tissue that flows under its shear stress, `Material/Relaxation time`:
     * doc/theory.md, section 8. A step's flow sees where the tissue goes if it
     * moves as in the step before; so each cell keeps the stretch of that one.
     */
    template <int dim>
    class Relaxation : public Flow<dim>
    {
    public:
      using Parameters = RelaxationParameters;

      Relaxation(const Parameters         &parameters,
                 const EffectSetting<dim> &setting)
        : time(setting.state.use(parameters.time))
        , yield_stress(setting.state.use(parameters.yield_stress))
        , keys(parameters)
      {
        // The motion of the last step is kept for the forecast (8.3b) of
        // doc/theory.md.
        setting.columns.need_growth();
        motion = setting.columns.template add<SymmetricTensor<2, dim>>(
          {"motion_of_step",
           "",
           "f^T f of the last step: its stretch, squared",
           unit_symmetric_tensor<dim>()});
      }

      /** D for the shear that doc/theory.md (8.3a) gives.
       *  @throws InputError for a relaxation time or yield stress < 0 */
      FlowOfStep<dim>
      flow(const PresentCell<dim> &cell,
           const CellView<dim, double> &,
           const Tensor<2, dim> &before,
           const Tensor<2, dim> &F_g,
           const double          t0,
           const double          t1) const override
      {
        // The flow acts before the equilibrium is sought. So it takes the
        // elastic part of the step's beginning, and that of its end if the
        // tissue went on as in the last step, doc/theory.md (8.3b), with the
        // growth of all other effects. Their weighted mean (8.3a) relaxes, and
        // D of (8.4) comes back. F in `cell` is that of t0.
        const double t = 0.5 * (t0 + t1);
        FlowLaw      flow{cell.value(time, t)};
        if (flow.relaxation_time == 0.)
          return {};
        const CellView<dim, const double> &view     = cell.cell();
        const TissueMaterial              &material = cell.reader().material;
        const Tensor<2, dim>               F        = view.F();
        const Tensor<2, dim>               F_then =
          Tensor<2, dim>(forecast(view, cell.reader().past, t1 - t0)) * F;
        const Tensor<2, dim> end = F_then * invert(F_g);
        flow.passes              = keys.passes;
        // The law works with Kirchhoff's stress τ = V σ / W, where W is the
        // grown or the initial volume, so the yield stress is scaled as σ is.
        flow.yield_stress = cell.value(yield_stress, t) *
                            (material.per_grown_volume() ? determinant(end) :
                                                           determinant(F_then));

        // The weights of doc/theory.md (8.3a) make held shear and steady creep
        // exact. With a yield stress the end counts alone, so that long steps
        // end at the yield stress.
        const double gamma = (t1 - t0) / flow.relaxation_time;
        const double w     = flow.yield_stress > 0. ? 1. : weight_of_end(gamma);
        const Tensor<2, dim> F_e = end + (1. - w) * (F * invert(before) - end);
        const Tensor<2, dim> D(flow_of_step<dim>(
          F_e, cell.lame(), material.material(), flow, t1 - t0));
        // Below the yield stress D is the identity exactly; then F_g need not
        // be changed.
        const bool flows = D != Tensor<2, dim>(unit_symmetric_tensor<dim>());
        return {flows ? std::optional<Tensor<2, dim>>(D) : std::nullopt,
                w * -std::expm1(-gamma),
                false,
                gamma,
                flows || flow.yield_stress == 0. ? std::exp(-gamma) : 1.};
      }

      void
      remember_motion(const CellView<dim, double> &cell,
                      const Tensor<2, dim>        &f) const override
      {
        // Only the stretch of the step's motion f counts, as a rotation relaxes
        // nothing.
        cell.set(motion, symmetrize(transpose(f) * f));
      }

      bool
      has_forecast() const override
      {
        return true;
      }

      double
      error_of_forecast(const CellView<dim, const double> &cell,
                        const Tensor<2, dim>              &f,
                        const PastStep                    &past,
                        const double                       dt) const override
      {
        // Only the deviator matters, because volume does not relax. This is
        // called after the equilibrium is found, with the motion that took
        // place.
        const auto U = stretch(symmetrize(transpose(f) * f), 1.);
        return deviator(U - forecast(cell, past, dt)).norm();
      }

    private:
      /** U* of doc/theory.md (8.3b): the stretch of a step of length @p dt
       * (day) if the tissue goes on as in the step @p past. */
      SymmetricTensor<2, dim>
      forecast(const CellView<dim, const double> &cell,
               const PastStep                    &past,
               const double                       dt) const
      {
        // This is doc/theory.md (8.3b). The power makes up for steps of other
        // lengths. In the first step nothing is known, and the tissue is taken
        // as at rest.
        return past.exists() ? stretch(cell.get(motion), dt / past.length()) :
                               unit_symmetric_tensor<dim>();
      }

      Expression                      time, yield_stress;
      Parameters                      keys;
      Column<SymmetricTensor<2, dim>> motion; // fᵀf
    };

    /** All that is elastic in F flows at once. */
    template <int dim>
    class Forgetting : public Flow<dim>
    {
    public:
      FlowOfStep<dim>
      flow(const PresentCell<dim>      &cell,
           const CellView<dim, double> &after,
           const Tensor<2, dim> &,
           const Tensor<2, dim> &,
           const double,
           const double) const override
      {
        if (after.get(cell.reader().columns.type) == cell.type())
          return {};
        // All of F_e becomes growth.
        return {cell.elastic(), 0., true};
      }
    };


    /** What stiffens keeps its Cauchy stress, as what is laid down bears
     *  nothing yet. */
    template <int dim>
    class Stiffening : public Flow<dim>
    {
    public:
      /** Declares a column. */
      explicit Stiffening(CellColumns<dim> &columns)
        : moduli(columns.template add<Tensor<1, 2>>(
            {"moduli", "kPa", "lambda and mu of the last step"}))
      {}

      /** D of doc/theory.md (6.8b).
       *  @throws InputError for a stress that no strain has any more */
      FlowOfStep<dim>
      flow(const PresentCell<dim>      &cell,
           const CellView<dim, double> &after,
           const Tensor<2, dim> &,
           const Tensor<2, dim> &,
           const double,
           const double t1) const override
      {
        // The stress is that which the last step has balanced, with the moduli
        // of then: where they depend on the place, or on a field, those of the
        // state are others already. What softens loses what bears the stress,
        // and keeps its strain.
        CellReader<dim> reader = cell.reader();
        reader.time            = t1;
        const Lame now =
          PresentCell<dim>(after, cell.id(), cell.position(), reader).lame();
        const Tensor<1, 2> kept = cell.cell().get(moduli);
        const Lame then = kept[1] > 0. ? Lame{kept[0], kept[1]} : cell.lame();
        after.set(moduli, Tensor<1, 2>({now.lambda, now.mu}));
        if (!(youngs_modulus(now) > youngs_modulus(then)))
          return {};
        const TissueMaterial &tissue = reader.material;
        return {Tensor<2, dim>(
                  given_up_by_stiffening<dim>(cell.elastic(),
                                              then,
                                              now,
                                              tissue.material(),
                                              tissue.per_grown_volume())),
                0.,
                true};
      }

    private:
      Column<Tensor<1, 2>> moduli;
    };
  } // namespace


  void
  add_relaxation(Catalogue &catalogue)
  {
    catalogue.add_own<Relaxation>(
      "relaxation",
      {"Growth/Law=isotropic",
       "Growth/Isotropic/Stretch=1 + 0.1*t*(1 + 0.1*X*Y)",
       "Material/Relaxation time=0.2"});
  }


  template <int dim>
  std::unique_ptr<const Flow<dim>>
  flow_of_transitions(const MaterialParameters &keys,
                      const EffectSetting<dim> &setting,
                      const bool                has_types)
  {
    // Stiffness by X alone, or the same everywhere, stays what it is.
    const bool changes = TissueMaterial(keys).depends_on_state();
    if (keys.on_transition == "forget stress" && has_types)
      return std::make_unique<Forgetting<dim>>();
    if (keys.on_transition == "keep stress" && changes)
      return std::make_unique<Stiffening<dim>>(setting.columns);
    return {};
  }


  MORULA_INSTANTIATE(flow_of_transitions);
} // namespace Morula
