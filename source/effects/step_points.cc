// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/step_points.h>
#include <morula/mechanics/internal_force.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace Morula
{
  namespace
  {
    /** What MaterialPoints has of one quadrature point: A = F F_g⁻¹ and W, with
     *  the growth at t + dt and, for the first tangent, that at t. */
    template <int dim>
    struct PointData
    {
      Lame              lame;
      ElasticState<dim> current, previous;
    };

    template <int dim>
    ElasticState<dim>
    elastic_state(const CellView<dim, const double> &cell,
                  const Tensor<2, dim>              &F_g,
                  const TissueMaterial              &material)
    {
      return {cell.F() * invert(F_g),
              cell.initial_volume() *
                (material.per_grown_volume() ? determinant(F_g) : 1.)};
    }

    /** λ and μ of cell number @p i in the order of Tissue::cells(). */
    template <int dim>
    Lame
    lame_of(const Tissue<dim>            &tissue,
            const unsigned int            i,
            const DevelopmentOfStep<dim> &growth,
            const TissueMaterial         &material)
    {
      return growth.lame.empty() ?
               material.lame_at(tissue.cells()[i].founder_position()) :
               growth.lame[i];
    }

    /** The data of the cell's quadrature points without λ and μ, which need not
     *  be known for each cell where they are uniform. */
    template <int dim>
    PointData<dim>
    data_of(const Tissue<dim>            &tissue,
            const unsigned int            i,
            const DevelopmentOfStep<dim> &growth,
            const TissueMaterial         &material)
    {
      const auto     cell = tissue.cells()[i];
      PointData<dim> data{};
      if (growth.present)
        {
          data.current  = elastic_state(cell, growth.current[i], material);
          data.previous = elastic_state(cell, growth.previous[i], material);
        }
      else
        data.current = elastic_state(cell, cell.growth(), material);
      return data;
    }

    template <int dim>
    void
    append(const PointData<dim> &data,
           const bool            growing,
           const bool            uniform,
           MaterialPoints<dim>  &points)
    {
      if (!uniform || points.lame.empty())
        points.lame.push_back(data.lame);
      points.current.push_back(data.current);
      if (growing)
        points.previous.push_back(data.previous);
    }

    /** The number of points of a cell that has n[k] of them along edge k. */
    template <std::size_t dim>
    unsigned int
    n_points(const std::array<unsigned int, dim> &n)
    {
      return std::accumulate(n.begin(), n.end(), 1u, std::multiplies<>());
    }

    /** What ranks tell each other of a quadrature point: its part, λ, μ, and A
     *  and W of both states. */
    template <int dim>
    using Message = std::tuple<unsigned int,
                               double,
                               double,
                               Tensor<2, dim>,
                               double,
                               Tensor<2, dim>,
                               double>;

    /** Where points stand, by grid cell and part, and their order: by place,
     *  then by the cell's id, then as they stand in the cell, so that sums do
     *  not depend on who sent what. */
    template <int dim>
    std::pair<std::vector<std::pair<unsigned int, unsigned int>>,
              std::vector<unsigned int>>
    in_order(const PointList<dim> &list, const GridBox<dim> &box)
    {
      std::vector<std::pair<unsigned int, unsigned int>> places(list.size());
      std::vector<unsigned int>                          order(list.size());
      for (std::size_t k = 0; k < list.size(); ++k)
        places[k] = {box.number(box.locate(list.positions[k])),
                     std::get<0>(list.template value<Message<dim>>(k))};
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(),
                       order.end(),
                       [&](const unsigned int a, const unsigned int b) {
                         return std::tie(places[a], list.ids[a]) <
                                std::tie(places[b], list.ids[b]);
                       });
      return {places, order};
    }

    /** The quadrature points where some cell has several of them, which may lie
     *  in grid cells of other ranks, or where several grid cells share a point.
     *  Collective. */
    template <int dim>
    MaterialPoints<dim>
    subdivided_points(const Tissue<dim>            &tissue,
                      const SplineSpace<dim>       &space,
                      const DevelopmentOfStep<dim> &growth,
                      const TissueMaterial         &material)
    {
      // There are three passes. Each rank cuts its cells into points by
      // doc/theory.md (2.2), (2.2b), each with its part of W, and sends them to
      // the owners of their grid cells. The owner sorts what it gets. The last
      // pass walks through the active grid cells and the sorted points
      // together, and notes where the points of each grid cell end.
      const GridBox<dim> &box = space.box();
      PointList<dim>      list(Flat<Message<dim>>::n);
      for (unsigned int i = 0; i < tissue.cells().size(); ++i)
        {
          const PointData<dim>      data = data_of(tissue, i, growth, material);
          const Lame                lame = lame_of(tissue, i, growth, material);
          const ParticleDomain<dim> domain = tissue.domain(i);
          const unsigned int        body   = tissue.cells().body(i);
          const auto                id     = tissue.cells().id(i);
          const auto   n = space.occupancy(body).n_points_per_edge(domain, id);
          const double part = 1. / n_points(n);
          domain.for_quadrature_points(n, [&](const Point<dim> &point) {
            // A point within rounding of a grid line belongs to all grid cells
            // around it, in equal parts.
            space.occupancy(body).for_each_share(
              point, [&](const Point<dim> &share, const unsigned int n_shares) {
                const double of_cell = part / n_shares;
                list.add_value(
                  id,
                  share,
                  Message<dim>(
                    space.part_of_cell(id, body, box.number(box.locate(share))),
                    lame.lambda,
                    lame.mu,
                    data.current.A,
                    of_cell * data.current.W,
                    data.previous.A,
                    of_cell * data.previous.W));
              });
          });
        }
      list = send_to_owners(std::move(list), tissue.grid());

      const auto [places, order] = in_order(list, box);
      MaterialPoints<dim> points;
      points.material   = &material.material();
      points.h          = box.spacing();
      points.subdivided = true;
      points.offsets.push_back(0);
      std::size_t k = 0;
      for (const auto &cell : space.grid_cells())
        {
          const GridIndex<dim> index = box.index(cell.number);
          for (; k < order.size() && space.is_at(cell,
                                                 places[order[k]].first,
                                                 places[order[k]].second);
               ++k)
            {
              points.xi.push_back(
                box.unit_position(list.positions[order[k]], index));
              const auto [part, lambda, mu, A, W, A_before, W_before] =
                list.template value<Message<dim>>(order[k]);
              append<dim>({{lambda, mu}, {A, W}, {A_before, W_before}},
                          growth.present,
                          material.is_uniform(),
                          points);
            }
          points.offsets.push_back(points.xi.size());
        }
      // A point outside all active grid cells would carry energy that no spline
      // sees.
      AssertThrow(k == order.size(), ExcInternalError());
      return points;
    }
  } // namespace

  template <int dim>
  GroupedPoints<dim>
  cell_positions(const Tissue<dim> &tissue, const SplineSpace<dim> &space)
  {
    return grouped_places(tissue.cells(),
                          space,
                          group_points(tissue.cells(), space, [](const auto &) {
                            return true;
                          }));
  }

  template <int dim>
  MaterialPoints<dim>
  material_points(const Tissue<dim>            &tissue,
                  const SplineSpace<dim>       &space,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material)
  {
    // If any rank has a cell with several points, all ranks exchange points.
    // Otherwise each cell is one point of the rank that owns it, in the order
    // of the cells, which is that of their grid cells already. λ and μ stand
    // there once if they are uniform.
    bool subdivides = false;
    for (unsigned int b = 0; b < space.n_bodies(); ++b)
      subdivides = subdivides || space.occupancy(b).subdivides();
    if (Utilities::MPI::logical_or(subdivides, tissue.communicator()))
      return subdivided_points(tissue, space, growth, material);

    MaterialPoints<dim> points;
    points.material                           = &material.material();
    static_cast<GroupedPoints<dim> &>(points) = cell_positions(tissue, space);
    points.current.reserve(points.xi.size());
    if (growth.present)
      points.previous.reserve(points.xi.size());
    for (unsigned int i = 0; i < tissue.cells().size(); ++i)
      {
        PointData<dim> data = data_of(tissue, i, growth, material);
        if (!material.is_uniform() || i == 0)
          data.lame = lame_of(tissue, i, growth, material);
        append(data, growth.present, material.is_uniform(), points);
      }
    return points;
  }

  MORULA_INSTANTIATE(material_points);
  MORULA_INSTANTIATE(cell_positions);


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
                    occupancy.window().whole().locate(share), id)] /
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
