// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/spline_field.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

#include <functional>
#include <utility>

namespace Morula
{
  namespace
  {
    /** A motion is mostly rigid if no more than this part of the squares of the
     *  held points' displacements is left without it. Where clamps deform a
     *  piece rather than carry it, a rigid start is no better than none. */
    constexpr double largest_rest = 0.1;

    /** Rotations that hardly move the held points, relative to translations,
     *  are not asked for: those about the line through all, or of one point. */
    constexpr double weakest = 1e-9;

    // A fit that makes sense takes far fewer; the bound ends the others.
    constexpr unsigned int max_iterations = 50;

    /** y = Q (x - center) + center + shift, fitted to the points of a piece by
     *  Gauss and Newton's method. */
    template <int dim>
    struct RigidFit
    {
      Point<dim>     center;
      Tensor<1, dim> shift;
      Tensor<2, dim> Q      = Tensor<2, dim>(unit_symmetric_tensor<dim>());
      double         area   = 0.;        // Σ a
      double         square = 0.;        // Σ a |M (y - to)|²
      double         square_before = 0.; // at rest

      /** The place relative to the center. */
      Tensor<1, dim>
      moved(const Point<dim> &x) const
      {
        return Q * (x - center) + shift;
      }
    };

    template <int dim>
    using Fits = std::vector<RigidFit<dim>>;

    /** Held points, each with the number of its piece. */
    template <int dim>
    using Points = std::vector<std::pair<unsigned int, HeldPoint<dim>>>;

    template <int dim>
    void
    find_centers(const Points<dim> &points,
                 Fits<dim>         &fits,
                 const MPI_Comm     comm)
    {
      // The area and its first moment by piece: one reduction serves all
      // pieces.
      std::vector<double> sums(fits.size() * (dim + 1), 0.);
      for (const auto &[piece, point] : points)
        {
          double *const sum = &sums[piece * (dim + 1)];
          for (unsigned int d = 0; d < dim; ++d)
            sum[d] += point.area * point.from[d];
          sum[dim] += point.area;
        }
      Utilities::MPI::sum(sums, comm, sums);
      for (std::size_t p = 0; p < fits.size(); ++p)
        {
          // Pieces without held points stay as they are.
          fits[p].area = sums[p * (dim + 1) + dim];
          if (fits[p].area > 0.)
            for (unsigned int d = 0; d < dim; ++d)
              fits[p].center[d] = sums[p * (dim + 1) + d] / fits[p].area;
        }
    }

    /** One correction of all pieces; returns the largest, µm. */
    template <int dim>
    double
    improve(const Points<dim> &points,
            const double       length,
            Fits<dim>         &fits,
            const MPI_Comm     comm)
    {
      // One linear least squares problem for each piece: doc/theory.md (4.14),
      // linearised at the present motion. The first loop sums its normal matrix
      // (lower triangle), its right-hand side and the square that is left, over
      // this rank's held points; one reduction adds up those of all ranks. Then
      // each rank solves all pieces' small systems, and so has the same motion.
      // The update acts from the left, as a Cayley transform, so that Q stays a
      // rotation.
      using Modes           = RigidModes<dim>;
      constexpr int       n = Modes::n_modes, width = n * n + n + 1;
      std::vector<double> sums(fits.size() * width, 0.);
      for (const auto &[piece, point] : points)
        {
          const RigidFit<dim> &fit = fits[piece];
          const Tensor<1, dim> y   = fit.moved(point.from);
          const Tensor<1, dim> gap =
            point.projection * (y - (point.to - fit.center));
          double *const  sum = &sums[piece * width];
          Tensor<1, dim> held[n];
          for (int k = 0; k < n; ++k)
            {
              const auto mode = Modes::elementary_mode(k, length);
              held[k]         = point.projection * (mode.a + mode.B * y);
              sum[n * n + k] -= point.area * (held[k] * gap);
              for (int l = 0; l <= k; ++l)
                sum[k * n + l] += point.area * (held[k] * held[l]);
            }
          sum[n * n + n] += point.area * gap.norm_square();
        }
      Utilities::MPI::sum(sums, comm, sums);

      double largest = 0.;
      for (std::size_t p = 0; p < fits.size(); ++p)
        {
          RigidFit<dim>      &fit = fits[p];
          const double *const sum = &sums[p * width];
          fit.square              = sum[n * n + n];
          // No point holds this piece.
          if (fit.area == 0.)
            continue;
          LAPACKFullMatrix<double> matrix(n);
          Vector<double>           forces(n), twist(n);
          for (int k = 0; k < n; ++k)
            {
              forces[k] = sum[n * n + k];
              for (int l = 0; l < n; ++l)
                matrix(k, l) = sum[std::max(k, l) * n + std::min(k, l)];
            }
          // A pseudo-inverse leaves out rotations that hardly move any held
          // point.
          matrix.compute_inverse_svd(weakest);
          matrix.vmult(twist, forces);
          Tensor<1, dim> a;
          Tensor<2, dim> B;
          for (int k = 0; k < n; ++k)
            {
              const auto mode = Modes::elementary_mode(k, length);
              a += twist[k] * mode.a;
              B += twist[k] * mode.B;
            }
          const Tensor<2, dim> turn = Modes::rotation(B);
          fit.Q                     = turn * fit.Q;
          fit.shift                 = turn * fit.shift + a;
          largest                   = std::max(largest, twist.linfty_norm());
        }
      return largest;
    }
  } // namespace

