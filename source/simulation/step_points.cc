// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/point_exchange.h>
#include <morula/simulation/step_points.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

namespace Morula
{
  namespace
  {
    /** A quadrature point's part of MaterialPoints. */
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
      return {cell.deformation() * invert(F_g),
              cell.initial_volume() *
                (material.per_grown_volume() ? determinant(F_g) : 1.)};
    }

    /** Data of cell number @p i in the order of Tissue::cells(). */
    template <int dim>
    PointData<dim>
    data_of(const Tissue<dim>       &tissue,
            const unsigned int       i,
            const GrowthOfStep<dim> &growth,
            const TissueMaterial    &material)
    {
      const auto     cell = tissue.cell(tissue.cells().order()[i]);
      PointData<dim> data;
      data.lame = material.lame_at(cell.founder_position());
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

    /** Of n quadrature points per edge. */
    template <std::size_t dim>
    unsigned int
    n_points(const std::array<unsigned int, dim> &n)
    {
      return std::accumulate(n.begin(), n.end(), 1u, std::multiplies<>());
    }

    // Rows of numbers, for the exchange of points between ranks.
    template <int dim>
    constexpr unsigned int row_length = 2 + 2 * (dim * dim + 1);

    template <int dim>
    void
    append_row(const PointData<dim> &data,
               const double          part,
               std::vector<double>  &rows)
    {
      rows.push_back(data.lame.lambda);
      rows.push_back(data.lame.mu);
      for (const auto *state : {&data.current, &data.previous})
        {
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e < dim; ++e)
              rows.push_back(state->A[d][e]);
          rows.push_back(part * state->W);
        }
    }

    template <int dim>
    PointData<dim>
    from_row(const double *row)
    {
      PointData<dim> data;
      data.lame = {row[0], row[1]};
      row += 2;
      for (auto *state : {&data.current, &data.previous})
        {
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e < dim; ++e)
              state->A[d][e] = *row++;
          state->W = *row++;
        }
      return data;
    }

    /** Cells with several points, which may lie in grid cells of other ranks,
     *  or with points that several grid cells share. */
    template <int dim>
    MaterialPoints<dim>
    subdivided_points(const Tissue<dim>       &tissue,
                      const SplineSpace<dim>  &space,
                      const GrowthOfStep<dim> &growth,
                      const TissueMaterial    &material)
    {
      const GridBox<dim> &box = space.box();
      PointList<dim>      list;
      list.n_slots = row_length<dim>;
      for (unsigned int i = 0; i < tissue.cells().order().size(); ++i)
        {
          const auto               &particle = tissue.cells().order()[i];
          const PointData<dim>      data = data_of(tissue, i, growth, material);
          const ParticleDomain<dim> domain = tissue.domain(particle);
          const auto   n    = space.occupancy().n_points_per_edge(domain);
          const double part = 1. / n_points(n);
          domain.for_quadrature_points(n, [&](const Point<dim> &point) {
            space.occupancy().for_each_share(
              point, [&](const Point<dim> &share, const unsigned int n_shares) {
                list.ids.push_back(particle->get_id());
                list.positions.push_back(share);
                append_row(data, part / n_shares, list.properties);
              });
          });
        }
      list = send_to_owners(list, tissue.grid());

      // By grid cell, then by id, then in the order in the domain, so that
      // sums do not depend on who sent what.
      std::vector<unsigned int> numbers(list.size()), order(list.size());
      for (std::size_t k = 0; k < list.size(); ++k)
        numbers[k] = box.number(box.locate(list.positions[k]));
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(),
                       order.end(),
                       [&](const unsigned int a, const unsigned int b) {
                         return std::make_pair(numbers[a], list.ids[a]) <
                                std::make_pair(numbers[b], list.ids[b]);
                       });

      MaterialPoints<dim> points;
      points.h          = box.spacing();
      points.subdivided = true;
      points.offsets.push_back(0);
      std::size_t k = 0;
      for (const auto &cell : space.grid_cells())
        {
          const GridIndex<dim> index = box.index(cell.number);
          for (; k < order.size() && numbers[order[k]] == cell.number; ++k)
            {
              points.xi.push_back(
                box.unit_position(list.positions[order[k]], index));
              append(from_row<dim>(&list.properties[order[k] * list.n_slots]),
                     growth.present,
                     material.is_uniform(),
                     points);
            }
          points.offsets.push_back(points.xi.size());
        }
      AssertThrow(k == order.size(), ExcInternalError());
      return points;
    }
  } // namespace

  template <int dim>
  GroupedPoints<dim>
  cell_positions(const Tissue<dim> &tissue, const SplineSpace<dim> &space)
  {
    GroupedPoints<dim> points;
    points.offsets = group_points(tissue.cells(), space, [](const auto &) {
                       return true;
                     }).offsets;
    points.h       = space.box().spacing();
    points.xi.reserve(tissue.cells().order().size());
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        const GridIndex<dim> index =
          space.box().index(space.grid_cells()[c].number);
        for (unsigned int p = points.offsets[c]; p < points.offsets[c + 1]; ++p)
          points.xi.push_back(
            space.box().unit_position(tissue.cells().order()[p]->get_location(),
                                      index));
      }
    return points;
  }

  template <int dim>
  MaterialPoints<dim>
  material_points(const Tissue<dim>       &tissue,
                  const SplineSpace<dim>  &space,
                  const GrowthOfStep<dim> &growth,
                  const TissueMaterial    &material)
  {
    bool several = false;
    for (const auto &particle : tissue.cells().order())
      {
        several = several || n_points(space.occupancy().n_points_per_edge(
                               tissue.domain(particle))) > 1;
        space.occupancy().for_each_share(particle->get_location(),
                                         [&](const Point<dim> &,
                                             const unsigned int n) {
                                           several = several || n > 1;
                                         });
      }
    if (Utilities::MPI::logical_or(several, tissue.communicator()))
      return subdivided_points(tissue, space, growth, material);

    MaterialPoints<dim> points;
    static_cast<GroupedPoints<dim> &>(points) = cell_positions(tissue, space);
    points.current.reserve(points.xi.size());
    if (growth.present)
      points.previous.reserve(points.xi.size());
    for (unsigned int i = 0; i < tissue.cells().order().size(); ++i)
      append(data_of(tissue, i, growth, material),
             growth.present,
             material.is_uniform(),
             points);
    return points;
  }

#define INSTANTIATE(dim)                                                  \
  template MaterialPoints<dim> material_points(const Tissue<dim> &,       \
                                               const SplineSpace<dim> &,  \
                                               const GrowthOfStep<dim> &, \
                                               const TissueMaterial &);   \
  template GroupedPoints<dim>  cell_positions(const Tissue<dim> &,        \
                                              const SplineSpace<dim> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
