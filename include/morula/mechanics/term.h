// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_term_h
#define morula_mechanics_term_h

#include <morula/grid/bspline.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace Morula
{
  /**
   * Coefficients of a field on one grid cell, by component. Without a number of
   * components it is the displacement, µm.
   */
  template <int dim, int n_components = dim>
  struct LocalField
  {
    static constexpr unsigned int n = BSpline<dim>::n;

    double coefficient[n_components][n];

    /** The field where the splines have these values. */
    Tensor<1, n_components>
    value(const SplineValues<dim> &splines) const
    {
      Tensor<1, n_components> u;
      for (unsigned int i = 0; i < n_components; ++i)
        for (unsigned int a = 0; a < n; ++a)
          u[i] += coefficient[i][a] * splines.value[a];
      return u;
    }

    /** The gradient of each component, per µm. */
    std::array<Tensor<1, dim>, n_components>
    gradients(const SplineValues<dim> &splines) const
    {
      std::array<Tensor<1, dim>, n_components> result;
      for (unsigned int i = 0; i < n_components; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          for (unsigned int a = 0; a < n; ++a)
            result[i][j] += coefficient[i][a] * splines.gradient[j][a];
      return result;
    }

    /** I + ∇u: the deformation gradient of the step. */
    Tensor<2, dim>
    step_deformation(const SplineValues<dim> &splines) const
    {
      static_assert(n_components == dim, "This is no displacement.");
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

  /**
   * Energy, residual and tangent of one grid cell, for a field of n components.
   * Component i of spline a is row i 3^dim + a.
   */
  template <int dim, int n_components>
  struct LocalEquations
  {
    static constexpr unsigned int n      = BSpline<dim>::n;
    static constexpr unsigned int n_dofs = n_components * n;

    enum Wanted
    {
      energy_and_residual,
      rounding, // the same, and the magnitudes of the contributions
      tangent
    };

    explicit LocalEquations(const Wanted wanted)
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
    }

    /** @param magnitude sum of the magnitudes of the parts of @p e, for its
     *         rounding error */
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
  };

  /** ϑ of a pool and its derivative, where a tangent was taken: doc/theory.md
   *  (2.6). */
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

  /** A value, and the place where it is extreme. */
  template <int dim>
  struct Extreme
  {
    double     value;
    Point<dim> place;
  };

  /**
   * The equations of the displacement on one grid cell, and the extremes of the
   * tissue there, with their places in it. Energies in kPa µm^dim, forces in
   * kPa µm^(dim-1).
   */
  template <int dim>
  struct LocalSystem : public LocalEquations<dim, dim>
  {
    using LocalEquations<dim, dim>::LocalEquations;

    /** Everything to zero; `inverted`, `last` and `in_single` stay. */
    void
    clear()
    {
      LocalEquations<dim, dim>::clear();
      smallest_J  = {std::numeric_limits<double>::infinity(), {}};
      largest_gap = {-1., {}};
      linearisations.clear();
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

    /** In: the linearisations of the last tangent of the step on this grid
     * cell, one for each of its pools, if there was one. */
    const std::vector<VolumeLinearisation<dim>> *last = nullptr;
    /** Out: those of this tangent, if a term has any. */
    std::vector<VolumeLinearisation<dim>> linearisations;

    /** In: whether single precision is enough for the tangent. */
    bool in_single = false;

    /** Set where det f <= 0 or J_e <= 0: there is no energy. */
    bool inverted = false;

    /** J_e; det f where that is not positive. */
    Extreme<dim> smallest_J = {std::numeric_limits<double>::infinity(), {}};
    /** µm; negative: nothing is held here. */
    Extreme<dim> largest_gap = {-1., {}};
  };

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

  /**
   * A term of the momentum balance. Only the terms that a scene calls for
   * exist. A term knows its points by active grid cell (their order in
   * SplineSpace::grid_cells()); it never sees the simulation.
   */
  template <int dim>
  class Term
  {
  public:
    virtual ~Term() = default;

    /**
     * Adds what @p system asks for on one active grid cell. All results go to
     * @p system: a term remembers nothing.
     * @param grid_cell active grid cell
     * @param field     displacement since the beginning of the step
     * @param growth    which growth to use
     * @param system    of this grid cell; the terms add up in it
     */
    virtual void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const = 0;

    /**
     * The force of each of its points on the tissue, on one active grid cell
     * and in their order, kPa µm^(dim-1). Nothing of a term that is no sum over
     * points of its own.
     */
    virtual std::vector<Tensor<1, dim>>
    forces(const unsigned int, const LocalField<dim> &) const
    {
      return {};
    }

    /** Whether the term has an energy, i.e., a symmetric tangent. */
    virtual bool
    is_conservative() const
    {
      return true;
    }
  };

  /** Relevant unknowns in whose rows a matrix has entries for those of the
   *  columns. */
  struct UnknownLink
  {
    std::vector<unsigned int> rows, columns;

    bool
    operator==(const UnknownLink &other) const
    {
      return rows == other.rows && columns == other.columns;
    }
  };

  /**
   * A term of the momentum balance that couples places in different grid cells,
   * whose splines need not have anything in common. It knows the displacement
   * by its values at the relevant unknowns of this rank
   * (FieldUnknowns::fetch(), µm): component i of unknown s is number s dim + i.
   */
  class PairTerm
  {
  public:
    virtual ~PairTerm() = default;

    /** What a pair term adds to on this rank. */
    struct Sums
    {
      std::vector<double> &residual; // at the relevant unknowns
      std::vector<double> *magnitudes       = nullptr; // likewise, if wanted
      double               energy           = 0.;
      double               energy_magnitude = 0.;
    };

    /** The links of the term: each couples the unknowns of its rows with those
     *  of its columns. */
    virtual const std::vector<UnknownLink> &
    links() const = 0;

    /** Adds energy and residual at @p u. */
    virtual void
    add_residual(const std::vector<double> &u, Sums &sums) const = 0;

    /** Calls @p add with the number of each link and its part of the tangent at
     *  @p u, row by row: row i m + s is component i of the s-th of the link's m
     *  rows, and columns likewise. */
    virtual void
    add_tangent(
      const std::vector<double>                                            &u,
      const std::function<void(unsigned int, const std::vector<double> &)> &add)
      const = 0;
  };
} // namespace Morula

#endif
