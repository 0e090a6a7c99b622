// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/volumes_of_step.h>
#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/plain_kernels.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace Morula
{
  namespace
  {
    /** A group of a pool after the step, as ranks tell each other. */
    template <int dim>
    struct GroupAfter
    {
      unsigned int number, part; // of the grid cell in the grid's box
      unsigned int phase  = 0;
      double       J_e    = 1.;
      double       volume = 0.; // µm^dim
      /** ρ(ξ) of the pool, as 1 and ξ - ξ̄ have parts in it. */
      std::array<double, dim + 1> growth = {};
      Point<dim>                  centre = {};
      /** The mean place of the pool's points in the grid cell, the smoothed J_e
       *  there, and its slope. */
      Point<dim>     middle   = {};
      double         smoothed = 1.;
      Tensor<1, dim> slope    = {};
      /** The part of the exchange of volume within the pool that takes place.
       */
      double exchanged = 1.;

      double
      expected_growth(const Point<dim> &xi) const
      {
        double rho = growth[0];
        for (unsigned int d = 0; d < dim; ++d)
          rho += growth[1 + d] * (xi[d] - centre[d]);
        return rho;
      }
    };

    /** A displacement on a grid cell, likewise. */
    template <int dim>
    struct FieldAfter
    {
      unsigned int    number, part;
      LocalField<dim> field;
    };

    /** By how much the grown volume of a pool has been multiplied in the step,
     *  as a linear function ρ of the place. @param J_e of a point */
    template <int dim, typename Ratio>
    void
    fit_growth(const MaterialPoints<dim> &points,
               const Pool                &pool,
               const Ratio               &J_e,
               GroupAfter<dim>           &group)
    {
      // The weights J_e G make Σ J_e (G' - ρ G) = 0, so that an exchange of
      // volume within the pool keeps its sum: doc/theory.md (2.9). Few points,
      // or points in a row, say nothing of a slope: their growth is noise.
      double before = 0., after = 0.;
      for (unsigned int p = pool.first; p < pool.last; ++p)
        {
          before += J_e(p) * points.grown[p].before;
          after += J_e(p) * points.grown[p].after;
          group.centre += J_e(p) * points.grown[p].before * points.xi[p];
        }
      group.centre /= before;
      group.growth[0] = after / before;
      Tensor<2, dim> moments;
      Tensor<1, dim> right;
      for (unsigned int p = pool.first; p < pool.last; ++p)
        {
          const Tensor<1, dim> d = points.xi[p] - group.centre;
          const double         w = J_e(p) * points.grown[p].before;
          moments += w * outer_product(d, d);
          right +=
            J_e(p) *
            (points.grown[p].after - group.growth[0] * points.grown[p].before) *
            d;
        }
      if (pool.last - pool.first >= 4 * (dim + 1) &&
          determinant(moments) > std::pow(0.02 * before, dim))
        {
          const Tensor<1, dim> slope = invert(moments) * right;
          for (unsigned int d = 0; d < dim; ++d)
            group.growth[1 + d] = slope[d];
        }
    }

    /** Limits the exchange so that each point carries something on. */
    template <int dim, typename Ratio>
    void
    limit_exchange(const MaterialPoints<dim> &points,
                   const Pool                &pool,
                   const LocalField<dim>     &field,
                   const Ratio               &J_e,
                   GroupAfter<dim>           &group)
    {
      // The deformation is needed of points alone that lose much, which are
      // few.
      constexpr double much = 0.1, most = 0.9;
      for (unsigned int p = pool.first; p < pool.last; ++p)
        {
          const double lost = J_e(p) * (group.expected_growth(points.xi[p]) *
                                          points.grown[p].before -
                                        points.grown[p].after);
          if (lost > much * points.carried[p])
            group.exchanged =
              std::min(group.exchanged,
                       most * points.carried[p] *
                         determinant(field.step_deformation(
                           SplineValues<dim>(points.xi[p], points.h))) /
                         lost);
        }
    }

    /** Adds the groups of a pool after the step. @param after the number and
     *  part of its grid cell */
    template <int dim>
    void
    add_groups(const MaterialPoints<dim>    &points,
               const Pool                   &pool,
               const LocalField<dim>        &field,
               const std::vector<double>    &theta,
               GroupAfter<dim>               after,
               std::vector<GroupAfter<dim>> &list)
    {
      const PoolGroup *const groups = &points.pools.groups[pool.first_group];
      const auto             J_e    = [&](const unsigned int p) {
        unsigned int g = 0;
        while (groups[g].last <= p)
          ++g;
        return std::exp(theta[g]);
      };
      after.growth[0] = 1.;
      for (unsigned int p = pool.first; p < pool.last; ++p)
        after.middle += points.xi[p] / double(pool.last - pool.first);
      if (!points.previous.empty())
        {
          fit_growth(points, pool, J_e, after);
          limit_exchange(points, pool, field, J_e, after);
        }
      for (std::size_t g = 0; g < theta.size(); ++g)
        {
          after.phase  = groups[g].phase;
          after.J_e    = std::exp(theta[g]);
          after.volume = after.J_e * groups[g].grown.at(GrowthAt::current);
          list.push_back(after);
        }
    }

    /** The pools of a body after the step, in the window of this rank. */
    template <int dim>
    class PoolsAfter
    {
    public:
      /** Collective. */
      PoolsAfter(const InternalForce<dim>     &force,
                 const MaterialPoints<dim>    &points,
                 const SplineSpace<dim>       &space,
                 const unsigned int            body,
                 const DisplacementField<dim> &displacement)
        : occupancy(space.occupancy(body))
        , offsets(occupancy.nodes().size() + 1, 0)
      {
        // Each rank evaluates the grid cells that it owns, and tells the ranks
        // in whose windows they lie. Then the groups are sorted by the nodes of
        // this rank's window. The displacement itself is needed where a cell is
        // several points, as each of them moves in its own way.
        const bool                   of_bodies = space.n_bodies() > 1;
        std::vector<GroupAfter<dim>> list;
        std::vector<FieldAfter<dim>> fields_here;
        for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
          {
            const auto &grid_cell = space.grid_cells()[c];
            if ((of_bodies && grid_cell.part != body) || !points.any(c))
              continue;
            const unsigned int    part  = of_bodies ? 0 : grid_cell.part;
            const LocalField<dim> field = displacement.on_grid_cell(c);
            for (unsigned int k = points.pools.offsets[c];
                 k < points.pools.offsets[c + 1];
                 ++k)
              add_groups(points,
                         points.pools.list[k],
                         field,
                         force.energy_of(k, field).theta,
                         GroupAfter<dim>{grid_cell.number, part},
                         list);
            if (points.subdivided)
              fields_here.push_back({grid_cell.number, part, field});
          }
        with_others(list);
        with_others(fields_here);
        const auto node = [&](const auto &one) {
          return occupancy.nodes().node(
            occupancy.window().whole().index(one.number), one.part);
        };
        std::stable_sort(list.begin(),
                         list.end(),
                         [&](const auto &a, const auto &b) {
                           return node(a) < node(b);
                         });
        groups = std::move(list);
        for (const GroupAfter<dim> &group : groups)
          ++offsets[node(group) + 1];
        std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
        if (points.subdivided)
          fields.resize(offsets.size() - 1);
        for (const FieldAfter<dim> &one : fields_here)
          fields[node(one)] = one.field;
        smooth();
      }

      /** Calls visit(group, det f, part) for the quadrature points of a cell,
       *  each with its part of the cell.
       *  @param det_f of the cell, if it is one point */
      template <typename Visit>
      void
      for_each_point(const ParticleDomain<dim>  &domain,
                     const types::particle_index id,
                     const unsigned int          phase,
                     const double                det_f,
                     const Visit                &visit) const
      {
        const auto  n    = occupancy.n_points_per_edge(domain, id);
        const auto &box  = occupancy.window().whole();
        double      part = 1.;
        for (const unsigned int n_d : n)
          part /= n_d;
        domain.for_quadrature_points(n, [&](const Point<dim> &x) {
          occupancy.for_each_share(
            x, [&](const Point<dim> &share, const unsigned int n_shares) {
              const GridIndex<dim> index = box.locate(share);
              const Point<dim>     xi    = box.unit_position(share, index);
              const unsigned int   node =
                occupancy.nodes().node_of_cell(index, id);
              visit(at(node, phase),
                    xi,
                    fields.empty() ? det_f :
                                     determinant(fields[node].step_deformation(
                                       SplineValues<dim>(xi, box.spacing()))),
                    part / n_shares);
            });
        });
      }

    private:
      template <typename Record>
      void
      with_others(std::vector<Record> &list) const
      {
        const auto of_others = occupancy.window().to_windows(list);
        list.insert(list.end(), of_others.begin(), of_others.end());
      }

      const GroupAfter<dim> &
      at(const unsigned int node, const unsigned int phase) const
      {
        unsigned int k = offsets[node];
        while (groups[k].phase != phase)
          ++k;
        AssertIndexRange(k, offsets[node + 1]);
        return groups[k];
      }

      /** A weighted mean of J_e, and of the place in grid cells. */
      struct Mean
      {
        double     J_e = 0., weights = 0.;
        Point<dim> place = {};
      };

      /** Calls visit(i, w) for the groups of the phase of @p k around it, with
       *  their weights by ¼, ½, ¼ in each direction and by volume. */
      template <typename Visit>
      void
      for_like_groups(const unsigned int    k,
                      const GridIndex<dim> &center,
                      const Visit          &visit) const
      {
        occupancy.window().for_neighbors(
          center,
          1,
          [&](const unsigned int other, const GridIndex<dim> &index) {
            double weight = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              weight *= index[d] == center[d] ? 0.5 : 0.25;
            for (unsigned int i = offsets[other]; i < offsets[other + 1]; ++i)
              if (groups[i].phase == groups[k].phase)
                visit(i, weight * groups[i].volume, index);
          });
      }

      /** Finds the smoothed J_e, the mean with the groups of its phase around,
       * and its slope: doc/theory.md (2.10). */
      void
      smooth()
      {
        // What is left of pressure at rest alternates from grid cell to grid
        // cell, as such stripes push nobody. Beside a surface the mean is that
        // of a place further inside, so that the slope of the means around
        // brings it back; and cells are beside the middle of their grid cell.
        // Parts of a grid cell that folds part further stay as
        // they are.
        const GridWindow<dim> &window = occupancy.window();
        std::vector<Mean>      means(groups.size());
        const auto             place = [this](const unsigned int    i,
                                  const GridIndex<dim> &index) {
          Point<dim> x = groups[i].middle;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] += index[d];
          return x;
        };
        const auto for_all = [&](const auto &visit) {
          for (unsigned int number = 0; number < window.size(); ++number)
            for (unsigned int k = offsets[number]; k < offsets[number + 1]; ++k)
              visit(k, window.index(number));
        };
        for_all([&](const unsigned int k, const GridIndex<dim> &center) {
          Mean &mean = means[k];
          for_like_groups(k,
                          center,
                          [&](const unsigned int    i,
                              const double          w,
                              const GridIndex<dim> &index) {
                            mean.J_e += w * groups[i].J_e;
                            mean.place += w * place(i, index);
                            mean.weights += w;
                          });
          mean.J_e /= mean.weights;
          mean.place /= mean.weights;
        });
        for_all([&](const unsigned int k, const GridIndex<dim> &center) {
          // The small term is for directions in which there is no neighbour.
          constexpr double     none    = 1e-3;
          const Tensor<1, dim> to_self = place(k, center) - means[k].place;
          Tensor<2, dim>       moments;
          Tensor<1, dim>       right;
          for_like_groups(
            k,
            center,
            [&](const unsigned int i, const double w, const GridIndex<dim> &) {
              const Tensor<1, dim> d = means[i].place - means[k].place;
              moments += w * outer_product(d, d);
              right += w * (means[i].J_e - means[k].J_e) * d;
            });
          for (unsigned int d = 0; d < dim; ++d)
            moments[d][d] += none * means[k].weights;
          groups[k].slope    = invert(moments) * right;
          groups[k].smoothed = means[k].J_e + groups[k].slope * to_self;
        });
      }

      const Occupancy<dim>        &occupancy;
      std::vector<GroupAfter<dim>> groups;  // by node
      std::vector<unsigned int>    offsets; // of these
      std::vector<LocalField<dim>> fields;  // by node; empty if not needed
    };
  } // namespace


  template <int dim>
  std::vector<VolumeOfStep>
  volumes_of_step(const Tissue<dim>            &tissue,
                  const SplineSpace<dim>       &space,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material,
                  const std::string            &kernel,
                  const DisplacementField<dim> &displacement,
                  const MaterialPoints<dim>    *known)
  {
    // Volumes belong to pools. They are found first, for the window of this
    // rank. Each cell then takes the mean of J_e over its quadrature points,
    // and carries on what it brought, as its points have moved, with what it
    // has grown beyond its pool: doc/theory.md (2.9).
    std::vector<VolumeOfStep> volumes;
    if (material.volumetric_form() == VolumetricStrain::pointwise)
      return volumes;
    const MaterialPoints<dim> made =
      known ? MaterialPoints<dim>() :
              material_points(tissue, space, growth, material);
    const MaterialPoints<dim> &points = known ? *known : made;
    const auto force = internal_force(points, VolumetricStrain::pooled, kernel);
    std::vector<PoolsAfter<dim>> pools; // by body
    for (unsigned int b = 0; b < space.n_bodies(); ++b)
      pools.emplace_back(*force, points, space, b, displacement);
    const std::vector<unsigned int> phases =
      phases_of_cells(tissue, growth, material);
    std::vector<PointMotion<dim>> motions;
    if (!points.subdivided)
      motions = point_motions(tissue.cells(),
                              displacement,
                              motion_kernel<dim>(material.material(), kernel));
    volumes.resize(tissue.cells().size());
    for (unsigned int p = 0; p < volumes.size(); ++p)
      {
        const auto   cell = tissue.cells()[p];
        const double V0 = cell.initial_volume(), c = cell.carried_volume();
        const double before = V0 * determinant(growth.growth_before(tissue, p)),
                     after  = V0 * determinant(growth.growth_after(tissue, p));
        double smoothed     = 0.;
        // Where bodies are parted cell by cell, one space has all of them.
        pools[space.n_bodies() > 1 ? tissue.cells().body(p) : 0].for_each_point(
          tissue.domain(p),
          tissue.cells().id(p),
          phases.empty() ? 0 : phases[p],
          points.subdivided ? 1. : determinant(motions[p].f),
          [&](const GroupAfter<dim> &group,
              const Point<dim>      &xi,
              const double           det_f,
              const double           part) {
            volumes[p].J_e += part * group.J_e;
            smoothed +=
              part * (group.smoothed + group.slope * (xi - group.middle));
            volumes[p].carried +=
              part *
              (c * det_f + group.exchanged * group.J_e *
                             (after - group.expected_growth(xi) * before));
          });
        volumes[p].smoothing = smoothed / volumes[p].J_e;
      }
    return volumes;
  }

  MORULA_INSTANTIATE(volumes_of_step);
} // namespace Morula
