// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef half_fixed_sphere_results_h
#define half_fixed_sphere_results_h

#include <half-fixed-sphere/equilibrium.h>

#include <fstream>
#include <string>
#include <vector>

namespace HalfFixedSphere
{
  /** Numbers that describe the state of the whole body. */
  struct Summary
  {
    double apex;                     // height of the top point, um
    double max_radius;               // largest distance from the axis, um
    double initial_volume;           // um^3
    double volume;                   // um^3
    double mean_energy_density;      // kPa, weighted by initial volume
    double min_elastic_volume_ratio; // at the quadrature points
    double max_elastic_volume_ratio;
  };

  Summary
  summarize(const Equilibrium &body);


  /** A point of the upper surface. */
  struct OutlinePoint
  {
    double   angle;    // initial angle from the axis: 0 at the apex, rad
    Point<2> position; // now, (r, z), um
  };

  /** Points from the apex to the edge, @p n per side of a grid cell. */
  std::vector<OutlinePoint>
  outline(const Equilibrium &body, const unsigned int n);


  /** Appends every state to the two CSV files, and writes VTU if wanted. */
  class Writer
  {
  public:
    explicit Writer(const Parameters &parameters);

    void
    write(const Equilibrium &body);

  private:
    std::string   prefix;
    bool          write_vtu;
    std::ofstream summaries, outlines, stability;
  };
} // namespace HalfFixedSphere

#endif
