// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/volumes_of_step.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
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
      // Where volumes are pooled: c and V⁰ det F_g, µm^dim.
      double carried;
      Grown  grown;
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

    /** The data of the cell's quadrature points without λ and μ, which need not
     *  be known for each cell where they are uniform. */
    template <int dim>
    PointData<dim>
    data_of(const Tissue<dim>            &tissue,
            const unsigned int            i,
            const DevelopmentOfStep<dim> &growth,
            const TissueMaterial         &material)
    {
      const auto           cell = tissue.cells()[i];
      PointData<dim>       data{};
      const Tensor<2, dim> before = growth.growth_before(tissue, i),
                           after  = growth.growth_after(tissue, i);
      data.current                = elastic_state(cell, after, material);
      if (growth.present)
        data.previous = elastic_state(cell, before, material);
      const double V0 = cell.initial_volume();
      data.carried    = cell.carried_volume();
      data.grown      = {V0 * determinant(before), V0 * determinant(after)};
      return data;
    }

    /** Number of a value's class on a logarithmic scale from the largest one
     *  downwards; values of a class differ by a quarter at most. */
    unsigned int
    class_of(const double value, const double largest)
    {
      constexpr double ratio = 1.25, last = 999.;
      return value > 0. ?
               std::lround(
                 std::min(last, std::log(largest / value) / std::log(ratio))) :
               last;
    }

    template <int dim>
    void
    append(const PointData<dim> &data,
           const bool            growing,
           const TissueMaterial &material,
           MaterialPoints<dim>  &points)
    {
      if (!material.is_uniform() || points.lame.empty())
        points.lame.push_back(data.lame);
      points.current.push_back(data.current);
      if (growing)
        points.previous.push_back(data.previous);
      if (material.volumetric_form() == VolumetricStrain::pooled)
        {
          points.carried.push_back(data.carried);
          points.grown.push_back(data.grown);
        }
    }

    /** The number of points of a cell that has n[k] of them along edge k. */
    template <std::size_t dim>
    unsigned int
    n_points(const std::array<unsigned int, dim> &n)
    {
      return std::accumulate(n.begin(), n.end(), 1u, std::multiplies<>());
    }

    /** What ranks tell each other of a quadrature point: its part, its phase,
     * λ, μ, A and W of both states, c, and V⁰ det F_g of both. */
    template <int dim>
    using Message = std::tuple<unsigned int,
                               unsigned int,
                               double,
                               double,
                               Tensor<2, dim>,
                               double,
                               Tensor<2, dim>,
                               double,
                               double,
                               double,
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
                      const TissueMaterial         &material,
                      std::vector<unsigned int>    &phases)
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
          const Lame                lame = growth.lame_of(tissue, i, material);
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
                    phases.empty() ? 0 : phases[i],
                    lame.lambda,
                    lame.mu,
                    data.current.A,
                    of_cell * data.current.W,
                    data.previous.A,
                    of_cell * data.previous.W,
                    of_cell * data.carried,
                    of_cell * data.grown.before,
                    of_cell * data.grown.after));
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
      std::vector<unsigned int> of_points;
      std::size_t               k = 0;
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
              const auto [part,
                          phase,
                          lambda,
                          mu,
                          A,
                          W,
                          A_before,
                          W_before,
                          carried,
                          grown_before,
                          grown] = list.template value<Message<dim>>(order[k]);
              append<dim>({{lambda, mu},
                           {A, W},
                           {A_before, W_before},
                           carried,
                           {grown_before, grown}},
                          growth.present,
                          material,
                          points);
              of_points.push_back(phase);
            }
          points.offsets.push_back(points.xi.size());
        }
      // A point outside all active grid cells would carry energy that no spline
      // sees.
      AssertThrow(k == order.size(), ExcInternalError());
      if (!phases.empty())
        phases = of_points;
      return points;
    }
  } // namespace

  template <int dim>
  std::vector<unsigned int>
  phases_of_cells(const Tissue<dim>            &tissue,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material)
  {
    // The classes are those of μ, k and 1/τ. They begin with the largest
    // values of the tissue, so that they do not depend on the unit, and small
    // differences of equal cells do not part them. What does not relax has a
    // class of its own.
    if (material.is_uniform() && growth.relaxation.empty())
      return {};
    const std::size_t                  n = tissue.cells().size();
    std::vector<std::array<double, 3>> values(n);
    double                             largest[3] = {0., 0., 0.};
    for (unsigned int i = 0; i < n; ++i)
      {
        const Lame lame = growth.lame_of(tissue, i, material);
        values[i]       = {
          {lame.mu,
                 material.material().bulk_modulus(lame.lambda, lame.mu),
           growth.relaxation.empty() ? 0. : growth.relaxation[i].exponent}};
        for (unsigned int k = 0; k < 3; ++k)
          largest[k] = std::max(largest[k], values[i][k]);
      }
    Utilities::MPI::max(largest, tissue.communicator(), largest);
    std::vector<unsigned int> result(n, 0);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int k = 0; k < 3; ++k)
        result[i] = 1000 * result[i] +
                    (largest[k] > 0. ? class_of(values[i][k], largest[k]) : 0);
    const bool differ =
      std::any_of(result.begin(), result.end(), [](const unsigned int phase) {
        return phase != 0;
      });
    return Utilities::MPI::logical_or(differ, tissue.communicator()) ?
             result :
             std::vector<unsigned int>();
  }


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
    const bool pooled = material.volumetric_form() == VolumetricStrain::pooled;
    std::vector<unsigned int> phases;
    if (pooled)
      phases = phases_of_cells(tissue, growth, material);
    bool subdivides = false;
    for (unsigned int b = 0; b < space.n_bodies(); ++b)
      subdivides = subdivides || space.occupancy(b).subdivides();
    MaterialPoints<dim> points;
    if (Utilities::MPI::logical_or(subdivides, tissue.communicator()))
      points = subdivided_points(tissue, space, growth, material, phases);
    else
      {
        points.material = &material.material();
        static_cast<GroupedPoints<dim> &>(points) =
          cell_positions(tissue, space);
        points.current.reserve(points.xi.size());
        if (growth.present)
          points.previous.reserve(points.xi.size());
        for (unsigned int i = 0; i < tissue.cells().size(); ++i)
          {
            PointData<dim> data = data_of(tissue, i, growth, material);
            if (!material.is_uniform() || i == 0)
              data.lame = growth.lame_of(tissue, i, material);
            append(data, growth.present, material, points);
          }
      }
    if (pooled)
      make_pools(space, phases, points);
    return points;
  }

  MORULA_INSTANTIATE(phases_of_cells);
  MORULA_INSTANTIATE(material_points);
  MORULA_INSTANTIATE(cell_positions);

} // namespace Morula
