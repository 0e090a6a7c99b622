// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/review.h>
#include <morula/mechanics/point_term.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/seeding/pieces_at_start.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** A larger part of the loads than this is not left over by rounding and
     *  the patches of a curved surface. */
    constexpr double largest_rest = 0.01;

    /** Loads without a resultant, as surface tension, have one of rounding:
     *  less than this stress on their area, kPa. */
    constexpr double rounding_stress = 1e-9;

    /** So many pieces are described one by one. */
    constexpr std::size_t most_listed = 8;

    /** What holds a piece of the tissue at t = 0, and which load is left to its
     *  unsupported rigid motions, over all ranks. */
    template <int dim>
    struct HeldPiece
    {
      std::uint64_t cells = 0;
      /** Centre of its cells' volume, µm. */
      Point<dim> center;
      /** Fixed or slip boundary points on it. */
      std::uint64_t held_points = 0;
      /** Whether friction of cells holds it. */
      bool has_friction = false;
      /** Number of rigid motions that nothing holds, doc/theory.md (4.9). */
      unsigned int free_motions = 0;
      /** Sum of its loads at the end of the run on the configuration of t = 0,
       *  kPa µm^(dim-1), and their moment about the centre, kPa µm^dim; in 2-D
       *  the third component. */
      Tensor<1, dim> force;
      Tensor<1, 3>   moment;
      /** Whether a part of the loads acts along a free motion. */
      bool is_unbalanced = false;
    };

    /** What ranks add up of a piece. */
    template <int dim>
    struct PieceSums
    {
      static constexpr unsigned int n     = RigidModes<dim>::n_modes;
      double                        cells = 0., volume = 0.;
      Tensor<1, dim>                first; // Σ V⁰ x
      double                        held = 0., friction = 0.;
      std::vector<double>           S = std::vector<double>(n * n, 0.);
      std::vector<double>           load =
        std::vector<double>(n, 0.); // by elementary motion
      std::vector<double> magnitude = std::vector<double>(n, 0.);
      double              area      = 0.;
    };

    template <int dim>
    class Pieces
    {
    public:
      using Modes                     = RigidModes<dim>;
      static constexpr unsigned int n = Modes::n_modes;

      Pieces(const unsigned int n_pieces, const double h, const MPI_Comm comm)
        : sums(n_pieces)
        , h(h)
        , comm(comm)
      {}

      void
      add_cell(const unsigned int piece, const Point<dim> &X, const double V)
      {
        sums[piece].cells += 1.;
        sums[piece].volume += V;
        sums[piece].first += V * Tensor<1, dim>(X);
      }

      /** Adds the cells of all ranks. */
      void
      find_centers()
      {
        for (PieceSums<dim> &one : sums)
          {
            one.cells  = Utilities::MPI::sum(one.cells, comm);
            one.volume = Utilities::MPI::sum(one.volume, comm);
            one.first  = Utilities::MPI::sum(one.first, comm);
          }
      }

      Point<dim>
      center(const unsigned int piece) const
      {
        const PieceSums<dim> &of = sums[piece];
        return of.volume > 0. ? Point<dim>(of.first / of.volume) : Point<dim>();
      }

      /** Adds a support: doc/theory.md (4.9). */
      void
      add_support(const unsigned int    piece,
                  const Point<dim>     &x,
                  const Tensor<2, dim> &held,
                  const double          weight,
                  const bool            is_friction)
      {
        ++(is_friction ? sums[piece].friction : sums[piece].held);
        std::array<Tensor<1, dim>, n> motion;
        for (unsigned int k = 0; k < n; ++k)
          motion[k] = held * velocity(k, x - center(piece));
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int l = 0; l < n; ++l)
            sums[piece].S[k * n + l] += weight * (motion[k] * motion[l]);
      }

      /** @param area of the surface, µm^(dim-1); 0 in the body */
      void
      add_load(const unsigned int    piece,
               const Point<dim>     &x,
               const Tensor<1, dim> &force,
               const double          area)
      {
        PieceSums<dim> &of = sums[piece];
        for (unsigned int k = 0; k < n; ++k)
          {
            const auto v = velocity(k, x - center(piece));
            of.load[k] += force * v;
            of.magnitude[k] += force.norm() * v.norm();
          }
        of.area += area;
      }

      /** The pieces that hold cells. Collective. */
      std::vector<HeldPiece<dim>>
      result()
      {
        std::vector<HeldPiece<dim>> list;
        for (unsigned int p = 0; p < sums.size(); ++p)
          {
            PieceSums<dim> &of = sums[p];
            of.held            = Utilities::MPI::sum(of.held, comm);
            of.friction        = Utilities::MPI::sum(of.friction, comm);
            of.area            = Utilities::MPI::sum(of.area, comm);
            Utilities::MPI::sum(of.S, comm, of.S);
            Utilities::MPI::sum(of.load, comm, of.load);
            Utilities::MPI::sum(of.magnitude, comm, of.magnitude);
            if (of.cells > 0.)
              list.push_back(piece(p));
          }
        std::stable_sort(list.begin(),
                         list.end(),
                         [](const HeldPiece<dim> &a, const HeldPiece<dim> &b) {
                           return a.cells > b.cells;
                         });
        return list;
      }

    private:
      /** An elementary motion at @p z from the centre. */
      Tensor<1, dim>
      velocity(const unsigned int k, const Tensor<1, dim> &z) const
      {
        const auto mode = Modes::elementary_mode(k, h);
        return mode.a + mode.B * z;
      }

      HeldPiece<dim>
      piece(const unsigned int p) const
      {
        // A free motion is a combination of the elementary ones: its load is
        // that of them, and so is the scale that this is compared with.
        const PieceSums<dim> &of = sums[p];
        HeldPiece<dim>        result;
        result.cells        = std::llround(of.cells);
        result.held_points  = std::llround(of.held);
        result.has_friction = of.friction > 0.;
        const auto free     = Modes::free_motions(of.S.data(), h);
        result.free_motions = free.size();
        // Sums that cancel leave rounding.
        const auto load = [&of](const unsigned int k) {
          return std::abs(of.load[k]) > 1e-9 * of.magnitude[k] ? of.load[k] :
                                                                 0.;
        };
        result.center = center(p);
        for (unsigned int d = 0; d < dim; ++d)
          result.force[d] = load(d);
        for (unsigned int k = dim; k < n; ++k)
          // The motion k turns the plane of two axes by -1/h about the third.
          result.moment[dim == 2 ? 2 : (k - dim + 2) % 3] = 0. - h * load(k);
        for (const auto &motion : free)
          {
            double sum = 0., scale = 0.;
            for (unsigned int k = 0; k < n; ++k)
              {
                const auto   part = Modes::elementary_mode(k, h);
                const double c =
                  k < dim ? part.a * motion.a :
                            h * h / 2. * scalar_product(part.B, motion.B);
                sum += c * of.load[k];
                scale += std::abs(c) * std::max(largest_rest * of.magnitude[k],
                                                rounding_stress * of.area);
              }
            result.is_unbalanced =
              result.is_unbalanced || std::abs(sum) > scale;
          }
        return result;
      }

      std::vector<PieceSums<dim>> sums;
      const double                h;
      const MPI_Comm              comm;
    };

    /** Adds what fixed and slip points hold, and what conditions load. */
    template <int dim>
    void
    add_surface(const TissueModel<dim>          &model,
                const SurfacePatches<dim>       &surface,
                const std::vector<unsigned int> &piece,
                Pieces<dim>                     &pieces)
    {
      // Fixed points hold all directions, slip points that of their normal,
      // both by their area. Then the forces of all loads are added to the
      // pieces of their points: those at the end of the run on the surface of t
      // = 0. A point without a force brings no area, which is the measure of
      // what rounding leaves.
      const BoundaryConditions<dim> &conditions = model.boundary_conditions;
      const Tensor<2, dim>           all(unit_symmetric_tensor<dim>());
      for (std::size_t i = 0; i < surface.positions.size(); ++i)
        {
          const Point<dim>      &X    = surface.positions[i];
          const Tensor<1, dim>  &N    = surface.normals[i];
          const SurfaceCondition kind = conditions.condition(X, N);
          if (!is_held(kind))
            continue;
          pieces.add_support(piece[i],
                             X,
                             kind == SurfaceCondition::fixed ?
                               all :
                               outer_product(N, N),
                             surface.areas[i],
                             false);
        }
      std::vector<std::size_t> patches;
      const LoadedPoints<dim>  loaded =
        loaded_at_start(model, surface, &patches);
      for (const auto &named : conditions.list())
        if (const auto forces = forces_at_start(*named.condition,
                                                loaded,
                                                model.scene.time.end_time))
          for (std::size_t l = 0; l < forces->size(); ++l)
            {
              const std::size_t i = patches[l];
              pieces.add_load(piece[i],
                              surface.positions[i],
                              (*forces)[l],
                              (*forces)[l].norm() > 0. ? surface.areas[i] : 0.);
            }
    }

    /** Adds body forces and friction of a founder in its state at t = 0. */
    template <int dim>
    void
    add_body(const TissueModel<dim> &model,
             const PresentCell<dim> &cell,
             const Point<dim>       &X,
             const double            V,
             const unsigned int      piece,
             Pieces<dim>            &pieces)
    {
      // A force that depends on the present place is no support in a step
      // either: its value at t = 0 counts. Friction counts where it does in a
      // step, doc/theory.md, section 4.4.
      const Scene &scene = model.scene;
      const double h     = scene.grid.spacing;
      for (const auto &[name, force] : model.forces)
        {
          if (const auto load = force->load_of(cell, scene.time.end_time))
            pieces.add_load(piece, X, V * *load, 0.);
          const double strength =
            force->friction_of(cell, 0.).value_or(0.) * h * h /
            (scene.time.step * youngs_modulus(cell.lame()));
          if (strength < Drag<dim>::least)
            continue;
          pieces.add_support(piece,
                             X,
                             Tensor<2, dim>(unit_symmetric_tensor<dim>()),
                             strength * V / h,
                             true);
        }
    }

    /** "a force of (1 0) kPa um and a moment of 3 kPa um^2". */
    template <int dim>
    std::string
    load_text(const HeldPiece<dim> &piece)
    {
      const double       zero = 1e-9 * piece.force.norm();
      std::ostringstream text;
      text.precision(4);
      text << "a force of " << vector_text(piece.force, zero) << " kPa um"
           << (dim == 3 ? "^2" : "") << " and a moment of ";
      if (dim == 3)
        text << vector_text(piece.moment, 0.) << " kPa um^3";
      else
        text << piece.moment[2] << " kPa um^2";
      return text.str();
    }

    /** The pieces that hold cells, largest first. Collective. */
    template <int dim>
    std::vector<HeldPiece<dim>>
    held_pieces(const TissueModel<dim>    &model,
                const Founders<dim>       &founders,
                const SurfacePatches<dim> &surface,
                const MPI_Comm             comm)
    {
      // First the centres of all pieces, as motions are about them; then what
      // each rank has of supports and loads; then the sums over all ranks. An
      // expression may have no value on one rank only.
      const PiecesAtStart at =
        pieces_at_start(model.scene.grid, founders, surface, comm);
      Pieces<dim> pieces(at.n, model.scene.grid.spacing, comm);
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        pieces.add_cell(at.of_founders[i],
                        founders.positions[i],
                        founders.volumes[i]);
      pieces.find_centers();
      everywhere(comm,
                 [&]() { add_surface(model, surface, at.of_patches, pieces); });
      if (!model.forces.empty())
        for_first_cells<dim>(model,
                             founders,
                             surface,
                             0.,
                             comm,
                             [&](const std::size_t i,
                                 std::vector<double> &,
                                 const PresentCell<dim> &cell) {
                               add_body(model,
                                        cell,
                                        founders.positions[i],
                                        founders.volumes[i],
                                        at.of_founders[i],
                                        pieces);
                             });
      return pieces.result();
    }

    /** E.g. "100 cells around (0 0) um, not supported", one for each of the
     * first pieces. */
    template <int dim>
    std::vector<std::string>
    texts_of(const std::vector<HeldPiece<dim>> &pieces)
    {
      // The largest pieces have a line each: where it is, what holds it, which
      // motions nothing holds, and its loads along these. The rest is counted.
      std::vector<std::string> texts;
      const unsigned int       all = RigidModes<dim>::n_modes;
      for (std::size_t p = 0; p < pieces.size() && p < most_listed; ++p)
        {
          const HeldPiece<dim> &piece = pieces[p];
          std::ostringstream    text;
          text.precision(4);
          text << piece.cells << (piece.cells == 1 ? " cell" : " cells")
               << " around " << vector_text(piece.center, 1e-6) << " um, ";
          if (piece.free_motions == all)
            text << "not supported";
          else
            {
              text << "supported";
              if (piece.held_points > 0)
                text << " at " << piece.held_points << " boundary points";
              if (piece.has_friction)
                text << (piece.held_points > 0 ? " and" : "") << " by friction";
              if (piece.free_motions > 0)
                text << ", but free in " << piece.free_motions
                     << " rigid motions";
            }
          if (piece.is_unbalanced)
            text << "; loads add up to " << load_text(piece);
          texts.push_back(text.str());
        }
      if (pieces.size() > most_listed)
        texts.push_back("and " + std::to_string(pieces.size() - most_listed) +
                        " more");
      return texts;
    }

    template <int dim>
    std::vector<std::string>
    review_held(const Scene &scene, const std::vector<HeldPiece<dim>> &pieces)
    {
      // The first unbalanced piece is told of, with the number of others: all
      // of them stand in the list of pieces.
      Review review{[&scene](const AnyKey &key) { return scene.has_set(key); }};
      const auto is_unbalanced = [](const HeldPiece<dim> &piece) {
        return piece.is_unbalanced;
      };
      const auto first =
        std::find_if(pieces.begin(), pieces.end(), is_unbalanced);
      if (first == pieces.end())
        return {};
      const auto n = std::count_if(pieces.begin(), pieces.end(), is_unbalanced);
      std::ostringstream piece;
      piece.precision(4);
      if (pieces.size() == 1)
        piece << "the tissue";
      else
        piece << "the part of " << first->cells << " cells around "
              << vector_text(first->center, 1e-6) << " um"
              << (n > 1 ? " (nor " + std::to_string(n - 1) + " others)" : "");
      review.warn(
        "Boundary conditions",
        first->held_points > 0 ? "supported in part" : "no support",
        "the loads add up to " + load_text(*first) +
          " at the end, and nothing holds " + piece.str() +
          " against them: inertia balances them, as in free fall, or "
          "beside obstacles a weak drag (doc/theory.md, section 4.4).",
        "Hold a part of its surface by Fixed where or Slip where, or "
        "balance the loads.");
      return review.warnings;
    }
  } // namespace


  template <int dim>
  std::vector<std::string>
  describe_pieces(const TissueModel<dim> &model,
                  SeededTissue<dim>      &tissue,
                  const MPI_Comm          comm)
  {
    const std::vector<HeldPiece<dim>> pieces =
      held_pieces(model, tissue.founders, tissue.surface, comm);
    tissue.n_pieces = pieces.size();
    tissue.pieces   = texts_of(pieces);
    return review_held(model.scene, pieces);
  }


  MORULA_INSTANTIATE(describe_pieces);
} // namespace Morula
