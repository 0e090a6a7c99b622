// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_held_traction_h
#define morula_effects_surface_held_traction_h

#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/particles/nearest.h>

#include <string>
#include <vector>

namespace Morula
{
  /**
   * The traction T of this rank's fixed and slip points from the stress of the
   * cells around them, doc/theory.md (4.6b), and the stiffness of these cells,
   * which the points' term needs as well. T is constant while an equilibrium is
   * found, and is taken anew from it. Turns go on until T changes by less than
   * one per cent (or ten thousand times Solver/Newton tolerance, if that is
   * less). Where T is changed in parts it need not settle: then tissue is
   * crushed at an edge, and stays as far from where it is held as the last T
   * lets it. The step's check of gaps judges that. The object keeps references
   * to all that it is given.
   */
  template <int dim>
  class HeldTraction : public PartOfStep<dim>
  {
  public:
    /** The traction is zero until begin() sets it. Collective. */
    HeldTraction(const BoundaryConditions<dim> &conditions,
                 const AttemptAtStep<dim>      &attempt);

    /** Nitsche's term with the traction, to which it keeps a reference. */
    std::unique_ptr<Term<dim>>
    term() override;

    /** Sets the traction with which a step begins: that of the increment @p u
     *  of its start, µm, with the growth at t + dt. Tissue that cannot move has
     *  it at the end. Collective. */
    void
    begin(MomentumBalance<dim> &balance, const Equilibrium::Vector &u) override;

    bool
    renew(const Equilibrium::Vector &u) override;

    std::string
    unfinished() const override;

  private:
    /** A held point. */
    struct Held
    {
      Tensor<2, dim> projection; // M
      Tensor<1, dim> normal;     // n_t
      double         area;       // a_t, µm^(dim-1)
      double         fraction;   // of the traction that counts
    };

    /** The tractions of the state after an increment u, with the growth at
     *  t + dt. */
    std::vector<Tensor<1, dim>>
    tractions_of(const Equilibrium::Vector &u) const;
    /** Stiffnesses of a stretch along the normals with the growth at t, kPa, by
     *  held_groups(): k in doc/theory.md (4.6); ten times as much where the
     *  traction is changed in parts. Collective. */
    std::vector<double>
    stiffnesses() const;

    const BoundaryConditions<dim>  &conditions;
    const AttemptAtStep<dim>       &attempt;
    const Tissue<dim>              &tissue;
    const std::vector<unsigned int> points; // held ones, as held_groups()
    std::vector<Held>               held;
    const Surroundings<dim>         surroundings;
    std::vector<Tensor<1, dim>>     T;
    double                          change  = 0.; // relative, by the last turn
    unsigned int                    n_turns = 0;
  };
} // namespace Morula

#endif
