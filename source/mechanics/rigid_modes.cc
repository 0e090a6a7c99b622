// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/spline_field.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

namespace Morula
{
  namespace
  {
    /** Support weaker than this, relative to the strongest, is none. */
    constexpr double support_tolerance = 1e-9;

    /** Rotations that move the particles less than this, relative to
     *  translations, have no inertia: those of a single particle, or about the
     *  line through all, which they leave by what the solver leaves. */
    constexpr double inertia_tolerance = 1e-5;

    template <int dim>
    Tensor<2, dim>
    identity()
    {
      return Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

    /** Appends what of @p vector is orthogonal to @p basis, at unit length;
     *  false if that is not longer than @p least. */
    bool
    add_orthonormal(Equilibrium::Vector               vector,
                    std::vector<Equilibrium::Vector> &basis,
                    const double                      least = 0.)
    {
      for (unsigned int i = 0; i < 2; ++i) // once more, for the rounding
        for (const Equilibrium::Vector &other : basis)
          vector.add(-(vector * other), other);
      const double length = vector.l2_norm();
      if (!(length > least))
        return false;
      vector /= length;
      basis.push_back(std::move(vector));
      return true;
    }

    /** The grid cell with tissue of a piece around @p x. */
    template <int dim>
    const typename SplineSpace<dim>::GridCell &
    grid_cell_at(const SplineSpace<dim> &space,
                 const Point<dim>       &x,
                 const unsigned int      piece)
    {
      const unsigned int number = space.box().number(space.box().locate(x));
      auto               found  = std::lower_bound(space.grid_cells().begin(),
                                    space.grid_cells().end(),
                                    number,
                                    [](const auto &c, const unsigned int n) {
                                      return c.number < n;
                                    });
      // The grid cell stands there once for each of its parts.
      while (space.piece(number, found->part) != piece)
        ++found;
      return *found;
    }

    /** Σ V⁰ N_a and Σ V⁰ N_a (x - center) of particles in one grid cell: what
     *  their forces of inertia need, whatever the motion. */
    template <int dim>
    class FirstMoments
    {
    public:
      using Masses = std::vector<typename RigidModes<dim>::Mass>;

      /** Takes the particles from @p mass on that follow each other in this
       *  grid cell and belong to this piece; @p mass is the next one then. */
      FirstMoments(const SplineSpace<dim>                &space,
                   const unsigned int                     grid_cell,
                   const unsigned int                     piece,
                   const Point<dim>                      &center,
                   typename Masses::const_iterator       &mass,
                   const typename Masses::const_iterator &end)
      {
        // Masses come sorted by grid cell, so one grid cell's are neighbours.
        // The motion of a rigid mode is linear in x: two sums by spline serve
        // all modes.
        for (; mass != end; ++mass)
          {
            const GridIndex<dim> index = space.box().locate(mass->x);
            if (space.box().number(index) != grid_cell || mass->piece != piece)
              return;
            const Tensor<1, dim>    z = mass->x - center;
            const SplineValues<dim> splines(space.box().unit_position(mass->x,
                                                                      index),
                                            space.box().spacing());
            for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
              {
                const double V0 = mass->V0 * splines.value[a];
                volume[a] += V0;
                for (unsigned int d = 0; d < dim; ++d)
                  first[d][a] += V0 * z[d];
              }
          }
      }

      /** Σ V⁰ N_a (a + B (x - center)), component after component. */
      std::array<double, Condensation<dim>::n_dofs>
      forces(const typename RigidModes<dim>::Mode &mode) const
      {
        constexpr unsigned int                        n = BSpline<dim>::n;
        std::array<double, Condensation<dim>::n_dofs> result;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < n; ++a)
            {
              result[i * n + a] = mode.a[i] * volume[a];
              for (unsigned int d = 0; d < dim; ++d)
                result[i * n + a] += mode.B[i][d] * first[d][a];
            }
        return result;
      }

    private:
      std::array<double, BSpline<dim>::n>                  volume{};
      std::array<std::array<double, BSpline<dim>::n>, dim> first{};
    };

