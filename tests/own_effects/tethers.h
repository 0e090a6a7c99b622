// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// An interaction: springs without length draw faces of bodies together. Points
// that face each other have one, which holds on for as long as they are near.

#ifndef own_effects_tethers_h
#define own_effects_tethers_h

#include <morula/effects/contact/contact_pairs.h>
#include <morula/effects/interaction.h>
#include <morula/mechanics/spline_field.h>

namespace Own
{
  using namespace Morula;

  struct TetherKeys : public EffectKeys
  {
    Key<double> stiffness{{this, "Stiffness"},
                          0.,
                          "k of a spring over the areas at its ends; 0: there "
                          "are none. Units: kPa/um^dim.",
                          {0.}};
    Key<double> reach{{this, "Reach"},
                      10.,
                      "Length of the longest. Units: um.",
                      {0.}};

    bool
    is_on() const override
    {
      return stiffness > 0.;
    }

    EffectFacts
    facts() const override
    {
      return {nullptr, /* needs_surface */ true};
    }
  };

  /** The springs of an attempt: the energy is k a_b a_c |x_b - x_c|²/2 each. */
  template <int dim>
  class TethersInStep : public InteractionInStep<dim>, public PairTerm
  {
  public:
    TethersInStep(const AttemptAtStep<dim> &attempt,
                  const ContactPoints<dim> &points,
                  const TetherKeys         &keys)
      : attempt(attempt)
      , points(points.points())
      , of_points(points)
    {
      for (const auto &[b, c] : points.pairs())
        {
          const ContactPoint<dim> &one = this->points[b],
                                  &two = this->points[c];
          if (one.x.distance(two.x) > keys.reach || one.area * two.area >= 0.)
            continue;
          Spring                    spring{b,
                        c,
                        keys.stiffness * one.area.norm() * two.area.norm(),
                                           {}};
          std::vector<unsigned int> unknowns = one.unknowns;
          unknowns.insert(unknowns.end(),
                          two.unknowns.begin(),
                          two.unknowns.end());
          spring.weights = one.values;
          for (const double value : two.values)
            spring.weights.push_back(-value);
          links_.push_back({unknowns, unknowns});
          springs.push_back(spring);
        }
    }

    PairTerm &
    pairs() override
    {
      return *this;
    }

    void
    begin(MomentumBalance<dim> &of_step, const Equilibrium::Vector &) override
    {
      balance = &of_step;
    }

    void
    take_drag(Morula::Drag<dim> &of_step, const bool is_weak) override
    {
      if (is_weak)
        drag = &of_step;
    }

    /** The weak drag holds back a little of what moves from its centre: two
     *  more turns leave nothing of it. */
    bool
    renew(const Equilibrium::Vector &u) override
    {
      if (drag == nullptr || ++turns > 2)
        return false;
      drag->set_centre(DisplacementField<dim>(attempt.space, u, attempt.comm)
                         .values_at(attempt.tissue.cells()));
      return true;
    }

    std::string
    unfinished() const override
    {
      return "";
    }

    std::vector<ForceBetween<dim>>
    forces(const Equilibrium::Vector &u) const override
    {
      const std::vector<double>      values = balance->relevant_values(u);
      std::vector<ForceBetween<dim>> list;
      const auto                     add = [&](const unsigned int    b,
                           const unsigned int    c,
                           const Tensor<1, dim> &force) {
        list.push_back({b,
                        points[b].body,
                        points[c].body,
                        force,
                        -force * points[b].area / points[b].area.norm(),
                        points[b].x});
      };
      for (std::size_t k = 0; k < springs.size(); ++k)
        {
          const Tensor<1, dim> force = -springs[k].k * way(k, values);
          add(springs[k].b, springs[k].c, force);
          add(springs[k].c, springs[k].b, -force);
        }
      return contact_forces(of_points, list, attempt.comm);
    }

    const std::vector<UnknownLink> &
    links() const override
    {
      return links_;
    }

