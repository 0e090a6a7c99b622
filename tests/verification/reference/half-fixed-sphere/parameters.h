// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef half_fixed_sphere_parameters_h
#define half_fixed_sphere_parameters_h

#include <deal.II/base/parameter_handler.h>

#include <half-fixed-sphere/mesh.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace HalfFixedSphere
{
  using namespace dealii;

  /** Bad input: which key, which value, and what is wrong with it. */
  struct InputError : public std::runtime_error
  {
    InputError(const std::string &key,
               const std::string &value,
               const std::string &problem);
  };


  /** What is computed, on which mesh, and where the results go. */
  struct Parameters
  {
    double                    radius         = 250.; // um
    double                    youngs_modulus = 1.;   // kPa
    double                    poissons_ratio = 0.4;
    std::vector<double>       stretches      = {1.1, 1.2, 1.3, 1.4};
    bool                      held           = true;
    double                    edge           = 0.; // um
    MeshSize                  mesh           = {2, 6, 1};
    unsigned int              degree         = 2;
    unsigned int              edge_points    = 12;
    double                    tolerance      = 1e-10;
    std::string               output         = "half-fixed-sphere";
    bool                      write_vtu      = false;
    std::vector<unsigned int> modes; // around the axis

    /** The defaults with these overrides, "Key=value" each. */
    static Parameters
    read(const std::vector<std::string> &overrides);

    void
    declare(ParameterHandler &prm);

    /** Throws InputError for values that fit no problem. */
    void
    check() const;
  };
} // namespace HalfFixedSphere

#endif
