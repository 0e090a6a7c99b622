// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_rigid_modes_h
#define morula_mechanics_rigid_modes_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/equilibrium.h>

#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace Morula
{
  /** The unsupported rigid motions of bodies, of each by itself. */
  template <int dim>
  class FreeMotions
  {
  public:
    /** A particle, with its weight in the mean motion. */
    struct Mass
    {
      unsigned int piece;
      Point<dim>   x;
      double       V0; // V⁰, µm^dim
    };

    /** A fixed or slip boundary point, or what else holds a place. */
    struct Support
    {
      unsigned int   piece;
      Point<dim>     x;
      Tensor<2, dim> projection; // onto the held directions
      double         area;       // µm^(dim-1)
    };

    static constexpr unsigned int n_rotations = dim * (dim - 1) / 2;
    static constexpr unsigned int n_modes     = dim + n_rotations;

    /** The field a + B (x - center), B skew. */
    struct Mode
    {
      Tensor<1, dim> a;
      Tensor<2, dim> B; // 1/µm
    };

    struct Piece
    {
      double            volume = 0.; // Σ V⁰
      Point<dim>        center;      // of Σ V⁰
      std::vector<Mode> free;        // unsupported motions, a basis
    };

    /** Collective. @param length see elementary_mode(), µm
     *  @param as_one see RigidModes */
    FreeMotions(const unsigned int          n_pieces,
                const double                length,
                const std::vector<Mass>    &masses,
                const std::vector<Support> &supports,
                const MPI_Comm              comm,
                const bool                  as_one = false);

    /** The piece of this number. */
    const Piece &
    of_piece(const unsigned int piece) const
    {
      return pieces[entry(piece)];
    }

    /** The @p k th translation or rotation; it moves points at the distance
     *  @p length (µm) from the axis by 1 µm. */
    static Mode
    elementary_mode(const unsigned int k, const double length)
    {
      Mode mode;
      if (k < dim)
        mode.a[k] = 1.;
      else
        {
          // Rotations act in the planes (0,1), (1,2), (2,0); in 2-D there is
          // only the first.
          const unsigned int i = (k - dim) % dim, j = (i + 1) % dim;
          mode.B[i][j] = 1. / length;
          mode.B[j][i] = -1. / length;
        }
      return mode;
    }

  protected:
    /** The entry of @p pieces for a piece. */
    unsigned int
    entry(const unsigned int piece) const
    {
      return as_one ? 0 : piece;
    }

    const bool         as_one;
    std::vector<Piece> pieces;
  };

  /**
   * The unsupported rigid motions of the tissue's pieces (grid cells joined by
   * shared splines), and what keeps a step free of them: Σ V⁰ m·u = 0 for every
   * unsupported rigid motion m(x) of every piece. A body on one slip plane
   * keeps three rigid motions, a free one six, and so does each detached
   * fragment.
   */
  template <int dim>
  class RigidModes : public FreeMotions<dim>
  {
  public:
    using typename FreeMotions<dim>::Mass;
    using typename FreeMotions<dim>::Support;
    using typename FreeMotions<dim>::Mode;
    using typename FreeMotions<dim>::Piece;

    /** Collective. @param as_one whether all pieces together are one body, as
     *         they may touch: then only motions are free that all of them make
     *         together */
    RigidModes(const SplineSpace<dim>     &space,
               const std::vector<Mass>    &masses,
               const std::vector<Support> &supports,
               const MPI_Comm              comm,
               const bool                  as_one = false)
      : FreeMotions<dim>(space.n_pieces(),
                         space.box().spacing(),
                         masses,
                         supports,
                         comm,
                         as_one)
      , space(space)
      , comm(comm)
    {}

    /** Whether any piece has an unsupported rigid motion. */
    bool
    any() const
    {
      return std::any_of(pieces.begin(), pieces.end(), [](const Piece &piece) {
        return !piece.free.empty();
      });
    }

    /**
     * Orthonormal coefficient vectors that span the unsupported rigid motions
     * of all pieces. Collective.
     */
    std::vector<Equilibrium::Vector>
    null_space() const;

    /**
     * Orthonormal vectors that span the forces Σ V⁰ N_a m(x) of all
     * unsupported rigid motions m of all pieces (@p masses as in the
     * constructor). An increment u orthogonal to them has Σ V⁰ m·u = 0,
     * doc/theory.md (4.10), and a
     * load that has no part in them but is not balanced acts together with
     * forces of inertia: V⁰ m(x) on every particle, whatever the grid.
     * Collective.
     */
    std::vector<Equilibrium::Vector>
    inertia(const std::vector<Mass> &masses) const;

    /** Whether a piece has an unsupported rigid motion. */
    bool
    has_free_motion(const unsigned int piece) const
    {
      return !pieces[piece].free.empty();
    }

    /** A rotation about the axis of the skew @p B: Cayley's transform. */
    static Tensor<2, dim>
    rotation(const Tensor<2, dim> &B);

  private:
    using FreeMotions<dim>::as_one;
    using FreeMotions<dim>::entry;
    using FreeMotions<dim>::pieces;

    const SplineSpace<dim> &space;
    const MPI_Comm          comm;
  };

  /** A fixed or slip point: where it is, and where it is held at the beginning
   *  of a step and at its end, µm. */
  template <int dim>
  struct HeldPoint
  {
    Point<dim>     x, from, to;
    Tensor<2, dim> projection; // onto the held directions
    double         area;       // µm^(dim-1)
    unsigned int   part = 0;   // see SplineSpace::GridCell
  };

  /**
   * Where Newton's method starts in a step that moves held points: each piece
   * of the tissue goes along with the rigid motion that its held points make on
   * average, doc/theory.md (4.14). A clamp that moves by many grid spacings, or
   * turns, then takes the tissue with it, and what is left to find is how it
   * deforms.
   *
   * A piece starts at rest if its held points rest, if their motion is mostly
   * no rigid one, or if they leave some rigid motion of the piece free.
   *
   * @return nothing if all pieces start at rest. Collective.
   */
  template <int dim>
  std::optional<Equilibrium::Vector>
  rigid_start(const SplineSpace<dim>            &space,
              const RigidModes<dim>             &modes,
              const std::vector<HeldPoint<dim>> &points,
              const MPI_Comm                     comm);
} // namespace Morula

#endif
