// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_mechanics_stressed_ball_h
#define morula_tests_mechanics_stressed_ball_h

#include <morula/effects/surface/loads.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/spline_field.h>

#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "common/body_on_grid.h"
#include "common/linear_problem.h"
#include "common/materials.h"
#include "common/pools.h"

namespace Morula
{
  /** A smooth vector field of waves of some grid cells' length. */
  template <int dim>
  Tensor<1, dim>
  waves(const Point<dim> &x, const double phase)
  {
    Tensor<1, dim> value;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        value[i] += std::sin(x[j] / (90. + 20. * i) + phase + 1.7 * i + j);
    return value;
  }

  template <int dim>
  ElasticState<dim>
  state_at(const Point<dim> &x, const double phase, const double W)
  {
    ElasticState<dim> state{unit_tensor<dim>(), W};
    for (unsigned int i = 0; i < dim; ++i)
      state.A[i] += 0.08 * waves<dim>(x, phase + i);
    return state;
  }

  template <int dim>
  std::vector<ElasticState<dim>>
  states_at(const std::vector<Point<dim>> &points,
            const PointGroups             &groups,
            const double                   phase,
            const double                   W)
  {
    std::vector<ElasticState<dim>> states;
    for (const unsigned int i : groups.points)
      states.push_back(state_at(points[i], phase, W));
    return states;
  }

  /** Points on the sphere, and their outward normals. */
  template <int dim>
  std::vector<Tensor<1, dim>>
  normals(const unsigned int n)
  {
    std::mt19937                generator(7);
    std::vector<Tensor<1, dim>> list;
    for (unsigned int i = 0; i < n; ++i)
      {
        list.push_back(random_tensor<1, dim>(generator));
        list.back() /= list.back().norm();
      }
    return list;
  }

  /**
   * A stressed ball with Nitsche's term (no gap at the displacement u) on a
   * part of its surface, and a following pressure or two lumens, if asked for.
   */
  template <int dim>
  class Ball
  {
  public:
    Ball(const MPI_Comm         comm,
         const bool             pressure,
         const bool             lumen = false,
         const VolumetricStrain form  = VolumetricStrain::pointwise)
      : Ball(comm, pressure, lumen, form, normals<dim>(30))
    {}

    BodyOnGrid<dim>     body;
    Equilibrium::Vector u;

  private:
    MaterialPoints<dim>                     points;
    typename MomentumBalance<dim>::TermList terms;
    QuietTimer                              timer;
    std::vector<Enclosure<dim>>             enclosures;

  public:
    std::unique_ptr<MomentumBalance<dim>> balance;

  private:
    static Point<dim>
    center()
    {
      Point<dim> c;
      for (unsigned int d = 0; d < dim; ++d)
        c[d] = 7. + 11. * d;
      return c;
    }

    static std::vector<Point<dim>>
    on_sphere(const std::vector<Tensor<1, dim>> &N)
    {
      std::vector<Point<dim>> list;
      for (const auto &n : N)
        list.push_back(center() + 92. * n);
      return list;
    }

    Ball(const MPI_Comm                     comm,
         const bool                         pressure,
         const bool                         lumen,
         const VolumetricStrain             form,
         const std::vector<Tensor<1, dim>> &N)
      : body(ball_points(center(), 90., spacing()),
             std::pow(spacing(), dim),
             GridParameters(),
             on_sphere(N),
             comm)
      , u(body.interpolate(
          [](const Point<dim> &x) { return 3. * waves<dim>(x, 0.4); }))
    {
      const auto groups = body.group(body.particles);
      static_cast<GroupedPoints<dim> &>(points) =
        body.grouped(body.particles, groups);
      points.material = &neo_hookean();
      points.lame     = {lame(1., 0.4)};
      points.current =
        states_at(body.particles, groups, 0.3, std::pow(spacing(), dim));
      points.previous =
        states_at(body.particles, groups, 0.9, std::pow(spacing(), dim));
      pool(points);
      terms.push_back(std::make_unique<InternalForce<dim>>(points, form));

      const auto on_boundary = body.group(body.boundary);
      add_nitsche(N, on_boundary);
      if (pressure)
        {
          std::vector<AreaLoad<dim>> loads;
          for (const unsigned int i : on_boundary.points)
            loads.push_back({0.7, 100. * N[i]});
          terms.push_back(
            following_pressure<dim>(body.grouped(body.boundary, on_boundary),
                                    loads));
        }
      for (unsigned int i = 0; lumen && i < 2; ++i)
        enclosures.push_back(
          {SweptVolume<dim>(body.grouped(body.boundary, on_boundary),
                            std::vector(on_boundary.points.size(),
                                        100. * unit_tensor<dim>()[i])),
           5e4,
           {2e4, i * 6e3, 0.1, 1e-5, 4e4}});
      typename MomentumBalance<dim>::EnclosureList list;
      for (const Enclosure<dim> &enclosure : enclosures)
        list.push_back(&enclosure);
      balance = std::make_unique<MomentumBalance<dim>>(
        *body.space, terms, timer, comm, list);
    }

    static double
    spacing()
    {
      return dim == 2 ? 10. : 18.;
    }

    void
    add_nitsche(const std::vector<Tensor<1, dim>> &N, const PointGroups &groups)
    {
      std::vector<Tensor<1, dim>> displacements(body.boundary.size());
      body.at_points(body.boundary,
                     u,
                     [&](const unsigned int i,
                         const auto        &field,
                         const auto &s) { displacements[i] = field.value(s); });
      std::vector<typename Nitsche<dim>::HeldPoint> held_points;
      for (const unsigned int i : groups.points)
        {
          typename Nitsche<dim>::HeldPoint held;
          held.projection =
            i % 2 == 0 ? unit_tensor<dim>() : outer_product(N[i], N[i]);
          held.gap            = -(held.projection * displacements[i]);
          held.position_scale = 100.;
          held.normal         = N[i];
          held.area           = 80.;
          held.penalty        = 2.;
          held.lame           = lame(1., 0.4);
          held_points.push_back(held);
        }
      terms.push_back(std::make_unique<Nitsche<dim>>(
        NitscheForm::symmetric,
        neo_hookean(),
        PartOfLaw::all,
        body.grouped(body.boundary, groups),
        std::move(held_points),
        states_at(body.boundary, groups, 0.3, 1.),
        states_at(body.boundary, groups, 0.9, 1.)));
    }
  };
} // namespace Morula

#endif
