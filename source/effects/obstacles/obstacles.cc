// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/name_list.h>
#include <morula/effects/obstacles/body.h>
#include <morula/effects/scene_keys.h>
#include <morula/mechanics/point_term.h>

#include <deal.II/base/mpi.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <deque>
#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Section "Obstacles": names first, then a section for each of them. */
    struct ObstaclesParameters : public EffectKeys
    {
      Key<std::string> names{
        {this, "Obstacles/Names"},
        "",
        "Rigid bodies that the surface of the tissue cannot enter, separated "
        "by commas. Each has a section of this name. Empty: none."};
      std::deque<ObstacleKeys> obstacles;

      bool
      is_on() const override
      {
        return !obstacles.empty();
      }
      EffectFacts
      facts() const override
      {
        EffectFacts facts;
        facts.names_key = &names;
        return facts;
      }
      void
      declare_sections(const std::string &text,
                       const std::vector<std::string> &) override
      {
        for (const std::string &name :
             declared_names(names, text, reason_against_section))
          obstacles.emplace_back(name);
      }
      using Keys::list;
      KeyList
      list() override
      {
        return keys_of_all(names, obstacles);
      }
    };

    /**
     * Contact without friction between boundary points and rigid bodies: the
     * energy Π = Σ a_t κ φ²/2 of all points with φ < 0, or that a two-sided
     * body holds, where φ is the distance to a body, positive on the side of
     * the tissue. Its residual is a_t κ φ ∇φ N_a, its tangent a_t κ (∇φ⊗∇φ + φ
     * ∇∇φ) N_a N_b: doc/theory.md (4.8d), (4.8e). Keeps references to the
     * bodies.
     */
    template <int dim>
    class ObstacleContact : public PointTerm<dim>
    {
    public:
      /** A body during the step. */
      struct Obstacle
      {
        /** The body at t = 0. */
        const Body<dim> *body;
        /** Whether the tissue is inside. */
        bool is_mould;
        /** Way of the body from t = 0 to the end of the step, µm. */
        Tensor<1, dim> way;
        /** κ, kPa/µm. */
        double stiffness;
        /** The number that points have which it holds; 0: it holds none. */
        unsigned int bit = 0;

        /** How deep @p x (µm) is in the obstacle, µm; negative: not in it. */
        double
        depth(const Point<dim> &x) const
        {
          const double distance = (*body)(x - way).value;
          return is_mould ? distance : -distance;
        }
      };

      ObstacleContact(const LoadedPoints<dim> &points,
                      std::vector<Obstacle>    obstacles)
        : PointTerm<dim>(points)
        , boundary_points(points.points)
        , obstacles(std::move(obstacles))
      {}

    private:
      void
      add_point(const unsigned int       p,
                const SplineValues<dim> &splines,
                const LocalField<dim>   &field,
                LocalSystem<dim>        &system) const override
      {
        // The place is the one of this evaluation, x_t + u, so Newton's method
        // finds anew which points touch. A point that is held is so for the
        // whole step, so that its energy has no kink. The body stays where it
        // is at t = 0 and the place goes back by the body's way, since a body
        // only moves and never turns.
        const Point<dim> x = boundary_points[p].x + field.value(splines);
        for (const Obstacle &obstacle : obstacles)
          {
            // For a mould, φ of doc/theory.md (4.8d) is minus the distance to
            // the body. Energy, force and tangent are all even in φ, so the
            // sign matters only to which points are in contact.
            const Distance<dim> phi = (*obstacle.body)(x - obstacle.way);
            if ((boundary_points[p].touched & obstacle.bit) == 0 &&
                (obstacle.is_mould ? phi.value <= 0. : phi.value >= 0.))
              continue;
            const double k =
              boundary_points[p].area.norm() * obstacle.stiffness;
            // The energy is that of doc/theory.md (4.8d), the force its
            // derivative, and the matrix that of (4.8e), with a_t κ in k.
            // Inside of a round body the term with the curvature is negative
            // along its surface, as a point there may slide off it.
            add_force_at(splines,
                         0.5 * k * phi.value * phi.value,
                         k * phi.value * phi.gradient,
                         k * (outer_product(phi.gradient, phi.gradient) +
                              phi.value * phi.curvature),
                         system);
          }
      }

      const std::vector<typename LoadedPoints<dim>::Point> boundary_points;
      const std::vector<Obstacle>                          obstacles;
    };

    /** A two-sided obstacle holds points that are so near to it once, and until
     *  they are farther off, in grid spacings. */
    constexpr double touching = 0.01, reach = 0.5;

    /** The least cosine of the angle between the normal of a point that is held
     *  and the way to the obstacle. */
    constexpr double least_cosine = 0.5;

    /** The velocity, which may depend on the time alone. @throws InputError */
    Expression
    velocity_of(const ObstacleKeys &keys, const unsigned int dim)
    {
      // A velocity that varies in space would deform the body, and its distance
      // would not be known.
      const Expression velocity = keys.velocity.expression(dim);
      for (const Variable place : {Variable::X, Variable::Y, Variable::Z})
        if (velocity.uses(place))
          keys.velocity.refuse("functions of t",
                               "An obstacle moves as a whole: remove X, Y and "
                               "Z.");
      return velocity;
    }

    /** The least thickness of what the tissue is outside of, µm: a point that
     *  is deeper than half of it comes out on the other side. */
    double
    thickness_of(const ObstacleKeys &keys, const unsigned int dim)
    {
      double least = std::numeric_limits<double>::infinity();
      if (keys.side == "inside")
        return least;
      if (keys.shape == "sphere" || keys.shape == "cylinder")
        least = 2. * keys.radius;
      if (keys.shape == "box")
        for (unsigned int d = 0; d < dim; ++d)
          least = std::min(least, keys.size.value()[d]);
      return least;
    }

    /** How deep the deepest of some places of this rank is in an obstacle, and
     *  which it is; 0 if none is in it. */
    template <int dim>
    std::pair<double, Point<dim>>
    deepest(const typename ObstacleContact<dim>::Obstacle &obstacle,
            const std::vector<Point<dim>>                 &places)
    {
      std::pair<double, Point<dim>> best(0., Point<dim>());
      for (const Point<dim> &place : places)
        if (const double depth = obstacle.depth(place); depth > best.first)
          best = {depth, place};
      return best;
    }

    /** Rigid bodies that the surface of the tissue slides along and cannot
     *  enter: doc/theory.md (4.8d). */
    template <int dim>
    class Obstacles : public BoundaryCondition<dim>
    {
    public:
      using Parameters = ObstaclesParameters;

      /** @throws InputError for bodies that do not exist, and for velocities
       * that cannot be parsed */
      explicit Obstacles(const Parameters &parameters)
      {
        unsigned int n_two_sided = 0;
        for (const ObstacleKeys &keys : parameters.obstacles)
          list.push_back({keys.name,
                          keys.side == "inside",
                          make_body<dim>(keys),
                          keys.stiffness,
                          velocity_of(keys, dim),
                          thickness_of(keys, dim),
                          keys.two_sided ? 1u << n_two_sided++ % 32 : 0});
        if (n_two_sided > 32)
          parameters.obstacles.back().two_sided.refuse(
            "true for at most 32 obstacles", "Join some of them into a mesh.");
      }

      /** @throws StepFailed if an obstacle moves too far in the step */
      std::unique_ptr<Term<dim>>
      term(const LoadedPoints<dim> &points, const double t) const override
      {
        // Each obstacle is put where it is at the end of the step, with κ = α
        // E/h of doc/theory.md (4.8d). Three things would break the contact,
        // and all ask for a shorter step. A body that moves by more than a grid
        // spacing may pass thin tissue before any point notices, and a body
        // that moves by more than half of its own thickness the surface that it
        // meets. A surface that begins deeper than that may be pushed out on
        // the wrong side of a thin body. The depth is that of this rank's
        // points, so the caller makes a failure known to all ranks.
        const double            h = points.h;
        std::vector<Point<dim>> places;
        for (const auto &point : points.points)
          places.push_back(point.x);
        std::vector<typename ObstacleContact<dim>::Obstacle> obstacles;
        for (const Obstacle &obstacle : list)
          {
            obstacles.push_back(obstacle.at(t, points));
            std::ostringstream text;
            const double       step =
              (obstacles.back().way - obstacle.way(points.time)).norm();
            if (step > h)
              {
                text << "the obstacle '" << obstacle.name << "' moves by "
                     << step << " um in a step, more than a grid spacing";
                throw StepFailed(text.str());
              }
            const auto before = obstacle.at(points.time, points);
            if (step > 0.5 * obstacle.thickness &&
                std::any_of(places.begin(), places.end(), [&](const auto &x) {
                  return before.depth(x) > -step;
                }))
              {
                text << "the obstacle '" << obstacle.name << "' moves by "
                     << step
                     << " um in a step, more than half of its thickness, and "
                        "could pass the surface unnoticed";
                throw StepFailed(text.str());
              }
            const auto [depth, place] = deepest<dim>(obstacles.back(), places);
            if (depth > h)
              {
                text << "the surface at (" << place << ") um is " << depth
                     << " um deep in the obstacle '" << obstacle.name
                     << "', more than a grid spacing";
                throw StepFailed(text.str());
              }
          }
        return std::make_unique<ObstacleContact<dim>>(points,
                                                      std::move(obstacles));
      }
      /** One part for each obstacle. */
      std::vector<typename BoundaryCondition<dim>::Part>
      parts(const LoadedPoints<dim> &points, const double t) const override
      {
        using Bodies = std::vector<typename ObstacleContact<dim>::Obstacle>;
        std::vector<typename BoundaryCondition<dim>::Part> parts;
        for (const Obstacle &obstacle : list)
          parts.push_back({obstacle.name,
                           std::make_unique<ObstacleContact<dim>>(
                             points, Bodies{obstacle.at(t, points)}),
                           true});
        return parts;
      }
      bool
      only_pushes() const override
      {
        return true;
      }
      void
      add_columns(BoundaryColumns<dim> &columns) const override
      {
        for (const Obstacle &one : list)
          if (one.bit != 0 && !columns.touched.exists())
            columns.touched = columns.template add<unsigned int>(
              {"touched",
               "",
               "sum of 2^k for each two-sided obstacle k that holds the point",
               0,
               AtDivision::copied,
               true});
      }
      void
      touch(Tissue<dim> &tissue, const double t) const override
      {
        // A point is held once it touches with its side towards the obstacle,
        // until it is out of reach or turns away; new patches inherit it.
        const BoundaryPoints<dim> &points = tissue.boundary_points();
        const auto                &column = points.columns().touched;
        const double               h      = tissue.grid().box().spacing();
        for (const Obstacle &one : list)
          {
            const Tensor<1, dim> way = one.way(t);
            for (unsigned int p = 0; one.bit != 0 && p < points.size(); ++p)
              {
                const auto           point = tissue.boundary_point(p);
                const Tensor<1, dim> A     = point.area_vector();
                const unsigned int   marks = point.get(column);
                const double         limit = marks & one.bit ? reach : touching;
                const auto           phi   = one.body(points.position(p) - way);
                const double         sign  = one.is_mould ? -1. : 1.;
                const bool           is_held =
                  sign * phi.value <= limit * h &&
                  sign * phi.gradient * A <= -least_cosine * A.norm();
                point.set(column, is_held ? marks | one.bit : marks & ~one.bit);
              }
          }
      }
      std::vector<typename BoundaryCondition<dim>::Forbidden>
      forbidden(const double t) const override
      {
        std::vector<typename BoundaryCondition<dim>::Forbidden> places;
        for (const Obstacle &one : list)
          places.emplace_back(one.name,
                              [&one, way = one.way(t)](const Point<dim> &x) {
                                const auto phi = one.body(x - way);
                                return (one.is_mould ? phi.value <= 0. :
                                                       phi.value >= 0.) ?
                                         Tensor<1, dim>() :
                                         -phi.value * phi.gradient;
                              });
        return places;
      }
      void
      check(const Preview<dim> &scene) const override
      {
        for (const Obstacle &obstacle : list)
          {
            // The integral up to the end finds a velocity that has no value at
            // some time, before any work is done.
            obstacle.way(scene.keys.time.end_time);
            const auto [depth, place] = deepest<dim>(
              {&obstacle.body, obstacle.is_mould, Tensor<1, dim>(), 0.},
              scene.boundary_points);
            // What a thin body holds could be pulled out on its other side.
            if (obstacle.bit != 0 &&
                obstacle.thickness < scene.keys.grid.spacing)
              throw InputError(
                "Obstacles/" + obstacle.name + "/Two-sided",
                "true",
                "false, or an obstacle that is at least a grid spacing thick",
                "Both of its sides would act on the surface: "
                "make it thicker, or Grid/Spacing smaller.");
            // The surface may begin a little inside, and the contact pushes it
            // out in the first step. Half a spacing leaves room below the whole
            // one that term() refuses.
            if (depth <= 0.5 * scene.keys.grid.spacing)
              continue;
            std::ostringstream text;
            text << "It is " << depth << " um deep in the obstacle at ("
                 << place
                 << ") um: move the obstacle or the tissue, or correct Side.";
            throw InputError("Obstacles/Names",
                             obstacle.name,
                             "an obstacle that the surface of the tissue is at "
                             "most half a grid spacing deep in at t = 0",
                             text.str());
          }
      }
      void
      review(const Preview<dim> &scene, Review &review) const override
      {
        for (const Obstacle &obstacle : list)
          {
            // Only boundary points feel an obstacle, so cells may stand in one
            // that is wholly inside of the tissue.
            const typename ObstacleContact<dim>::Obstacle at_start{
              &obstacle.body, obstacle.is_mould, Tensor<1, dim>(), 0.};
            unsigned int n_cells = 0, n_points = 0;
            for (const Point<dim> &X : scene.founders)
              n_cells += at_start.depth(X) > 0.;
            for (const Point<dim> &X : scene.boundary_points)
              n_points += at_start.depth(X) > 0.;
            n_cells  = Utilities::MPI::sum(n_cells, scene.comm);
            n_points = Utilities::MPI::sum(n_points, scene.comm);
            if (n_cells > 0 && n_points == 0)
              review.warn(
                "Obstacles/Names",
                obstacle.name,
                std::to_string(n_cells) +
                  " cells lie in it, but no boundary point: inside the tissue "
                  "it has no effect.",
                "Make a hole in the tissue around it, or move it.");
          }
      }

    private:
      struct Obstacle
      {
        std::string name;
        bool        is_mould;
        Body<dim>   body;
        double      stiffness; // κ h / E
        Expression  velocity;  // µm/day
        /** The least thickness of the body, µm; infinite if it has none. */
        double thickness;
        /** The number that points have which it holds; 0: one-sided. */
        unsigned int bit;

        /** The way of the body from t = 0 to @p t, µm. */
        Tensor<1, dim>
        way(const double t) const
        {
          // The velocity depends on the time alone, so its integral is the same
          // after a resumed start. A constant one needs no quadrature. Else the
          // 15 points of Gauss and Kronrod serve each component, with intervals
          // that are halved up to 12 times until the error is below 1e-10.
          const Point<dim> nowhere;
          if (velocity.is_constant())
            return t * velocity.vector(nowhere, t);
          Tensor<1, dim> result;
          for (unsigned int d = 0; d < dim && t > 0.; ++d)
            result[d] =
              boost::math::quadrature::gauss_kronrod<double, 15>::integrate(
                [&](const double s) { return velocity.value(nowhere, s, d); },
                0.,
                t,
                12,
                1e-10);
          return result;
        }

        /** The obstacle at @p t (day) against these points. */
        typename ObstacleContact<dim>::Obstacle
        at(const double t, const LoadedPoints<dim> &points) const
        {
          return {&body,
                  is_mould,
                  way(t),
                  stiffness * points.youngs_modulus / points.h,
                  bit};
        }
      };

      std::vector<Obstacle> list;
    };
  } // namespace


  void
  add_obstacles(Catalogue &catalogue)
  {
    catalogue.add_own<Obstacles>(
      "obstacles",
      {"Growth/Law=isotropic",
       "Growth/Isotropic/Stretch=1 + 0.1*t*(1 + 0.1*X*Y)",
       "Obstacles/Names=mould",
       "Obstacles/mould/Shape=sphere",
       "Obstacles/mould/Side=inside",
       "Obstacles/mould/Radius=3.01"});
  }
} // namespace Morula