  template <int dim>
  std::optional<Equilibrium::Vector>
  rigid_start(const SplineSpace<dim>            &space,
              const RigidModes<dim>             &modes,
              const std::vector<HeldPoint<dim>> &held,
              const MPI_Comm                     comm)
  {
    // Nothing is done, and u starts at 0 to the bit, unless a held point of any
    // rank moves in this step. Each held point is assigned to the piece of its
    // grid cell. The fit of doc/theory.md (4.14) improves the motions of all
    // pieces together, since each correction is collective. Then the pieces
    // that go along get the coefficients of their affine displacement; splines
    // reproduce it exactly. The pieces' unknowns are disjoint, so their vectors
    // simply add up.
    const bool moves =
      std::any_of(held.begin(), held.end(), [](const HeldPoint<dim> &point) {
        return point.from != point.to;
      });
    if (!Utilities::MPI::logical_or(moves, comm))
      return {};

    const GridBox<dim> &box    = space.box();
    const double        length = box.spacing();
    Points<dim>         points;
    for (const auto &point : held)
      points.emplace_back(space.piece(box.number(box.locate(point.x)),
                                      point.part),
                          point);
    Fits<dim> fits(space.n_pieces());
    find_centers(points, fits, comm);
    for (unsigned int i = 0; i < max_iterations; ++i)
      {
        const double largest = improve(points, length, fits, comm);
        // The first pass has measured the motion at rest.
        if (i == 0)
          for (RigidFit<dim> &fit : fits)
            fit.square_before = fit.square;
        // A correction below rounding of a coordinate changes nothing any more.
        if (largest <= 1e-13 * length)
          break;
      }

    bool                starts_moving = false;
    std::vector<double> coefficients(dim * space.owned().n_elements(), 0.);
    for (unsigned int p = 0; p < fits.size(); ++p)
      {
        const RigidFit<dim> &fit = fits[p];
        // Pieces at rest, pieces that a free motion would make ambiguous, and
        // pieces whose clamps deform them rather than carry them, start from 0.
        if (fit.square_before == 0. || modes.has_free_motion(p) ||
            fit.square > largest_rest * fit.square_before)
          continue;
        // The motion y = Q (x - center) + center + shift is written as a + A x,
        // and less x it is the displacement.
        const Tensor<1, dim> center = fit.center - Point<dim>();
        const auto           part =
          affine_displacement(space,
                              p,
                              fit.shift + center - fit.Q * center,
                              fit.Q -
                                Tensor<2, dim>(unit_symmetric_tensor<dim>()));
        std::transform(part.begin(),
                       part.end(),
                       coefficients.begin(),
                       coefficients.begin(),
                       std::plus<>());
        starts_moving = true;
      }
    if (!starts_moving)
      return {};
    return FieldUnknowns<dim>(space, comm).vector(coefficients);
  }

  MORULA_INSTANTIATE(rigid_start);
} // namespace Morula
