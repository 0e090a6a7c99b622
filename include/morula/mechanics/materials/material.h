// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_material_h
#define morula_mechanics_materials_material_h

#include <morula/mechanics/materials/response.h>
#include <morula/mechanics/vector_kernels.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * Third derivatives of a law's energy by I = tr b_e and ϑ = ln J_e,
   * doc/theory.md (4.5c), kPa: what
   * the tangent of Nitsche's term needs besides the Response.
   */
  struct ThirdDerivatives
  {
    double D1; // ∂³Ψ/∂ϑ³
    double D2; // 2 ∂³Ψ/∂ϑ² ∂I
    double D3; // 4 ∂³Ψ/∂ϑ ∂I²
    double D4; // 8 ∂³Ψ/∂I³
  };

  /** Which part of a law counts. */
  enum class PartOfLaw
  {
    all,
    /** All but the volumetric part. */
    distortion
  };

  /** A material's law, for code that does not know which law it is. */
  class Material
  {
  public:
    virtual ~Material() = default;

    /** The law at a point. */
    virtual CoupledResponse<double>
    response(const Strain<double> &strain) const = 0;

    /** The third derivatives of a part of it. */
    virtual ThirdDerivatives
    third_derivatives(const Strain<double> &strain,
                      const PartOfLaw       part) const = 0;

    /** Whether α depends on the strain; if not, B, C and D2 to D4 are 0. */
    virtual bool
    coupled() const = 0;

    /** The law, for its kernels. */
    virtual const void *
    law() const = 0;

    /** k of the volumetric part, kPa, with Lamé's constants (kPa). */
    double
    bulk_modulus(const double lambda, const double mu) const
    {
      return response({0., 0., 1., 0., 0., lambda, mu}).volumetric.modulus;
    }

    /** U of the volumetric part, and its derivatives, at ϑ. */
    Volumetric<double>
    volumetric(const double theta) const
    {
      return response({0., 0., 1., 0., theta, 1., 1.}).volumetric;
    }

    /** The kernels that this processor can run, the fastest first. */
    template <int dim>
    const std::vector<VectorKernels<dim>> &
    vector_kernels() const
    {
      if constexpr (dim == 2)
        return kernels_2d;
      else
        return kernels_3d;
    }

  protected:
    Material(const std::vector<VectorKernels<2>> &kernels_2d,
             const std::vector<VectorKernels<3>> &kernels_3d)
      : kernels_2d(kernels_2d)
      , kernels_3d(kernels_3d)
    {}

  private:
    const std::vector<VectorKernels<2>> kernels_2d;
    const std::vector<VectorKernels<3>> kernels_3d;
  };

  /** The materials that a scene can choose from, by the name of their law.
   *  Copies share the materials, which nobody can change. */
  class Materials
  {
  public:
    /** The library's own. */
    Materials();

    /**
     * Adds one. The header own_material.h makes it from a law, with kernels:
     * materials.add("soft", own_material(Soft())).
     * @param name value of Material/Law
     * @throws std::invalid_argument for a name that is in use
     */
    void
    add(const std::string                     &name,
        const std::shared_ptr<const Material> &material);

    /** The material of this name, or null. */
    std::shared_ptr<const Material>
    find(const std::string &name) const;

    /** All names, in the order of the list. */
    std::vector<std::string>
    names() const;

  private:
    std::vector<std::pair<std::string, std::shared_ptr<const Material>>> list;
  };
} // namespace Morula

#endif
