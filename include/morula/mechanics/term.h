// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_term_h
#define morula_mechanics_term_h

#include <morula/grid/bspline.h>

#include <deal.II/base/tensor.h>

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace Morula
{
  /**
   * Which growth a linearisation is taken at. The residual always has the
   * growth at t + dt; the first tangent of a step is taken at the growth at t:
   * doc/theory.md (5.1).
   */
  enum class GrowthAt
  {
    previous, // t
    current   // t + dt
  };

  /** Coefficients of the displacement on one grid cell, µm, by component. */
  template <int dim>
  struct LocalField
  {
    static constexpr unsigned int n = BSpline<dim>::n;

    double coefficient[dim][n];

    /** The displacement where the splines have these values, µm. */
    Tensor<1, dim>
    value(const SplineValues<dim> &splines) const
    {
      Tensor<1, dim> u;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          u[i] += coefficient[i][a] * splines.value[a];
      return u;
    }

    /** I + ∇u: the deformation gradient of the step. */
    Tensor<2, dim>
    step_deformation(const SplineValues<dim> &splines) const
    {
      Tensor<2, dim> f;
      for (unsigned int i = 0; i < dim; ++i)
        {
          for (unsigned int j = 0; j < dim; ++j)
            for (unsigned int a = 0; a < n; ++a)
              f[i][j] += coefficient[i][a] * splines.gradient[j][a];
          f[i][i] += 1.;
        }
      return f;
    }
  };

  /** The mean ϑ of ln J_e over a grid cell's points and its derivative, where
   *  a tangent was taken: doc/theory.md (2.7). */
  template <int dim>
  struct VolumeLinearisation
  {
    LocalField<dim> field;
    LocalField<dim> derivative; // 1/µm
    double          value;

    /** The linearised ϑ at the coefficients @p other. */
    double
    at(const LocalField<dim> &other) const
    {
      double theta = value;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          theta += derivative.coefficient[i][a] *
                   (other.coefficient[i][a] - field.coefficient[i][a]);
      return theta;
    }
  };

  /**
   * Energy, residual and tangent of one grid cell. Component i of spline a is
   * row i n + a. Energies in kPa µm^dim, forces in kPa µm^(dim-1).
   */
  template <int dim>
  struct LocalSystem
  {
    static constexpr unsigned int n      = BSpline<dim>::n;
    static constexpr unsigned int n_dofs = dim * n;

    enum Wanted
    {
      energy_and_residual,
      rounding, // the same, and the magnitudes of the contributions
      tangent
    };

    explicit LocalSystem(const Wanted wanted)
      : wanted(wanted)
      , matrix(wanted == tangent ? n_dofs * n_dofs : 0)
    {
      clear();
    }

    /** Everything to zero. */
    void
    clear()
    {
      residual.fill(0.);
      magnitude.fill(0.);
      std::fill(matrix.begin(), matrix.end(), 0.);
      energy = energy_magnitude = 0.;
      smallest_J                = {std::numeric_limits<double>::infinity(), {}};
      largest_gap               = {-1., {}};
      linearisation.reset();
    }

    /** @param magnitude of what @p e is a sum of, for its rounding error */
    void
    add_energy(const double e, const double magnitude)
    {
      energy += e;
      energy_magnitude += magnitude;
    }

    void
    add_energy(const double e)
    {
      add_energy(e, std::abs(e));
    }

    /**
     * Takes the volume ratios of the step and of the elastic part at a point at
     * @p xi in the grid cell into account.
     * @return false where the body is inverted: there is no energy
     */
    bool
    admits(const double det_f, const double J_e, const Point<dim> &xi)
    {
      const double J = det_f > 0. ? J_e : std::min(det_f, J_e);
      if (J < smallest_J.value)
        smallest_J = {J, xi};
      inverted = inverted || !(J > 0.);
      return J > 0.;
    }

    /** Takes the gap of a held point into account, µm. */
    void
    note_gap(const double gap, const Point<dim> &xi)
    {
      if (gap > largest_gap.value)
        largest_gap = {gap, xi};
    }

    /** Adds to a residual entry. */
    void
    add_force(const unsigned int i, const unsigned int a, const double force)
    {
      residual[i * n + a] += force;
      magnitude[i * n + a] += std::abs(force);
    }

    const Wanted               wanted;
    double                     energy           = 0.;
    double                     energy_magnitude = 0.; // Σ|contributions|
    std::array<double, n_dofs> residual;
    std::array<double, n_dofs> magnitude; // Σ|contributions|
    std::vector<double>        matrix;    // row by row

    /** In: that of the last tangent of the step on this grid cell, if any. */
    const VolumeLinearisation<dim> *last = nullptr;
    /** Out: that of this tangent, if a term has one. */
    std::optional<VolumeLinearisation<dim>> linearisation;

    /** Set where det f <= 0 or J_e <= 0: there is no energy. */
    bool inverted = false;

    /** A value and the place in the grid cell where it is extreme. */
    struct Extreme
    {
      double     value;
      Point<dim> xi;
    };
    Extreme smallest_J;  // J_e; det f where that is not positive
    Extreme largest_gap; // µm; negative: nothing is held here
  };

  /**
   * A term of the momentum balance. Only the terms that a scene calls for
   * exist. A term knows its points by active grid cell (their order in
   * SplineSpace::cells()); it never sees the simulation.
   */
  template <int dim>
  class Term
  {
  public:
    virtual ~Term() = default;

    /**
     * Adds what @p system wants of this term on one active grid cell.
     * @param grid_cell   active grid cell
     * @param field  displacement since the beginning of the step
     * @param growth which growth to use
     */
    virtual void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const = 0;

    /** Whether the term has an energy, i.e., a symmetric tangent. */
    virtual bool
    is_conservative() const
    {
      return true;
    }
  };
} // namespace Morula

#endif
