// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_own_material_h
#define morula_mechanics_materials_own_material_h

#include <morula/mechanics/materials/material.h>

#include <Sacado_Fad_SimpleFad.hpp>

#include <memory>

// These kernels have a namespace of their own: compiled with a program's own
// flags, they must not take the place of the library's.
#define MORULA_KERNELS programs_kernels
#define MORULA_LANES 2
#include <morula/mechanics/kernels/kernels.h>
#undef MORULA_KERNELS
#undef MORULA_LANES

namespace Morula
{
  /**
   * A Material made from a law's one function template.
   * @tparam Law copyable, with the member response() of NeoHookean
   */
  template <typename Law>
  class MaterialOf : public Material
  {
  public:
    /** Takes the kernels that were compiled for this law. */
    MaterialOf(const Law                           &law,
               const std::vector<VectorKernels<2>> &kernels_2d,
               const std::vector<VectorKernels<3>> &kernels_3d)
      : Material(kernels_2d, kernels_3d)
      , law_(law)
    {}

    CoupledResponse<double>
    response(const Strain<double> &strain) const override
    {
      return as_coupled(law_.response(strain));
    }

    /** They come from automatic differentiation of the law. */
    ThirdDerivatives
    third_derivatives(const Strain<double> &strain,
                      const PartOfLaw       part) const override
    {
      // Derivatives are taken by tr b_e and by ln J_e. A Fad whose operators
      // return expressions would not do: a law's functions take numbers.
      using Fad = Sacado::Fad::SimpleFad<double>;
      const Fad  log_J(2, 1, strain.log_J);
      const auto r =
        as_coupled(law_.response(Strain<Fad>{Fad(2, 0, strain.trace),
                                             strain.trace_magnitude,
                                             exponential(log_J),
                                             log_J,
                                             log_J,
                                             strain.lambda,
                                             strain.mu}));
      const Fad A = part == PartOfLaw::all ? r.total_A() : r.A;
      return {by(1, A), by(1, r.B), by(1, r.C), 2. * by(0, r.C)};
    }

    bool
    coupled() const override
    {
      return is_coupled<Law>;
    }

    const void *
    law() const override
    {
      return &law_;
    }

  private:
    template <typename Number>
    static CoupledResponse<Number>
    as_coupled(const Response<Number> &r)
    {
      CoupledResponse<Number> result;
      static_cast<Response<Number> &>(result) = r;
      return result;
    }

    template <typename Number>
    static CoupledResponse<Number>
    as_coupled(const CoupledResponse<Number> &r)
    {
      return r;
    }

    /** A derivative; a number that is constant has none. */
    template <typename Fad>
    static double
    by(const int i, const Fad &x)
    {
      return x.hasFastAccess() ? x.fastAccessDx(i) : 0.;
    }

    const Law law_;
  };

  /**
   * The Material of a program's own law, for Materials::add(), with the plain
   * code and the kernels for any processor.
   * @tparam Law as MaterialOf<Law> requires
   */
  template <typename Law>
  std::shared_ptr<const Material>
  own_material(const Law &law = Law())
  {
    const std::vector<VectorKernels<2>> kernels_2d = {
      programs_kernels::kernels_of<2, Law>("baseline")};
    const std::vector<VectorKernels<3>> kernels_3d = {
      programs_kernels::kernels_of<3, Law>("baseline")};
    return std::make_shared<const MaterialOf<Law>>(law, kernels_2d, kernels_3d);
  }
} // namespace Morula

#endif
