// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <deal.II/numerics/data_out.h>

#include <half-fixed-sphere/neo_hookean.h>
#include <half-fixed-sphere/results.h>
#include <half-fixed-sphere/stability.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace HalfFixedSphere
{
  std::vector<OutlinePoint>
  outline(const Equilibrium &body, const unsigned int n)
  {
    const QIterated<1>        points(QTrapezoid<1>(), n);
    FEFaceValues<2>           values(body.mapping,
                           body.element,
                           points,
                           update_values | update_quadrature_points);
    std::vector<Tensor<1, 2>> u(points.size());
    std::vector<OutlinePoint> result;
    for (const auto &cell : body.dofs.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && face->boundary_id() == upper_surface)
          {
            values.reinit(cell, face);
            values[FEValuesExtractors::Vector(0)].get_function_values(
              body.displacement, u);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                const Point<2> X = values.quadrature_point(q);
                result.push_back({std::atan2(X[0], X[1]), X + u[q]});
              }
          }

    const double slack = 1e-12;
    std::sort(result.begin(),
              result.end(),
              [](const OutlinePoint &a, const OutlinePoint &b) {
                return a.angle < b.angle;
              });
    result.erase(std::unique(result.begin(),
                             result.end(),
                             [&](const OutlinePoint &a, const OutlinePoint &b) {
                               return b.angle - a.angle < slack;
                             }),
                 result.end());
    return result;
  }


  Summary
  summarize(const Equilibrium &body)
  {
    const double inf = std::numeric_limits<double>::infinity();
    Summary      sum = {0., 0., 0., 0., 0., inf, -inf};
    const std::vector<OutlinePoint> surface = outline(body, 16);
    sum.apex                                = surface.front().position[1];
    for (const OutlinePoint &point : surface)
      sum.max_radius = std::max(sum.max_radius, point.position[0]);

    double         energy = 0.;
    MeridianValues values(body.mapping, body.element, body.quadratures);
    for (const auto &cell : body.dofs.active_cell_iterators())
      {
        values.reinit(cell);
        const std::vector<Tensor<2, 3>> F =
          values.deformation(body.displacement);
        for (unsigned int q = 0; q < values.n_points(); ++q)
          {
            const NeoHookean material(body.lambda,
                                      body.mu,
                                      F[q],
                                      body.growth_stretch());
            const double     J = material.elastic_volume_ratio();
            sum.initial_volume += values.volume(q);
            sum.volume += determinant(F[q]) * values.volume(q);
            energy += material.energy() * values.volume(q);
            sum.min_elastic_volume_ratio =
              std::min(sum.min_elastic_volume_ratio, J);
            sum.max_elastic_volume_ratio =
              std::max(sum.max_elastic_volume_ratio, J);
          }
      }
    sum.mean_energy_density = energy / sum.initial_volume;
    return sum;
  }


  namespace
  {
    std::ofstream
    open(const std::string &file, const std::string &header)
    {
      std::ofstream stream(file);
      if (!stream)
        throw InputError("Output", file, "the file cannot be written");
      stream << std::setprecision(10) << header << std::endl;
      return stream;
    }

    void
    write_fields(const Equilibrium &body, const std::string &file)
    {
      using Interpretation =
        DataComponentInterpretation::DataComponentInterpretation;
      const std::vector<Interpretation> vector(
        2, DataComponentInterpretation::component_is_part_of_vector);
      DataOut<2> out;
      out.attach_dof_handler(body.dofs);
      out.add_data_vector(body.displacement,
                          std::vector<std::string>(2, "displacement"),
                          DataOut<2>::type_dof_data,
                          vector);
      DataOutBase::VtkFlags flags;
      flags.write_higher_order_cells = true;
      out.set_flags(flags);
      out.build_patches(body.mapping,
                        body.element.degree,
                        DataOut<2>::curved_inner_cells);
      std::ofstream stream(file);
      out.write_vtu(stream);
    }
  } // namespace


  Writer::Writer(const Parameters &parameters)
    : prefix(parameters.output)
    , write_vtu(parameters.write_vtu)
    , summaries(open(prefix + ".csv",
                     "theta,apex,total_volume,mean_energy_density,max_radius,"
                     "min_elastic_volume_ratio,max_elastic_volume_ratio,"
                     "innermost_size,unknowns,newton_iterations"))
    , outlines(open(prefix + "-outline.csv", "theta,angle,r,z"))
  {
    if (!parameters.modes.empty())
      stability =
        open(prefix + "-stability.csv", "theta,mode,smallest_eigenvalue");
  }


  void
  Writer::write(const Equilibrium &body)
  {
    const double  theta = body.growth_stretch();
    const Summary sum   = summarize(body);
    summaries << theta << ',' << sum.apex << ',' << sum.volume << ','
              << sum.mean_energy_density << ',' << sum.max_radius << ','
              << sum.min_elastic_volume_ratio << ','
              << sum.max_elastic_volume_ratio << ','
              << innermost_size(body.parameters.radius, body.parameters.mesh)
              << ',' << body.dofs.n_dofs() << ',' << body.n_iterations()
              << std::endl;
    for (const OutlinePoint &point : outline(body, body.element.degree))
      outlines << theta << ',' << point.angle << ',' << point.position[0] << ','
               << point.position[1] << std::endl;
    for (const unsigned int m : body.parameters.modes)
      stability << theta << ',' << m << ',' << smallest_eigenvalue(body, m)
                << std::endl;
    if (write_vtu)
      {
        std::ostringstream name;
        name << prefix << '-' << theta << ".vtu";
        write_fields(body, name.str());
      }
  }
} // namespace HalfFixedSphere
