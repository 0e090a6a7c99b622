// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/volumes_of_step.h>
#include <morula/mechanics/elastic_point.h>
#include <morula/mechanics/plain_kernels.h>
#include <morula/mechanics/point_term.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The gap at which the penalty has doubled, g₀ in (4.6a), in grid
     *  spacings. A penalty that rises with the gap does not let squeezed tissue
     *  slip through a clamp that is soft at its edge. */
    constexpr double stiffening_gap = 0.2;

    /** See bounded_nitsche(). */
    template <int dim>
    class BoundedNitsche : public PointTerm<dim>
    {
    public:
      using HeldPoint = typename Nitsche<dim>::HeldPoint;

      BoundedNitsche(GroupedPoints<dim>                 points,
                     std::vector<HeldPoint>             held_points,
                     const std::vector<Tensor<1, dim>> &tractions)
        : PointTerm<dim>(std::move(points))
        , held_points(std::move(held_points))
        , tractions(tractions)
      {}

    private:
      void
      add_point(const unsigned int       p,
                const SplineValues<dim> &splines,
                const LocalField<dim>   &field,
                LocalSystem<dim>        &system) const override
      {
        // These are energy, force and stiffness of doc/theory.md (4.6a) and
        // (4.6d). The deformation of the point does not enter, so there is
        // nothing to be inverted. Of the penalty, c is what the energy has
        // beyond that of β alone, and more what the force has. At a gap of 0
        // the stiffness along the gap has no value.
        const HeldPoint      &held = held_points[p];
        const double          a_t = held.area, beta = held.penalty;
        const Tensor<1, dim>  gap = held.gap_with(field, splines);
        const Tensor<1, dim> &T   = tractions[p];
        system.note_gap(gap.norm(), this->points.xi[p]);
        const double r      = gap.norm() / (stiffening_gap * this->points.h);
        const bool   is_far = r > 1.;
        const double more   = is_far ? 5. - 4. / r : std::pow(r, 4);
        const double c = is_far ? 5. - 8. / r + 10. / (3. * r * r) : more / 3.;
        Tensor<2, dim> stiffness = (1. + more) * held.projection;
        if (more > 0.)
          stiffness += 4. * (is_far ? 1. / r : more) / gap.norm_square() *
                       outer_product(gap, gap);
        add_force_at(splines,
                     a_t *
                       (0.5 * beta * (1. + c) * gap.norm_square() - T * gap),
                     a_t * (beta * (1. + more) * gap - T),
                     a_t * beta * stiffness,
                     system);
        // The gap is the difference of two positions, whose rounding counts.
        if (system.wanted == LocalSystem<dim>::rounding)
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
              system.magnitude[i * BSpline<dim>::n + a] +=
                a_t * beta * held.position_scale * splines.value[a];
      }

      const std::vector<HeldPoint>       held_points;
      const std::vector<Tensor<1, dim>> &tractions;
    };

    /** The largest change of the traction, relative to it, that needs no
     * further turn. The second limit is in units of Solver/Newton tolerance, so
     * that a user who asks for more accuracy gets it. */
    constexpr double largest_change = 0.01, largest_in_tolerances = 1e4;

    /** The largest part of the traction that a turn may change, if it may not
     *  change all: where a load jumps, the stress of squeezed cells at the edge
     * of a clamp tells far too much of the traction that will be needed. */
    constexpr double largest_step = 0.3;

    /** Where a load jumps, cells at a clamp may be squeezed in this very step:
     *  the penalty then counts on this times their stiffness at t. */
    constexpr double stiffening_of_jump = 10.;

    /** After so many turns a change that is larger than this part of the one
     *  before shows that the traction does not settle: at 0.8 a turn
     *  the fourteen turns that are left of a step's twenty would leave a
     *  twentieth of it. */
    constexpr unsigned int patient_turns = 6;
    constexpr double       settling      = 0.8;

    /** Tractions below this count as that, in units of Young's modulus: they
     *  move held points by less than a millionth of a grid spacing. */
    constexpr double least_traction = 1e-4;

    /** W / V_t of a cell. */
    template <int dim>
    double
    energy_volume(const AttemptAtStep<dim>          &attempt,
                  const CellView<dim, const double> &cell,
                  const Tensor<2, dim>              &F_g)
    {
      return (attempt.material.per_grown_volume() ? determinant(F_g) : 1.) /
             determinant(cell.F());
    }


    /**
     * The traction T of this rank's fixed and slip points from the stress of
     * the cells around them, doc/theory.md (4.6b), and the stiffness of these
     * cells, which the points' term needs as well. T is constant while an
     * equilibrium is found, and is taken anew from it. Turns go on until T
     * changes by less than one per cent (or ten thousand times Solver/Newton
     * tolerance, if that is less). Where T is changed in parts it need not
     * settle: then tissue is crushed at an edge, and stays as far from where it
     * is held as the last T lets it. The step's check of gaps judges that. The
     * object keeps references to all that it is given.
     */
    template <int dim>
    class HeldTraction : public PartOfStep<dim>
    {
    public:
      /** The traction is zero until begin() sets it. Collective. */
      HeldTraction(const BoundaryConditions<dim> &conditions,
                   const AttemptAtStep<dim>      &attempt)
        : conditions(conditions)
        , attempt(attempt)
        , tissue(attempt.tissue)
        , points(held_groups(tissue, attempt.space).points)
        , surroundings(tissue.boundary_points().positions_of(points),
                       tissue,
                       tissue.boundary_points().sides_of(points))
        , asked(surroundings.asked_here())
        // This comes last, as an expression may have no value on one rank.
        , held(points_of_term(conditions,
                              attempt.material,
                              tissue,
                              attempt.space,
                              attempt.growth,
                              attempt.t_next))
        , T(points.size())
      {}

      /** Nitsche's term with the traction, to which it keeps a reference. */
      std::unique_ptr<Term<dim>>
      term() override
      {
        const TimerOutput::Scope section(attempt.timer, "nitsche");
        everywhere(attempt.comm, [&]() {
          const std::vector<double> k = stiffnesses();
          for (std::size_t i = 0; i < k.size(); ++i)
            held.list[i].penalty =
              conditions.nitsche().beta(held.youngs_moduli[i],
                                        held.list[i].lame,
                                        k[i],
                                        attempt.material.volumetric_form(),
                                        attempt.space.box().spacing());
        });
        return std::make_unique<BoundedNitsche<dim>>(
          grouped_places(tissue.boundary_points(), attempt.space, held.groups),
          held.list,
          T);
      }

      /** Sets the traction with which a step begins: that of the increment @p u
       *  of its start, µm, with the growth at t + dt. Tissue that cannot move
       * has it at the end. Collective. */
      void
      begin(MomentumBalance<dim> &, const Equilibrium::Vector &u) override
      {
        T = tractions_of(u);
      }

      bool
      renew(const Equilibrium::Vector &u) override
      {
        // The change is a mean over the held area of all ranks, so that all
        // decide alike. Three outcomes end the turns or go on: the traction has
        // settled; it does not settle although it was changed in parts; or it
        // is taken over, as a whole or in part, for the next turn
        // (doc/theory.md, section 4.2).
        const std::vector<Tensor<1, dim>> now = tractions_of(u);
        double sums[3] = {0., 0., 0.}; // of changes, tractions and areas
        for (std::size_t k = 0; k < held.list.size(); ++k)
          {
            sums[0] += held.list[k].area * (now[k] - T[k]).norm_square();
            sums[1] += held.list[k].area * now[k].norm_square();
            sums[2] += held.list[k].area;
          }
        double totals[3];
        Utilities::MPI::sum(sums, tissue.communicator(), totals);
        // Held points whose cells are all gone have no traction.
        if (totals[2] == 0.)
          return false;
        const double least  = least_traction * attempt.typical_stiffness;
        const double before = change;
        change =
          std::sqrt(totals[0] / std::max(totals[1], totals[2] * least * least));
        if (change <= settled())
          return false;
        // The traction need not settle where it is changed in parts. The forces
        // are balanced all the same, with a gap that the step's check of gaps
        // judges.
        if (attempt.jumps && ++n_turns >= patient_turns &&
            change > settling * before)
          return false;
        // The values are changed in place, as the term keeps a reference to the
        // list.
        const double part =
          attempt.jumps ? std::min(1., largest_step / change) : 1.;
        for (std::size_t k = 0; k < held.list.size(); ++k)
          T[k] += part * (now[k] - T[k]);
        return true;
      }

      bool
      renews_early() const override
      {
        // At the least penalty a turn leaves a twentieth of the error, so that
        // after a small change only the end of the turn says whether the next
        // one counts.
        return !attempt.jumps &&
               (change == 0. ||
                change > NitscheParameters::least_penalty * settled());
      }

      std::string
      unfinished() const override
      {
        std::ostringstream text;
        text << "the traction of the fixed surface does not converge: it still "
                "changes by "
             << change << " of itself";
        return text.str();
      }

    private:
      /** The largest change that needs no further turn. */
      double
      settled() const
      {
        return std::min(largest_change,
                        largest_in_tolerances * attempt.newton_tolerance);
      }

      /** The tractions of the state after an increment u, with the growth at
       *  t + dt. */
      std::vector<Tensor<1, dim>>
      tractions_of(const Equilibrium::Vector &u) const
      {
        // This computes doc/theory.md (4.6b): the stress of each cell after the
        // increment u, as a nominal stress per area of the configuration at t,
        // is averaged around each held point by moving least squares and
        // multiplied by its normal. The motions of this rank's cells are found
        // first, many at once by the kernel. surroundings.values() then sends
        // stresses to the ranks that have held points nearby. Collective.
        const TimerOutput::Scope     section(attempt.timer, "nitsche");
        const DisplacementField<dim> displacement(attempt.space,
                                                  u,
                                                  tissue.communicator());
        // Where volumes are pooled, they make the pressure. The vector is empty
        // otherwise.
        const auto                          volumes = volumes_of_step(tissue,
                                             attempt.space,
                                             attempt.growth,
                                             attempt.material,
                                             attempt.kernel,
                                             displacement,
                                             &attempt.points);
        const std::vector<PointMotion<dim>> motions =
          point_motions(tissue.cells(),
                        displacement,
                        motion_kernel<dim>(attempt.material.material(),
                                           attempt.kernel),
                        &asked);
        // The values are (W / V_t) τ f⁻ᵀ of the cells, with the growth at t +
        // dt.
        const auto P = surroundings.values([&](const unsigned int p) {
          const auto           cell = tissue.cells()[p];
          const Tensor<2, dim> F_g  = attempt.growth.growth_after(tissue, p);
          const auto motion = std::lower_bound(asked.begin(), asked.end(), p);
          const Tensor<2, dim> &f   = motions[motion - asked.begin()].f;
          const Tensor<2, dim>  F_e = f * cell.F() * invert(F_g);
          const double          theta =
            std::log(volumes.empty() ? determinant(F_e) : volumes[p].J_e);
          const ElasticPoint<dim> point(
            F_e,
            attempt.growth.lame_of(tissue, p, attempt.material),
            attempt.material.material(),
            &theta);
          return Tensor<2, dim>(energy_volume(attempt, cell, F_g) *
                                Tensor<2, dim>(point.kirchhoff_stress()) *
                                transpose(invert(f)));
        });
        std::vector<Tensor<1, dim>> list;
        for (std::size_t k = 0; k < held.list.size(); ++k)
          list.push_back(
            held.list[k].traction_fraction *
            (held.list[k].projection * (P[k] * held.list[k].normal)));
        return list;
      }
      /** Stiffnesses of a stretch along the normals with the growth at t, kPa,
       * by held_groups(): k in doc/theory.md (4.6); ten times as much where the
       *  traction is changed in parts. Collective. */
      std::vector<double>
      stiffnesses() const
      {
        // This is the k of doc/theory.md (4.6). The tensor K of each cell is
        // averaged first, so that k = n·K n for any normal n. For laws with a C
        // that is not exact but an upper bound, which only makes the penalty
        // larger. The growth is that at t, as F is.
        const auto          K = surroundings.values([&](const unsigned int p) {
          const auto              cell = tissue.cells()[p];
          const Tensor<2, dim>    F_g = attempt.growth.growth_before(tissue, p);
          const ElasticPoint<dim> point(
            cell.F() * invert(F_g),
            attempt.growth.lame_of(tissue, p, attempt.material),
            attempt.material.material());
          const auto          &r = point.response();
          const Tensor<2, dim> b(point.b()), I(unit_symmetric_tensor<dim>());
          return Tensor<2, dim>(energy_volume(attempt, cell, F_g) *
                                ((r.total_A() + r.alpha - r.total_gamma()) * I +
                                 (r.alpha + 2. * r.B) * b + r.C * (b * b)));
        });
        std::vector<double> list;
        for (std::size_t k = 0; k < held.list.size(); ++k)
          list.push_back((attempt.jumps ? stiffening_of_jump : 1.) *
                         (held.list[k].normal * (K[k] * held.list[k].normal)));
        return list;
      }

      // All lists have the order of held_groups(): this rank's held points by
      // active grid cell. Normals and areas are those at t, as the terms
      // integrate over that configuration. Points away from the cells lose
      // their traction (4.13).
      const BoundaryConditions<dim>  &conditions;
      const AttemptAtStep<dim>       &attempt;
      const Tissue<dim>              &tissue;
      const std::vector<unsigned int> points;
      const Surroundings<dim>         surroundings;
      const std::vector<unsigned int> asked; // cells of this rank
      HeldPoints<dim>                 held;
      std::vector<Tensor<1, dim>>     T;
      double                          change = 0.; // relative, by the last turn
      unsigned int                    n_turns = 0;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<Term<dim>>
  bounded_nitsche(GroupedPoints<dim>                            points,
                  std::vector<typename Nitsche<dim>::HeldPoint> held_points,
                  const std::vector<Tensor<1, dim>>            &tractions)
  {
    return std::make_unique<BoundedNitsche<dim>>(std::move(points),
                                                 std::move(held_points),
                                                 tractions);
  }


  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  held_traction(const BoundaryConditions<dim> &conditions,
                const AttemptAtStep<dim>      &attempt)
  {
    return std::make_unique<HeldTraction<dim>>(conditions, attempt);
  }


  MORULA_INSTANTIATE(bounded_nitsche);
  MORULA_INSTANTIATE(held_traction);

} // namespace Morula
