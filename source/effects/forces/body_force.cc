// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/body_force.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/loads.h>
#include <morula/mechanics/point_term.h>

namespace Morula
{
  namespace
  {
    /** Difference of places by which b is differentiated, in grid spacings. */
    constexpr double part_of_spacing = 1e-5;

    constexpr Variable coordinates[] = {Variable::x, Variable::y, Variable::z};

    /**
     * Forces on particles that depend on where these are at the end of the
     * step, V⁰ b(x + u): doc/theory.md (4.7b). It has no energy. Its tangent
     * -V⁰ ∂b/∂x N_a N_b comes from differences of b.
     */
    template <int dim>
    class PlacedForce : public PointTerm<dim>
    {
    public:
      /** A particle. */
      struct Particle
      {
        /** Position at the beginning of the step, µm. */
        Point<dim> x;
        /** V⁰, µm^dim. */
        double volume;
        /** Of the other variables of b. */
        VariableValues values;
      };

      /** @param density b, kPa/µm; a reference is kept */
      PlacedForce(GroupedPoints<dim>    points,
                  std::vector<Particle> particles,
                  const Expression     &density)
        : PointTerm<dim>(std::move(points))
        , particles(std::move(particles))
        , density(density)
      {}

      bool
      is_conservative() const override
      {
        return false;
      }

      /** Whether an expression depends on the present place. */
      static bool
      depends_on_place(const Expression &expression)
      {
        for (const Variable place : coordinates)
          if (expression.uses(place))
            return true;
        return false;
      }

    private:
      void
      add_point(const unsigned int       p,
                const SplineValues<dim> &splines,
                const LocalField<dim>   &field,
                LocalSystem<dim>        &system) const override
      {
        const Particle  &particle = particles[p];
        const Point<dim> x        = particle.x + field.value(splines);
        Tensor<1, dim>   force;
        Tensor<2, dim>   stiffness;
        if (system.wanted != LocalSystem<dim>::tangent)
          force = -particle.volume * density_at(particle, x);
        else
          for (unsigned int j = 0; j < dim; ++j)
            {
              const double delta = part_of_spacing * this->points.h;
              Point<dim>   before(x), behind(x);
              before[j] -= delta;
              behind[j] += delta;
              const Tensor<1, dim> change =
                -particle.volume / (2. * delta) *
                (density_at(particle, behind) - density_at(particle, before));
              for (unsigned int i = 0; i < dim; ++i)
                stiffness[i][j] = change[i];
            }
        add_force_at(splines, 0., force, stiffness, system);
      }

      /** b of a particle at a place, kPa/µm. */
      Tensor<1, dim>
      density_at(const Particle &particle, const Point<dim> &x) const
      {
        VariableValues values = particle.values;
        for (unsigned int d = 0; d < dim; ++d)
          values[static_cast<unsigned int>(coordinates[d])] = x[d];
        Tensor<1, dim> b;
        for (unsigned int d = 0; d < dim; ++d)
          b[d] = density.value(values, d);
        return b;
      }

      const std::vector<Particle> particles;
      const Expression           &density;
    };

    /** A force per initial volume: doc/theory.md (4.7), equation (4) of the
     *  paper. It may depend on the state of cells at the beginning of a step,
     * and on their place at its end. */
    template <int dim>
    class BodyForce : public Force<dim>
    {
    public:
      using Parameters = BodyForceParameters;

      /** @throws InputError for an expression that cannot be parsed */
      BodyForce(const Parameters &parameters, const EffectSetting<dim> &setting)
        : density(setting.state.use(parameters.force_density))
      {}

      std::unique_ptr<Term<dim>>
      term(const Tissue<dim>        &tissue,
           const CellReader<dim>    &reader,
           const GroupedPoints<dim> &positions,
           const double,
           const double t1) const override
      {
        // The force on cell p is V⁰ b, doc/theory.md (4.7). The state of the
        // cell is that of the beginning of the step, but the time is that of
        // its end, as the equilibrium is sought there. A force that depends on
        // the place acts where the cell comes to stand; all others are dead
        // loads.
        const Cells<dim> &cells = tissue.cells();
        if (PlacedForce<dim>::depends_on_place(density))
          {
            std::vector<typename PlacedForce<dim>::Particle> particles;
            for (unsigned int p = 0; p < cells.size(); ++p)
              particles.push_back(
                {cells.position(p),
                 cells.initial_volume(p),
                 present_cell(tissue, p, reader).variables(density, t1)});
            return std::make_unique<PlacedForce<dim>>(positions,
                                                      std::move(particles),
                                                      density);
          }
        std::vector<Tensor<1, dim>> forces;
        for (unsigned int p = 0; p < cells.size(); ++p)
          forces.push_back(cells.initial_volume(p) *
                           present_cell(tissue, p, reader).vector(density, t1));
        return std::make_unique<DeadLoad<dim>>(positions, std::move(forces));
      }

      std::optional<Tensor<1, dim>>
      load_of(const PresentCell<dim> &cell, const double t) const override
      {
        return cell.vector(density, t);
      }

      void
      check(const Preview<dim> &scene) const override
      {
        // An expression of the cells' state has no value before there are
        // cells; it is tried at each founder.
        if (density.depends_on_state())
          return;
        for (const Point<dim> &X : scene.founders)
          // An expression of place and time has a value at both ends of the
          // run, or throws here.
          for (const double t : {0., scene.keys.time.end_time.value()})
            density.vector(X, t);
      }

      void
      review(const Preview<dim> &scene, Review &review) const override
      {
        const std::vector<Variable> &used = density.used();
        const bool                   lags =
          std::any_of(used.begin(), used.end(), [](const auto v) {
            return is_field(v) ||
                   (v >= Variable::volume && v <= Variable::energy);
          });
        if (lags)
          review.warn(
            density.key(),
            density.text(),
            "a force reads the state of its cell, except its place, at "
            "the beginning of each step: it is late by Time/Step = " +
              as_text(scene.keys.time.step) +
              " day, and may oscillate where it changes that state much in a step.",
            "Repeat the run with half the step, and compare.");
      }

    private:
      const Expression density;
    };
  } // namespace


  void
  add_body_force(Catalogue &catalogue)
  {
    catalogue.add_own<BodyForce>(
      "body force",
      {"Boundary conditions/Fixed where=X + Y < -2",
       "Body force/Force density=0.01*x; 0.01*y; 0"});
  }
} // namespace Morula
