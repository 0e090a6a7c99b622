// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/review.h>
#include <morula/mechanics/point_term.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/seeding/bodies.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/utilities.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
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

    /** To which piece of the tissue founders and patches of this rank belong at
     *  t = 0. A piece is a group of grid cells that touch and hold founders or
     *  boundary points; bodies that have contact are pieces of their own. */
    struct PiecesAtStart
    {
      /** Number of pieces, over all ranks. */
      unsigned int              n = 0;
      std::vector<unsigned int> of_founders, of_patches;
    };

    /** A grid cell by its place, and the body in it. */
    template <int dim>
    using GridPlace = std::array<int, dim + 1>;

    /** The places of points, in their order. */
    template <int dim>
    std::vector<GridPlace<dim>>
    places_of(const GridParameters            &grid,
              const std::vector<Point<dim>>   &points,
              const std::vector<unsigned int> &bodies)
    {
      const std::vector<double>   offset = grid.offset;
      std::vector<GridPlace<dim>> places(points.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          for (unsigned int d = 0; d < dim; ++d)
            places[i][d] = static_cast<int>(
              std::floor((points[i][d] - offset[d]) / grid.spacing));
          places[i][dim] = bodies.empty() ? 0 : bodies[i];
        }
      return places;
    }

    /** Finds the pieces, the same on all ranks. Collective. */
    template <int dim>
    PiecesAtStart
    pieces_at_start(const GridParameters      &grid,
                    const Founders<dim>       &founders,
                    const SurfacePatches<dim> &surface,
                    const MPI_Comm             comm)
    {
      // Every rank gets all occupied grid cells, far fewer than founders, and
      // joins those that touch by Boost's disjoint sets, in the same order. A
      // piece gets its number when the first of its grid cells comes along.
      const auto of_founders =
        places_of<dim>(grid, founders.positions, founders.bodies);
      const auto of_patches =
        places_of<dim>(grid, surface.positions, surface.bodies);
      std::set<GridPlace<dim>> mine(of_founders.begin(), of_founders.end());
      mine.insert(of_patches.begin(), of_patches.end());
      std::map<GridPlace<dim>, unsigned int> numbers;
      for (const auto &place :
           of_all_ranks(std::vector<GridPlace<dim>>(mine.begin(), mine.end()),
                        comm))
        numbers[place] = 0;
      unsigned int n = 0;
      for (auto &entry : numbers)
        entry.second = n++;
      boost::disjoint_sets_with_storage<> sets(numbers.size());
      for (const auto &[place, number] : numbers)
        for (int k = 0; k < Utilities::pow(3, dim); ++k)
          {
            GridPlace<dim> other = place;
            for (int d = 0, rest = k; d < dim; ++d, rest /= 3)
              other[d] += rest % 3 - 1;
            if (const auto found = numbers.find(other); found != numbers.end())
              sets.union_set(number, found->second);
          }

      PiecesAtStart                        pieces;
      std::map<unsigned int, unsigned int> of_set;
      std::vector<unsigned int>            of_number;
      for (unsigned int number = 0; number < numbers.size(); ++number)
        of_number.push_back(
          of_set.emplace(sets.find_set(number), of_set.size()).first->second);
      pieces.n = of_set.size();
      for (const GridPlace<dim> &place : of_founders)
        pieces.of_founders.push_back(of_number[numbers.at(place)]);
      for (const GridPlace<dim> &place : of_patches)
        pieces.of_patches.push_back(of_number[numbers.at(place)]);
      return pieces;
    }


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
      /** Its loads at the end of the run on the configuration of t = 0. */
      std::string load;
      /** Whether a part of them acts along a free motion. */
      bool is_unbalanced = false;
    };

    /** What is there, holds and loads on this rank, with the pieces. */
    template <int dim>
    struct OnPieces
    {
      struct Load
      {
        unsigned int   piece;
        Point<dim>     x;
        Tensor<1, dim> force; // kPa µm^(dim-1)
        double         area;  // of the surface, µm^(dim-1); 0 in the body
      };

      std::vector<typename FreeMotions<dim>::Mass>    cells;
      std::vector<typename FreeMotions<dim>::Support> supports;
      /** The first of the supports that are friction. */
      std::size_t       n_held = 0;
      std::vector<Load> loads;
    };

    /** Adds what fixed and slip points hold, and what conditions load. */
    template <int dim>
    void
    add_surface(const TissueModel<dim>          &model,
                const SurfacePatches<dim>       &surface,
                const std::vector<unsigned int> &piece,
                OnPieces<dim>                   &mine)
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
          if (is_held(kind))
            mine.supports.push_back(
              {piece[i],
               X,
               kind == SurfaceCondition::fixed ? all : outer_product(N, N),
               surface.areas[i]});
        }
      mine.n_held = mine.supports.size();
      std::vector<std::size_t> patches;
      const LoadedPoints<dim>  loaded =
        loaded_at_start(model, surface, &patches);
      for (const auto &named : conditions.list())
        if (const auto forces = forces_at_start(*named.condition,
                                                loaded,
                                                model.scene.time.end_time))
          for (std::size_t l = 0; l < forces->size(); ++l)
            if (const std::size_t i = patches[l]; (*forces)[l].norm() > 0.)
              mine.loads.push_back({piece[i],
                                    surface.positions[i],
                                    (*forces)[l],
                                    surface.areas[i]});
    }

    /** Adds body forces and friction of a founder in its state at t = 0. */
    template <int dim>
    void
    add_body(const TissueModel<dim>                &model,
             const PresentCell<dim>                &cell,
             const typename FreeMotions<dim>::Mass &founder,
             OnPieces<dim>                         &mine)
    {
      // A force that depends on the present place is no support in a step
      // either: its value at t = 0 counts. Friction counts where it does in a
      // step, doc/theory.md, section 4.4.
      const Scene &scene = model.scene;
      const double h     = scene.grid.spacing;
      for (const auto &[name, force] : model.forces)
        {
          if (const auto load = force->load_of(cell, scene.time.end_time))
            mine.loads.push_back(
              {founder.piece, founder.x, founder.V0 * *load, 0.});
          const double strength =
            force->friction_of(cell, 0.).value_or(0.) * h * h /
            (scene.time.step * youngs_modulus(cell.lame()));
          if (!(strength < Drag<dim>::least))
            mine.supports.push_back(
              {founder.piece,
               founder.x,
               Tensor<2, dim>(unit_symmetric_tensor<dim>()),
               strength * founder.V0 / h});
        }
    }

    /** "a force of (1 0) kPa um and a moment of 3 kPa um^2".
     *  @param force, moment and what they would be if no parts cancelled */
    template <int dim>
    std::string
    load_text(const double *force, const double *moment, const double *size)
    {
      // Sums that cancel leave rounding. The moment is about the centre; in 2-D
      // it has the third component alone.
      Tensor<1, dim> sum;
      Tensor<1, 3>   turn;
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] = force[d];
      for (unsigned int d = 0; d < 3; ++d)
        turn[d] = std::abs(moment[d]) > 1e-9 * size[1] ? moment[d] : 0.;
      std::ostringstream text;
      text.precision(4);
      text << "a force of " << vector_text(sum, 1e-9 * size[0]) << " kPa um"
           << (dim == 3 ? "^2" : "") << " and a moment of ";
      if (dim == 3)
        text << vector_text(turn, 0.) << " kPa um^3";
      else
        text << turn[2] << " kPa um^2";
      return text.str();
    }

    /** The pieces that hold cells, largest first, by what all ranks have.
     *  Collective. */
    template <int dim>
    std::vector<HeldPiece<dim>>
    sums_of(const OnPieces<dim> &mine,
            const unsigned int   n_pieces,
            const double         h,
            const MPI_Comm       comm)
    {
      // Of each piece there are numbers of cells, held points and cells with
      // friction; then force, moment, and what they would be if no parts
      // cancelled; then for each free motion the power of the loads in it, what
      // that would be, and what rounding makes of their area.
      using Motions                = FreeMotions<dim>;
      constexpr unsigned int force = 3, moment = force + dim, size = moment + 3,
                             power = size + 2, n = power + 3 * Motions::n_modes;
      const Motions       motions(n_pieces, h, mine.cells, mine.supports, comm);
      std::vector<double> sums(n * n_pieces, 0.);
      for (const auto &cell : mine.cells)
        ++sums[n * cell.piece];
      for (std::size_t i = 0; i < mine.supports.size(); ++i)
        ++sums[n * mine.supports[i].piece + (i < mine.n_held ? 1 : 2)];
      for (const auto &load : mine.loads)
        {
          double *const        sum   = &sums[n * load.piece];
          const auto          &piece = motions.of_piece(load.piece);
          const Tensor<1, dim> z = load.x - piece.center, &f = load.force;
          for (unsigned int d = 0; d < dim; ++d)
            sum[force + d] += f[d];
          for (unsigned int k = 0; k < Motions::n_rotations; ++k)
            sum[moment + (k + 2) % 3] +=
              z[k] * f[(k + 1) % dim] - z[(k + 1) % dim] * f[k];
          sum[size] += f.norm();
          sum[size + 1] += f.norm() * z.norm();
          for (std::size_t k = 0; k < piece.free.size(); ++k)
            {
              const Tensor<1, dim> v = piece.free[k].a + piece.free[k].B * z;
              sum[power + 3 * k] += f * v;
              sum[power + 3 * k + 1] += f.norm() * v.norm();
              sum[power + 3 * k + 2] += load.area * v.norm();
            }
        }
      Utilities::MPI::sum(sums, comm, sums);

      std::vector<HeldPiece<dim>> list;
      for (unsigned int p = 0; p < n_pieces; ++p)
        {
          const double *const sum   = &sums[n * p];
          const auto         &piece = motions.of_piece(p);
          if (sum[0] == 0.)
            continue;
          bool is_unbalanced = false;
          for (std::size_t k = power; k < power + 3 * piece.free.size(); k += 3)
            is_unbalanced =
              is_unbalanced ||
              std::abs(sum[k]) > std::max(largest_rest * sum[k + 1],
                                          rounding_stress * sum[k + 2]);
          list.push_back({std::uint64_t(std::llround(sum[0])),
                          piece.center,
                          std::uint64_t(std::llround(sum[1])),
                          sum[2] > 0.,
                          unsigned(piece.free.size()),
                          load_text<dim>(sum + force, sum + moment, sum + size),
                          is_unbalanced});
        }
      std::stable_sort(list.begin(),
                       list.end(),
                       [](const HeldPiece<dim> &a, const HeldPiece<dim> &b) {
                         return a.cells > b.cells;
                       });
      return list;
    }

    /** The pieces that hold cells, largest first. Collective. */
    template <int dim>
    std::vector<HeldPiece<dim>>
    held_pieces(const TissueModel<dim>    &model,
                const Founders<dim>       &founders,
                const SurfacePatches<dim> &surface,
                const PiecesAtStart       &at,
                const MPI_Comm             comm)
    {
      // Each rank lists what it has of cells, supports and loads. An expression
      // may have no value on one rank only.
      OnPieces<dim> mine;
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        mine.cells.push_back(
          {at.of_founders[i], founders.positions[i], founders.volumes[i]});
      everywhere(comm,
                 [&]() { add_surface(model, surface, at.of_patches, mine); });
      if (!model.forces.empty())
        for_first_cells<dim>(model,
                             founders,
                             surface,
                             0.,
                             comm,
                             [&](const std::size_t i,
                                 std::vector<double> &,
                                 const PresentCell<dim> &cell) {
                               add_body(model, cell, mine.cells[i], mine);
                             });
      return sums_of(mine, at.n, model.scene.grid.spacing, comm);
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
      const unsigned int       all = FreeMotions<dim>::n_modes;
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
            text << "; loads add up to " << piece.load;
          texts.push_back(text.str());
        }
      if (pieces.size() > most_listed)
        texts.push_back("and " + std::to_string(pieces.size() - most_listed) +
                        " more");
      return texts;
    }

    /** Warns of bodies that stick together from the start, as they are within a
     *  grid spacing of each other. Collective. */
    template <int dim>
    void
    review_bodies(const Scene         &scene,
                  const Founders<dim> &founders,
                  const unsigned int   n_pieces,
                  const MPI_Comm       comm,
                  Review              &review)
    {
      // A shape is one body. The run says when bodies come to stick later. A
      // gap of two of the longest cells counts, one of a single cell does not.
      if (!scene.tissue.is_from_file())
        return;
      Founders<dim> apart(founders);
      apart.volumes.assign(founders.volumes.size(),
                           std::pow(longest_length(founders, comm), dim));
      apart.bodies                = bodies_apart(apart, comm, 2.5);
      const unsigned int n_bodies = number_of_bodies(apart, comm);
      const Key<double> &h        = scene.grid.spacing;
      if (n_bodies > n_pieces)
        review.warn(h.path(),
                    as_text(h) + " um",
                    "the tissue is " + std::to_string(n_bodies) +
                      " bodies, of which the grid makes " +
                      std::to_string(n_pieces) +
                      ": those closer than a grid spacing stick together from "
                      "the start.",
                    "Set Contact/Between = bodies, or Grid/Spacing to less "
                    "than half the gap between them.");
    }

    template <int dim>
    void
    review_held(const std::vector<HeldPiece<dim>> &pieces, Review &review)
    {
      // The first unbalanced piece is told of, with the number of others: all
      // of them stand in the list of pieces.
      const auto is_unbalanced = [](const HeldPiece<dim> &piece) {
        return piece.is_unbalanced;
      };
      const auto first =
        std::find_if(pieces.begin(), pieces.end(), is_unbalanced);
      if (first == pieces.end())
        return;
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
        "the loads add up to " + first->load +
          " at the end, and nothing fixes " + piece.str() +
          " against them: inertia balances them, as in free fall, or "
          "beside obstacles a weak drag (doc/theory.md, section 4.4).",
        "Fix a part of its surface by Fixed where or Slip where, or "
        "balance the loads.");
    }
  } // namespace


  template <int dim>
  std::vector<std::string>
  describe_pieces(const TissueModel<dim> &model,
                  SeededTissue<dim>      &tissue,
                  const MPI_Comm          comm)
  {
    const Scene        &scene = model.scene;
    const PiecesAtStart at =
      pieces_at_start(scene.grid, tissue.founders, tissue.surface, comm);
    const std::vector<HeldPiece<dim>> pieces =
      held_pieces(model, tissue.founders, tissue.surface, at, comm);
    tissue.n_pieces = pieces.size();
    tissue.pieces   = texts_of(pieces);
    Review review;
    if (!model.interaction)
      review_bodies(scene, tissue.founders, at.n, comm, review);
    review_held(pieces, review);
    return review.warnings;
  }


  MORULA_INSTANTIATE(describe_pieces);
} // namespace Morula
