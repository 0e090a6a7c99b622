// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/condensation.h>
#include <morula/mechanics/rigid_modes.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Support weaker than this, relative to the strongest, is none. */
    constexpr double support_tolerance = 1e-9;

    /** Rotations that move the particles less than this, relative to
     *  translations, are left alone: those of a single particle, or about the
     *  line through all. */
    constexpr double inertia_tolerance = 1e-9;

    template <int dim>
    Tensor<2, dim>
    identity()
    {
      return Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

    /** Σ B_ij M_ji = Σ V⁰ (B z)·u for M = Σ V⁰ z⊗u. */
    template <int dim>
    double
    moment(const Tensor<2, dim> &B, const Tensor<2, dim> &M)
    {
      return trace(B * M);
    }

    /** A rotation about the axis of the skew @p B: Cayley's transform. */
    template <int dim>
    Tensor<2, dim>
    rotation(const Tensor<2, dim> &B)
    {
      return invert(identity<dim>() - 0.5 * B) * (identity<dim>() + 0.5 * B);
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
  } // namespace

  template <int dim>
  typename RigidModes<dim>::Mode
  RigidModes<dim>::elementary_mode(const unsigned int k, const double length)
  {
    Mode mode;
    if (k < dim)
      mode.a[k] = 1.;
    else
      {
        const unsigned int i = (k - dim) % dim, j = (i + 1) % dim;
        mode.B[i][j] = 1. / length;
        mode.B[j][i] = -1. / length;
      }
    return mode;
  }

  template <int dim>
  RigidModes<dim>::RigidModes(const SplineSpace<dim>     &space,
                              const std::vector<Mass>    &masses,
                              const std::vector<Support> &supports,
                              const MPI_Comm              comm)
    : space(space)
    , comm(comm)
    , pieces(space.n_pieces())
  {
    find_centers(masses);
    find_free_modes(supports);
  }

  template <int dim>
  void
  RigidModes<dim>::find_centers(const std::vector<Mass> &masses)
  {
    std::vector<double> sums(pieces.size() * (dim + 1), 0.);
    for (const Mass &mass : masses)
      {
        double *const sum = &sums[mass.piece * (dim + 1)];
        sum[dim] += mass.V0;
        for (unsigned int d = 0; d < dim; ++d)
          sum[d] += mass.V0 * mass.x[d];
      }
    Utilities::MPI::sum(sums, comm, sums);
    for (unsigned int p = 0; p < pieces.size(); ++p)
      {
        pieces[p].volume = sums[p * (dim + 1) + dim];
        if (pieces[p].volume > 0.)
          for (unsigned int d = 0; d < dim; ++d)
            pieces[p].center[d] = sums[p * (dim + 1) + d] / pieces[p].volume;
      }
  }

  template <int dim>
  void
  RigidModes<dim>::find_free_modes(const std::vector<Support> &supports)
  {
    const double        length = space.box().spacing();
    constexpr int       n      = n_modes;
    std::vector<double> sums(pieces.size() * n * n, 0.);
    for (const Support &support : supports)
      {
        const Tensor<1, dim> z = support.x - pieces[support.piece].center;
        Tensor<1, dim>       held[n];
        for (unsigned int k = 0; k < n; ++k)
          {
            const Mode mode = elementary_mode(k, length);
            held[k]         = support.projection * (mode.a + mode.B * z);
          }
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int l = 0; l < n; ++l)
            sums[(support.piece * n + k) * n + l] +=
              support.area * (held[k] * held[l]);
      }
    Utilities::MPI::sum(sums, comm, sums);

    for (unsigned int p = 0; p < pieces.size(); ++p)
      {
        LAPACKFullMatrix<double> stiffness(n);
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int l = 0; l < n; ++l)
            stiffness(k, l) = sums[(p * n + k) * n + l];
        double largest = 0.;
        for (unsigned int k = 0; k < n; ++k)
          largest = std::max(largest, stiffness(k, k));
        Vector<double>     eigenvalues;
        FullMatrix<double> eigenvectors;
        stiffness.compute_eigenvalues_symmetric(-1. - largest,
                                                support_tolerance * largest +
                                                  1e-300,
                                                0.,
                                                eigenvalues,
                                                eigenvectors);
        for (unsigned int v = 0; v < eigenvalues.size(); ++v)
          {
            Mode mode;
            for (unsigned int k = 0; k < n; ++k)
              {
                const Mode part = elementary_mode(k, length);
                mode.a += eigenvectors(k, v) * part.a;
                mode.B += eigenvectors(k, v) * part.B;
              }
            pieces[p].free.push_back(mode);
          }
      }
  }

  template <int dim>
  bool
  RigidModes<dim>::any() const
  {
    return std::any_of(pieces.begin(), pieces.end(), [](const Piece &piece) {
      return !piece.free.empty();
    });
  }

  template <int dim>
  std::vector<Equilibrium::Vector>
  RigidModes<dim>::null_space() const
  {
    std::vector<Equilibrium::Vector> basis;
    for (unsigned int p = 0; p < pieces.size(); ++p)
      for (const Mode &mode : pieces[p].free)
        {
          const std::vector<double> coefficients = space.affine_coefficients(
            p, mode.a - mode.B * (pieces[p].center - Point<dim>()), mode.B);
          Equilibrium::Vector vector(space.owned_dofs(), comm);
          std::copy(coefficients.begin(), coefficients.end(), vector.begin());
          vector.compress(VectorOperation::insert);
          add_orthonormal(std::move(vector), basis);
        }
    return basis;
  }

  template <int dim>
  std::vector<Equilibrium::Vector>
  RigidModes<dim>::inertia(const std::vector<Mass> &masses) const
  {
    std::vector<unsigned int> first(1, 0); // vector of each piece
    for (const Piece &piece : pieces)
      first.push_back(first.back() + piece.free.size());
    std::vector<std::vector<double>> sums(
      first.back(),
      std::vector<double>(space.relevant_dofs().n_elements(), 0.));
    const auto &cells = space.cells();
    for (const Mass &mass : masses)
      {
        const Piece &piece = pieces[mass.piece];
        if (piece.free.empty())
          continue;
        const GridIndex<dim> index = space.box().locate(mass.x);
        const auto           cell =
          std::lower_bound(cells.begin(),
                           cells.end(),
                           space.box().number(index),
                           [](const auto &c, const unsigned int number) {
                             return c.number < number;
                           });
        const SplineValues<dim> splines(space.box().unit_position(mass.x,
                                                                  index),
                                        space.box().spacing());
        const Condensation<dim> condensation(*cell);
        for (unsigned int k = 0; k < piece.free.size(); ++k)
          {
            const Mode          &mode = piece.free[k];
            const Tensor<1, dim> force =
              mass.V0 * (mode.a + mode.B * (mass.x - piece.center));
            std::array<double, LocalSystem<dim>::n_dofs> forces;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
                forces[i * BSpline<dim>::n + a] = force[i] * splines.value[a];
            const std::vector<double> condensed = condensation.condense(forces);
            const unsigned int        m         = cell->unknowns.size();
            for (unsigned int s = 0; s < m; ++s)
              for (unsigned int i = 0; i < dim; ++i)
                sums[first[mass.piece] + k][cell->unknowns[s] * dim + i] +=
                  condensed[i * m + s];
          }
      }

    const std::vector<types::global_dof_index> dofs(
      space.relevant_dofs().begin(), space.relevant_dofs().end());
    const std::vector<Equilibrium::Vector> motions = null_space();
    std::vector<Equilibrium::Vector>       basis;
    for (unsigned int p = 0; p < pieces.size(); ++p)
      for (unsigned int k = first[p]; k < first[p + 1]; ++k)
        {
          Equilibrium::Vector sum, vector(space.owned_dofs(), comm);
          sum.reinit(space.owned_dofs(), space.relevant_dofs(), comm, true);
          sum.add(dofs, sums[k]);
          sum.compress(VectorOperation::add);
          vector = sum;
          // Rotations of a single particle have no inertia.
          if (!add_orthonormal(std::move(vector),
                               basis,
                               inertia_tolerance * pieces[p].volume))
            add_orthonormal(motions[k], basis);
        }
    return basis;
  }

  template <int dim>
  void
  RigidModes<dim>::superpose(const unsigned int    piece,
                             const Tensor<2, dim> &Q,
                             const Tensor<1, dim> &a,
                             std::vector<double>  &u) const
  {
    const std::vector<double> affine =
      space.affine_coefficients(piece, a, Q - identity<dim>());
    for (unsigned int s = 0; s < space.pieces_of_unknowns().size(); ++s)
      if (space.pieces_of_unknowns()[s] == piece)
        {
          Tensor<1, dim> old;
          for (unsigned int d = 0; d < dim; ++d)
            old[d] = u[s * dim + d];
          const Tensor<1, dim> turned = Q * old;
          for (unsigned int d = 0; d < dim; ++d)
            u[s * dim + d] = turned[d] + affine[s * dim + d];
        }
  }

  template <int dim>
  void
  RigidModes<dim>::remove(const std::vector<Mass>           &masses,
                          const std::vector<Tensor<1, dim>> &displacements,
                          Equilibrium::Vector               &u) const
  {
    // Moments about the center, z = x - center: U = Σ V⁰ u, M = Σ V⁰ z⊗u,
    // S = Σ V⁰ z⊗z.
    constexpr unsigned int width = dim + 2 * dim * dim;
    std::vector<double>    sums(pieces.size() * width, 0.);
    for (std::size_t i = 0; i < masses.size(); ++i)
      {
        double *const        sum = &sums[masses[i].piece * width];
        const Tensor<1, dim> z   = masses[i].x - pieces[masses[i].piece].center;
        for (unsigned int d = 0; d < dim; ++d)
          {
            sum[d] += masses[i].V0 * displacements[i][d];
            for (unsigned int e = 0; e < dim; ++e)
              {
                sum[dim + d * dim + e] +=
                  masses[i].V0 * z[d] * displacements[i][e];
                sum[dim + dim * dim + d * dim + e] +=
                  masses[i].V0 * z[d] * z[e];
              }
          }
      }
    Utilities::MPI::sum(sums, comm, sums);

    std::vector<double> coefficients(u.begin(), u.end());
    for (unsigned int p = 0; p < pieces.size(); ++p)
      {
        const Piece &piece = pieces[p];
        if (piece.free.empty() || piece.volume == 0.)
          continue;
        Tensor<1, dim> U;
        Tensor<2, dim> M, S;
        for (unsigned int d = 0; d < dim; ++d)
          {
            U[d] = sums[p * width + d];
            for (unsigned int e = 0; e < dim; ++e)
              {
                M[d][e] = sums[p * width + dim + d * dim + e];
                S[d][e] = sums[p * width + dim + dim * dim + d * dim + e];
              }
          }

        // Newton's method for the rigid motion y -> Q (y - center) + shift +
        // center that makes Σ V⁰ m·u vanish for all free m.
        Tensor<2, dim>     Q = identity<dim>();
        Tensor<1, dim>     shift;
        const unsigned int n = piece.free.size();
        for (unsigned int iteration = 0; iteration < 20; ++iteration)
          {
            const Tensor<2, dim>     after = (S + M) * transpose(Q); // Σ V⁰ z⊗y
            const Tensor<1, dim>     mean  = Q * U + piece.volume * shift;
            LAPACKFullMatrix<double> jacobian(n);
            Vector<double>           defect(n), twist(n);
            for (unsigned int k = 0; k < n; ++k)
              {
                const Mode &test = piece.free[k];
                defect[k]        = -(test.a * mean) - moment(test.B, after - S);
                for (unsigned int l = 0; l < n; ++l)
                  {
                    const Mode &motion = piece.free[l];
                    jacobian(k, l) =
                      test.a * (piece.volume * motion.a + motion.B * mean) +
                      moment(test.B, after * transpose(motion.B));
                  }
              }
            jacobian.compute_inverse_svd(inertia_tolerance);
            jacobian.vmult(twist, defect);
            Mode update;
            for (unsigned int k = 0; k < n; ++k)
              {
                update.a += twist[k] * piece.free[k].a;
                update.B += twist[k] * piece.free[k].B;
              }
            const Tensor<2, dim> turn = rotation(update.B);
            Q                         = turn * Q;
            shift                     = turn * shift + update.a;
            if (twist.linfty_norm() <= 1e-14 * space.box().spacing())
              break;
          }
        superpose(p, Q, shift + piece.center - Q * piece.center, coefficients);
      }
    std::copy(coefficients.begin(), coefficients.end(), u.begin());
    u.compress(VectorOperation::insert);
  }

  template class RigidModes<2>;
  template class RigidModes<3>;
} // namespace Morula
