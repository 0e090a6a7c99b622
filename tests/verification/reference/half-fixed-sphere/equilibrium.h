// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef half_fixed_sphere_equilibrium_h
#define half_fixed_sphere_equilibrium_h

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <half-fixed-sphere/meridian_values.h>
#include <half-fixed-sphere/parameters.h>

#include <array>

namespace HalfFixedSphere
{
  /** The continuation in theta has failed. */
  struct NoConvergence : public std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };


  /**
   * The displacement (u_r, u_z) of a grown axisymmetric body at rest: a local
   * minimum of the energy  Int Psi(F / theta) 2 pi r dr dz.
   */
  class Equilibrium
  {
  public:
    Equilibrium(const Triangulation<2> &mesh, const Parameters &parameters);

    /** Moves on to the growth stretch @p target, in as many increments as it
     * takes. Prints the Newton iterations. */
    void
    grow_to(const double target);

    /**
     * How far the residual is from central differences of the energy, and the
     * tangent from those of the residual: relative errors of derivatives in a
     * random direction, for the present displacement and a growth of
     * 1.05 theta, where forces do not vanish.
     */
    std::array<double, 2>
    derivative_errors();

    double
    growth_stretch() const
    {
      return theta;
    }

    /** Newton iterations so far, those of rejected increments included. */
    unsigned int
    n_iterations() const
    {
      return iterations;
    }

    const Parameters     parameters;
    const double         lambda, mu; // kPa
    const FESystem<2>    element;
    const MappingQ<2>    mapping;
    const QuadraturePair quadratures;
    DoFHandler<2>        dofs;
    Vector<double>       displacement; // um

  private:
    void
    make_constraints();

    /** nN um; infinity where the material is turned inside out. */
    double
    energy(const Vector<double> &u, const double theta) const;

    /** Residual at growth @p theta, tangent at growth @p tangent_theta. */
    void
    assemble(const Vector<double> &u,
             const double          theta,
             const double          tangent_theta);

    /** Newton's method from the present state; false if it does not
     * converge, the state is then as before. */
    bool
    newton(const double new_theta);

    /** Makes @p step a direction of descent and returns by what factor it is
     * to be taken; 0 if there is none. */
    double
    find_step(const Vector<double> &u,
              const double          theta,
              Vector<double>       &step);

    double
    line_search(const Vector<double> &u,
                const Vector<double> &step,
                const double          theta) const;

    AffineConstraints<double> constraints;
    SparsityPattern           sparsity;
    SparseMatrix<double>      tangent, tangent_at_rest;
    Vector<double>            residual; // nN
    double                    theta      = 1.;
    double                    shift      = 0.;
    double                    increment  = 0.1;
    unsigned int              iterations = 0;
  };
} // namespace HalfFixedSphere

#endif
