// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/elastic_volumes.h>
#include <morula/effects/step_points.h>
#include <morula/mechanics/internal_force.h>

#include <cmath>

namespace Morula
{
  namespace
  {
    /** ϑ of a part of a grid cell, by its number in the grid's box. */
    struct Value
    {
      unsigned int number, part;
      double       theta;
    };

    /** ϑ of the nodes of a body in this rank's window; 0
     *  where there is no point. Grid cells of other ranks are among them, since
     *  a cell may have part in those. Collective. */
    template <int dim>
    std::vector<double>
    log_volume_ratios(const InternalForce<dim>     &force,
                      const SplineSpace<dim>       &space,
                      const unsigned int            body,
                      const DisplacementField<dim> &displacement)
    {
      // Each rank evaluates the grid cells that it owns, and tells the ranks in
      // whose windows they lie. The grid cells are numbered in the grid's box
      // there, which is the same on all ranks, and in this rank's window in the
      // result.
      const GridNodes<dim> &nodes     = space.occupancy(body).nodes();
      const bool            of_bodies = space.n_bodies() > 1;
      std::vector<Value>    values;
      for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
        if (!of_bodies || space.grid_cells()[c].part == body)
          values.push_back(
            {space.grid_cells()[c].number,
             of_bodies ? 0 : space.grid_cells()[c].part,
             force.log_volume_ratio_after(c, displacement.on_grid_cell(c))});
      const auto of_others = space.occupancy(body).window().to_windows(values);
      values.insert(values.end(), of_others.begin(), of_others.end());
      std::vector<double> theta(nodes.size(), 0.);
      for (const Value &value : values)
        theta[nodes.node(space.box().index(value.number), value.part)] =
          value.theta;
      return theta;
    }

    /** Mean over the grid cells that share a point of the cell with this id.
     *  @param values by node */
    template <int dim>
    double
    mean_of_shares(const Point<dim>           &x,
                   const types::particle_index id,
                   const Occupancy<dim>       &occupancy,
                   const std::vector<double>  &values)
    {
      double mean = 0.;
      occupancy.for_each_share(
        x, [&](const Point<dim> &share, const unsigned int n) {
          mean += values[occupancy.nodes().node_of_cell(
                    occupancy.window().locate(share), id)] /
                  n;
        });
      return mean;
    }

    /** Mean over the quadrature points of the cell with this id. @param values
     *  by node */
    template <int dim>
    double
    mean_of_points(const ParticleDomain<dim>  &domain,
                   const types::particle_index id,
                   const Occupancy<dim>       &occupancy,
                   const std::vector<double>  &values)
    {
      double       sum = 0.;
      unsigned int n   = 0;
      domain.for_quadrature_points(occupancy.n_points_per_edge(domain, id),
                                   [&](const Point<dim> &x) {
                                     sum +=
                                       mean_of_shares(x, id, occupancy, values);
                                     ++n;
                                   });
      return sum / n;
    }
  } // namespace

  template <int dim>
  std::vector<double>
  elastic_volumes(const Tissue<dim>            &tissue,
                  const SplineSpace<dim>       &space,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material,
                  const std::string            &kernel,
                  const DisplacementField<dim> &displacement)
  {
    // The means ϑ of doc/theory.md (2.6), (2.8) belong to grid cells. They are
    // found first, for the window of this rank. Each cell then takes the mean
    // over its quadrature points if the strain is pooled, else what stands at
    // its position.
    std::vector<double>    ratios;
    const VolumetricStrain form = material.volumetric_form();
    if (form == VolumetricStrain::pointwise)
      return ratios;
    const MaterialPoints<dim> points =
      material_points(tissue, space, growth, material);
    const auto force = internal_force(points, form, kernel);
    std::vector<std::vector<double>> values; // by body
    for (unsigned int b = 0; b < space.n_bodies(); ++b)
      values.push_back(log_volume_ratios(*force, space, b, displacement));
    // The pooled form averages volumes, the projected one their logarithms.
    if (form == VolumetricStrain::pooled)
      for (std::vector<double> &of_body : values)
        for (double &value : of_body)
          value = std::exp(value);
    ratios.reserve(tissue.cells().size());
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        // Where bodies are parted cell by cell, one space has all of them.
        const unsigned int body =
          space.n_bodies() > 1 ? tissue.cells().body(p) : 0;
        const auto            id        = tissue.cells().id(p);
        const Occupancy<dim> &occupancy = space.occupancy(body);
        ratios.push_back(
          form == VolumetricStrain::pooled ?
            mean_of_points(tissue.domain(p), id, occupancy, values[body]) :
            std::exp(mean_of_shares(
              tissue.cells().position(p), id, occupancy, values[body])));
      }
    return ratios;
  }

  MORULA_INSTANTIATE(elastic_volumes);
} // namespace Morula