    /** A basis of the motions that next to nothing of S holds, doc/theory.md
     *  (4.9). @param S   row by row, n_modes² numbers
     *  @param length as in elementary_mode(), µm */
    template <int dim>
    std::vector<typename FreeMotions<dim>::Mode>
    free_motions(const double *S, const double length)
    {
      // The eigenvectors with next to no eigenvalue are motions that nothing
      // holds; they are combined from the elementary ones. The largest diagonal
      // entry is the scale of S: a piece without supports has 0 here, and keeps
      // all its motions.
      constexpr int            n = FreeMotions<dim>::n_modes;
      LAPACKFullMatrix<double> stiffness(n);
      double                   largest = 0.;
      for (unsigned int k = 0; k < n; ++k)
        {
          for (unsigned int l = 0; l < n; ++l)
            stiffness(k, l) = S[k * n + l];
          largest = std::max(largest, stiffness(k, k));
        }
      Vector<double>     eigenvalues;
      FullMatrix<double> eigenvectors;
      // LAPACK finds eigenvalues within bounds only. S is semidefinite, so the
      // lower bound is far below all; 1e-300 keeps 0 inside where S vanishes.
      stiffness.compute_eigenvalues_symmetric(-1. - largest,
                                              support_tolerance * largest +
                                                1e-300,
                                              0.,
                                              eigenvalues,
                                              eigenvectors);
      std::vector<typename FreeMotions<dim>::Mode> free;
      for (unsigned int v = 0; v < eigenvalues.size(); ++v)
        {
          free.emplace_back();
          for (unsigned int k = 0; k < n; ++k)
            {
              const auto part = FreeMotions<dim>::elementary_mode(k, length);
              free.back().a += eigenvectors(k, v) * part.a;
              free.back().B += eigenvectors(k, v) * part.B;
            }
        }
      return free;
    }
  } // namespace

  template <int dim>
  Tensor<2, dim>
  RigidModes<dim>::rotation(const Tensor<2, dim> &B)
  {
    // Cayley's transform is a rotation to rounding for any skew B, unlike I +
    // B.
    return invert(identity<dim>() - 0.5 * B) * (identity<dim>() + 0.5 * B);
  }

