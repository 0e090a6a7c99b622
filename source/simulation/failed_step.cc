// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/failed_step.h>

#include <sstream>

namespace Morula
{
  namespace
  {
    /** Half a step begins with half the force where the force comes from the
     *  step. With more than this, something does not come from it. */
    constexpr double part_that_stays = 0.8;

    /** Cells that are neither squeezed nor stretched beyond these do not make a
     *  step fail by themselves. */
    constexpr double healthy_J = 0.3;

    /** Largest over smallest J_e of the cells where volumes of cells that share
     *  a grid cell no longer match. */
    constexpr double mismatch = 3.;

    /** A held point with a smaller J_e is crushed. */
    constexpr double crushed_J = 0.01;

    std::string
    of_jump(const FailedStep &step)
    {
      std::ostringstream text;
      text << " A step of " << step.part << " times the length begins with "
           << step.last_force / step.first_force
           << " times the unbalanced force: a load, stiffness, growth or "
              "displacement jumps in time, or the last state is about to fold. "
              "Let what jumps rise over some steps, as ramp(t, t0, t1) does; "
              "after a jump there may be more than one equilibrium.";
      return text.str();
    }

    std::string
    of_fold(const FailedStep &step)
    {
      std::ostringstream text;
      text << " The tissue folds or buckles: along some motion it has no "
              "stiffness left. A Friction/Coefficient of about "
           << step.friction
           << " kPa day/um^2 lets the fold take a step; compare with a third "
              "and three times of it, as friction decides which fold is found "
              "(doc/modelling.md, Folds). A finer grid may help, too.";
      return text.str();
    }
  } // namespace


  // The surest sign comes first (doc/theory.md, section 5.10): a negative
  // energy of an unloaded body has one cause, while a fold is what is left when
  // all other causes are out. A jump shows only when the step was halved twice
  // (part below 0.3), since only then it is clear that the force does not fall
  // with the length.
  std::string
  diagnosis(const FailedStep &step)
  {
    if (step.symmetric && step.smallest_J < crushed_J && step.energy < 0. &&
        !step.loaded)
      return " A held point is crushed there: the symmetric Nitsche form has no "
             "least energy. Set Boundary conditions/Nitsche form = bounded.";
    if (step.pointwise && step.max_J > mismatch * step.min_J)
      {
        std::ostringstream text;
        text << " Before the step J_e is " << step.min_J << " to " << step.max_J
             << ": the volumes of cells that share a grid cell do not match. "
                "Set Material/Volumetric strain = pooled.";
        return text.str();
      }
    if (step.part < 0.3 && step.last_force > part_that_stays * step.first_force)
      return of_jump(step);
    if (step.smallest_J < healthy_J)
      return "";
    if (step.unsymmetric)
      return " The unsymmetric Nitsche form has no energy and sees no "
             "curvature, so that it does not find the way to a fold. Set "
             "Boundary conditions/Nitsche form = bounded.";
    return step.curvature < 0. ? of_fold(step) : "";
  }


  std::string
  path_message(const double t)
  {
    std::ostringstream text;
    text << "At t = " << t
         << " day Newton's method alone did not find the equilibrium, but a "
            "proximal path did: the tissue folds there, or something jumps in "
            "time. There may be more than one equilibrium: compare with "
            "another Friction/Coefficient, or let what jumps rise over some "
            "steps. Column proximal_paths of statistics.csv counts such steps.";
    return text.str();
  }


  std::string
  turn_message(const double t)
  {
    std::ostringstream text;
    text << "Warning: at t = " << t
         << " day a strand of tissue turns by more than 36 degrees within a "
            "step. It may pass through itself there, as surfaces without "
            "contact do not see each other: look at the surface. "
            "Contact/Between = all keeps folds apart.";
    return text.str();
  }


  double
  friction_against(const double curvature,
                   const double E,
                   const double h,
                   const double dt)
  {
    // This is doc/theory.md (5.8).
    return -curvature * E * dt / (h * h);
  }
} // namespace Morula