    void
    add_residual(const std::vector<double> &u, Sums &sums) const override
    {
      for (std::size_t k = 0; k < springs.size(); ++k)
        {
          const Tensor<1, dim> d      = way(k, u);
          const double         energy = 0.5 * springs[k].k * d.norm_square();
          sums.energy += energy;
          sums.energy_magnitude += energy;
          for (std::size_t s = 0; s < springs[k].weights.size(); ++s)
            for (unsigned int i = 0; i < dim; ++i)
              {
                const double part = springs[k].k * springs[k].weights[s] * d[i];
                sums.residual[links_[k].rows[s] * dim + i] += part;
                if (sums.magnitudes != nullptr)
                  (*sums.magnitudes)[links_[k].rows[s] * dim + i] +=
                    std::abs(part);
              }
        }
    }

    void
    add_tangent(
      const std::vector<double> &,
      const std::function<void(unsigned int, const std::vector<double> &)> &add)
      const override
    {
      for (std::size_t k = 0; k < springs.size(); ++k)
        {
          const std::vector<double> &w = springs[k].weights;
          const std::size_t          m = w.size();
          std::vector<double>        matrix(m * dim * m * dim, 0.);
          for (unsigned int i = 0; i < dim; ++i)
            for (std::size_t s = 0; s < m; ++s)
              for (std::size_t q = 0; q < m; ++q)
                matrix[(i * m + s) * m * dim + i * m + q] =
                  springs[k].k * w[s] * w[q];
          add(k, matrix);
        }
    }

  private:
    struct Spring
    {
      unsigned int        b, c;
      double              k;       // kPa µm^(dim-2)
      std::vector<double> weights; // of the link's unknowns in u_b - u_c
    };

    /** x_b - x_c of a spring, µm. */
    Tensor<1, dim>
    way(const std::size_t k, const std::vector<double> &u) const
    {
      const Spring  &spring = springs[k];
      Tensor<1, dim> d      = points[spring.b].x - points[spring.c].x;
      for (std::size_t s = 0; s < spring.weights.size(); ++s)
        for (unsigned int i = 0; i < dim; ++i)
          d[i] += spring.weights[s] * u[links_[k].rows[s] * dim + i];
      return d;
    }

    const AttemptAtStep<dim>             &attempt;
    const std::vector<ContactPoint<dim>> &points;
    const ContactPoints<dim>             &of_points;
    std::vector<Spring>                   springs;
    std::vector<UnknownLink>              links_;
    MomentumBalance<dim>                 *balance = nullptr;
    Morula::Drag<dim>                    *drag    = nullptr;
    unsigned int                          turns   = 0;
  };

  template <int dim>
  class TetheredPoints : public Encounters<dim>
  {
  public:
    TetheredPoints(const TetherKeys  &keys,
                   const Tissue<dim> &tissue,
                   SplineSpace<dim>  &space)
      : keys(keys)
      , points(tissue, space, keys.reach)
    {}

    bool
    any() const override
    {
      return points.any();
    }

    std::unique_ptr<InteractionInStep<dim>>
    part_of_step(const AttemptAtStep<dim> &attempt) const override
    {
      return std::make_unique<TethersInStep<dim>>(attempt, points, keys);
    }

  private:
    const TetherKeys        &keys;
    const ContactPoints<dim> points;
  };

  template <int dim>
  class Tethers : public Interaction<dim>
  {
  public:
    using Parameters = TetherKeys;

    explicit Tethers(const Parameters &keys)
      : keys(keys)
    {}

    bool
    takes_types_as_bodies() const override
    {
      return true;
    }

    std::unique_ptr<const Encounters<dim>>
    encounters(const Tissue<dim> &tissue,
               SplineSpace<dim>  &space) const override
    {
      return std::make_unique<TetheredPoints<dim>>(keys, tissue, space);
    }

  private:
    const TetherKeys keys;
  };
} // namespace Own

#endif