  template <int dim>
  FreeMotions<dim>::FreeMotions(const unsigned int          n_pieces,
                                const double                length,
                                const std::vector<Mass>    &masses,
                                const std::vector<Support> &supports,
                                const MPI_Comm              comm,
                                const bool                  as_one)
    : as_one(as_one)
    , pieces(as_one ? 1 : n_pieces)
  {
    // First come sums of V⁰ and V⁰ x by piece. Every rank has all pieces, as
    // pieces may run through several ranks.
    std::vector<double> sums(pieces.size() * (dim + 1), 0.);
    for (const Mass &mass : masses)
      {
        double *const sum = &sums[entry(mass.piece) * (dim + 1)];
        sum[dim] += mass.V0;
        for (unsigned int d = 0; d < dim; ++d)
          sum[d] += mass.V0 * mass.x[d];
      }
    Utilities::MPI::sum(sums, comm, sums);
    for (unsigned int p = 0; p < pieces.size(); ++p)
      {
        pieces[p].volume = sums[p * (dim + 1) + dim];
        // A piece may be without particles where only boundary points make grid
        // cells active. It keeps the origin as its center.
        if (pieces[p].volume > 0.)
          for (unsigned int d = 0; d < dim; ++d)
            pieces[p].center[d] = sums[p * (dim + 1) + d] / pieces[p].volume;
      }

    // Then the matrix S of doc/theory.md (4.9) is summed over this rank's
    // supports, for all pieces at once, and one reduction adds up all ranks'.
    // So every rank finds the same free motions of all pieces. The length makes
    // translations and rotations comparable in S.
    constexpr int n = n_modes;
    sums.assign(pieces.size() * n * n, 0.);
    for (const Support &support : supports)
      {
        const unsigned int   p = entry(support.piece);
        const Tensor<1, dim> z = support.x - pieces[p].center;
        // The part of each elementary motion that this support holds.
        Tensor<1, dim> held[n];
        for (unsigned int k = 0; k < n; ++k)
          {
            const Mode mode = elementary_mode(k, length);
            held[k]         = support.projection * (mode.a + mode.B * z);
          }
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int l = 0; l < n; ++l)
            sums[(p * n + k) * n + l] += support.area * (held[k] * held[l]);
      }
    Utilities::MPI::sum(sums, comm, sums);
    for (unsigned int p = 0; p < pieces.size(); ++p)
      pieces[p].free = free_motions<dim>(&sums[p * n * n], length);
  }


  template <int dim>
  std::vector<Equilibrium::Vector>
  RigidModes<dim>::null_space() const
  {
    // Projects out motions as coefficient vectors. The origin of a + B x is
    // moved from the piece's center to that of the coordinates.
    const FieldUnknowns<dim>         unknowns(space, comm);
    std::vector<Equilibrium::Vector> basis;
    for (unsigned int p = 0; p < pieces.size(); ++p)
      for (const Mode &mode : pieces[p].free)
        add_orthonormal(unknowns.vector(affine_displacement(
                          space,
                          p,
                          mode.a - mode.B * (pieces[p].center - Point<dim>()),
                          mode.B)),
                        basis);
    return basis;
  }

  template <int dim>
  std::vector<Equilibrium::Vector>
  RigidModes<dim>::inertia(const std::vector<Mass> &masses) const
  {
    // The loop over the particles goes grid cell by grid cell, as they are
    // sorted so, and sums V⁰ N_a m(x) for all free motions of the piece,
    // condensed to its unknowns: w of doc/theory.md (4.10). The sums of ranks
    // are added up, and made orthonormal, afterwards. All ranks have the same
    // motions in the same order, so that the collective calls agree.
    std::vector<unsigned int> first(1, 0); // vector of each piece
    for (const Piece &piece : pieces)
      first.push_back(first.back() + piece.free.size());
    const FieldUnknowns<dim>         unknowns(space, comm);
    std::vector<std::vector<double>> sums(
      first.back(), std::vector<double>(unknowns.relevant().n_elements(), 0.));
    for (auto mass = masses.begin(); mass != masses.end();)
      {
        const unsigned int piece = mass->piece, p = entry(piece);
        const auto        &grid_cell = grid_cell_at(space, mass->x, piece);
        // The constructor advances `mass` to the next grid cell.
        const FirstMoments<dim> moments(
          space, grid_cell.number, piece, pieces[p].center, mass, masses.end());
        const Condensation<dim> condensation(grid_cell);
        const unsigned int      m = condensation.m();
        for (unsigned int k = 0; k < pieces[p].free.size(); ++k)
          {
            const std::vector<double> condensed =
              condensation.condense(moments.forces(pieces[p].free[k]));
            for (unsigned int s = 0; s < m; ++s)
              for (unsigned int i = 0; i < dim; ++i)
                sums[first[p] + k][grid_cell.unknowns[s] * dim + i] +=
                  condensed[i * m + s];
          }
      }

    std::vector<Equilibrium::Vector> motions, basis;
    if (!as_one)
      motions = null_space();
    for (unsigned int p = 0; p < pieces.size(); ++p)
      for (unsigned int k = first[p]; k < first[p + 1]; ++k)
        // A rotation without inertia (of a single particle, or of a row about
        // its line) would leave a vector of rounding errors. It keeps its
        // coefficient vector, as the motion still has to stay out of the
        // solution. Several pieces have inertia.
        if (!add_orthonormal(unknowns.sum(sums[k]),
                             basis,
                             inertia_tolerance * pieces[p].volume) &&
            !as_one)
          add_orthonormal(motions[k], basis);
    return basis;
  }

  template class FreeMotions<2>;
  template class FreeMotions<3>;
  template class RigidModes<2>;
  template class RigidModes<3>;
} // namespace Morula
