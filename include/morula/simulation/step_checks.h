// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_step_checks_h
#define morula_simulation_step_checks_h

#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/spline_field.h>
#include <morula/particles/point_store.h>
#include <morula/particles/tissue.h>

#include <string>
#include <vector>

namespace Morula
{
  /** Whether det f ≤ 0 at any point of any rank: the displacement turns the
   *  point's neighbourhood inside out. Collective. */
  template <int dim>
  bool
  inverts(const DisplacementField<dim> &displacement,
          const PointStore<dim>        &store,
          const MPI_Comm                comm);

  /**
   * Refuses a step in which the tissue slips through its clamp: a held point is
   * more than @p largest_gap grid spacings @p h (µm) from where it is held.
   * With 0 any gap is allowed.
   * @throws StepFailed
   */
  template <int dim>
  void
  check_gap(const Extreme<dim> &gap, const double largest_gap, const double h);

  /**
   * A message if the tissue does not fit on the grid any more, otherwise empty.
   * If some points move very far from the others, the tables over all grid
   * cells between them, many more than in the present @p box, would fill the
   * memory. Positions in µm. Collective.
   */
  template <int dim>
  std::string
  torn_tissue_message(const std::vector<Point<dim>> &cells,
                      const std::vector<Point<dim>> &boundary_points,
                      const GridBox<dim>            &box,
                      const MPI_Comm                 comm);

  /** The narrowest neck of the tissue: its width and the coordinates of its
   *  middle, µm; an infinite width if there is none. Collective. */
  template <int dim>
  std::vector<double>
  narrowest_neck(const Tissue<dim> &tissue);

  /** Whether a strand of tissue turns so far in a step, by 36°, that its
   *  surface may have passed through one which it did not face at t; or by this
   *  @p part of it. Collective. */
  template <int dim>
  bool
  turns_too_far(const Tissue<dim>            &tissue,
                const SplineSpace<dim>       &space,
                const DisplacementField<dim> &displacement,
                const double                  part = 1.);

  /** Refuses a step in which contact of folds does not see what meets.
   *  Collective. @throws StepFailed */
  template <int dim>
  void
  check_turn(const Tissue<dim>            &tissue,
             const SplineSpace<dim>       &space,
             const DisplacementField<dim> &displacement);

  /** What is known of a step that no attempt has solved. */
  struct FailedStep
  {
    /** The unbalanced force |R| with which the first and the last attempt
     * began, kPa µm^(dim-1), and the length of the last attempt over that of
     * the first. */
    double first_force = 0., last_force = 0., part = 1.;
    /** Energy where the last attempt has ended, kPa µm^dim. */
    double energy = 0.;
    /** The smallest J_e of cells and held points where the last attempt has
     *  ended. */
    double smallest_J = 1.;
    /** The most negative curvature that was met, p·Kp / p·|diag K|p. It is 0 if
     *  there was none. */
    double curvature = 0.;

    /** Whether points are held by Nitsche's symmetric form. */
    bool symmetric = false;
    /** Whether surface loads or forces act. */
    bool loaded = false;
    /** A coefficient of friction with which a fold would take this step,
     *  kPa day/µm². */
    double friction = 0.;
  };

  /**
   * Says what the failure of a step is, and what helps, in whole sentences:
   * something jumps in time; a held point is crushed; the tissue folds. Empty
   * if it is none of them. Not collective.
   */
  std::string
  diagnosis(const FailedStep &step);

  /** The friction (kPa day/µm²) that outweighs the @p curvature (relative to
   * the diagonal, < 0) of tissue of stiffness @p E (kPa) on a grid of spacing
   * @p h (µm) in a step of @p dt (day): doc/theory.md (5.8). */
  double
  friction_against(const double curvature,
                   const double E,
                   const double h,
                   const double dt);
} // namespace Morula

#endif
