// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_explain_folds_h
#define morula_program_explain_folds_h

#include <morula/scene/free_growth.h>
#include <morula/scene/scene.h>

#include <optional>
#include <ostream>

namespace Morula
{
  /**
   * Prints what may buckle or fold in the scene, what friction means there, and
   * which volumetric strain goes with growth that differs from cell to cell.
   * Prints nothing where none of it applies.
   * @param growth of the founders, if there is a law
   */
  void
  print_folds(std::ostream                    &out,
              const Scene                     &scene,
              const std::optional<FreeGrowth> &growth);

  /** The viscosity (Pa s) of a medium in which a sphere with the volume of a
   *  cube of edge @p length (µm) feels the @p friction (kPa day/µm², per
   *  volume), by Stokes' law: η = 2 ζ R²/9. */
  double
  viscosity_of_medium(const double friction, const double length);
} // namespace Morula

#endif
