// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/particle_domain.h>
#include <morula/grid/parting.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** Cells whose distance is at most so many edges of each other's box are
     *  neighbours. It is more than √2 or √3, so that a lattice moved at random
     *  keeps its bonds, and less than what joins the second next ones. */
    constexpr double longest_bond = 2.4;

    /** A bond is cut if it crosses a patch at most so many spacings from its
     *  middle. Patches are taken 1.3 times as wide as they stand apart, in 3-D
     *  to the corners of a square, so that no bond slips through a seam. */
    template <int dim>
    constexpr double half_patch = dim == 2 ? 0.65 : 0.92;

    /** In 3-D patches stand irregularly. So one that is farther away, up to
     *  this many spacings, cuts a bond if no other is nearer to the crossing.
     */
    template <int dim>
    constexpr double farthest_patch = dim == 2 ? half_patch<dim> : 1.3;

    /** Patches that are at most so many times as far as the nearest one, in
     *  units of their spacings, are as near. */
    constexpr double about_nearest = 1.2;

    /** The cosine above which two patches belong to one face of the tissue. */
    constexpr double same_face = 0.7;

    /** A surface is near a cell if it is at most so many of its lengths away: a
     *  bond reaches from the first layer to the third one beyond. */
    constexpr double near_surface = 3.;

    /** Cells of a straight chain from the owner of one boundary point to that
     * of another are at most so many of their lengths beside the segment from
     *  point to point. */
    constexpr double beside_chain = 1.5;

    /** A cell has few bonds, and a strand few cells, if they are no more than
     *  these. */
    template <int dim>
    constexpr unsigned int few = (1 << dim) - 1;

    /** A patch near a cell, and how far in front of it the cell's middle is,
     *  µm. */
    struct NearPatch
    {
      unsigned int patch;
      double       height;
    };

    /** Whether the segment from @p x to @p y crosses a patch: one of those
     *  @p near x, which are all that it can cross. */
    template <int dim>
    bool
    crosses(const Point<dim>                    &x,
            const Point<dim>                    &y,
            const std::vector<NearPatch>        &near,
            const std::vector<PartedPatch<dim>> &patches)
    {
      for (const NearPatch &one : near)
        {
          const PartedPatch<dim> &patch = patches[one.patch];
          const double from = one.height, to = (y - patch.x) * patch.n;
          if ((from < 0.) == (to < 0.))
            continue;
          const Point<dim> at      = x + from / (from - to) * (y - x);
          const auto       away_of = [&at](const PartedPatch<dim> &other) {
            return at.distance(other.x) / other.spacing;
          };
          const double away = away_of(patch);
          if (away <= half_patch<dim> ||
              (away <= farthest_patch<dim> &&
               std::all_of(near.begin(), near.end(), [&](const NearPatch &i) {
                 return away <= about_nearest * away_of(patches[i.patch]);
               })))
            return true;
        }
      return false;
    }

    constexpr unsigned int no_patch = numbers::invalid_unsigned_int;

    /** The patches in front of each cell that are nearest and near, for want of
     *  one no_patch. There is one for each face of an edge or corner, as the
     *  surface of another side of the tissue may be nearer to a cell than the
     *  gap. */
    template <int dim>
    std::vector<std::array<unsigned int, dim>>
    faces_above(const std::vector<PartedCell<dim>>  &cells,
                const std::vector<double>           &lengths,
                const std::vector<PartedPatch<dim>> &patches,
                const PointBins<dim>                &bins_of_patches)
    {
      // The faces are found one after the other, from the nearest on; of
      // several patches as near the first counts. A further face is behind
      // those that are nearer: what is before them is the gap around whose end
      // the tissue goes on.
      std::vector<std::array<unsigned int, dim>> above(cells.size());
      for (unsigned int p = 0; p < cells.size(); ++p)
        {
          above[p].fill(no_patch);
          const auto is_of_another_face = [&](const PartedPatch<dim> &patch,
                                              const unsigned int      k) {
            return std::all_of(
              &above[p][0], &above[p][k], [&](const unsigned int j) {
                return patch.n * patches[j].n <= same_face &&
                       (patch.x - patches[j].x) * patches[j].n < 0.;
              });
          };
          for (unsigned int k = 0;
               k < dim && (k == 0 || above[p][k - 1] != no_patch);
               ++k)
            {
              double nearest = 0.;
              bins_of_patches.visit_within(
                cells[p].x,
                near_surface * lengths[p],
                [&](const unsigned int i) {
                  const double distance =
                    cells[p].x.distance_square(patches[i].x);
                  if ((cells[p].x - patches[i].x) * patches[i].n < 0. &&
                      (above[p][k] == no_patch || distance < nearest ||
                       (distance == nearest && i < above[p][k])) &&
                      is_of_another_face(patches[i], k))
                    {
                      above[p][k] = i;
                      nearest     = distance;
                    }
                });
            }
        }
      return above;
    }

    /** A bond that a patch cuts: its length by the edges of its first cell's
     *  box, and the two cells. */
    using CutBond = std::tuple<double, unsigned int, unsigned int>;

    /**
     * Gives cells with few @p bonds some of those back that have been @p cut,
     * the shortest first. Where a surface has crumpled it cuts cells off on all
     * sides, which nothing would hold then. A bond comes back that joins a
     * strand of few cells to others, or two cells that have a neighbour in
     * common: so no two sides of a gap are joined.
     */
    template <int dim>
    void
    restore(std::vector<CutBond>                    cut,
            std::vector<std::vector<unsigned int>> &bonds)
    {
      const auto is_of_few = [&bonds](const unsigned int p) {
        std::vector<unsigned int> strand(1, p);
        for (std::size_t i = 0; i < strand.size() && strand.size() <= few<dim>;
             ++i)
          for (const unsigned int q : bonds[strand[i]])
            if (std::find(strand.begin(), strand.end(), q) == strand.end())
              strand.push_back(q);
        return strand.size() <= few<dim>;
      };
      const auto is_restored = [&](const CutBond &bond) {
        const auto &[length, p, q]   = bond;
        std::vector<unsigned int> &a = bonds[p], &b = bonds[q];
        if (std::min(a.size(), b.size()) > few<dim> ||
            (std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) ==
               a.end() &&
             !is_of_few(p) && !is_of_few(q)))
          return false;
        a.push_back(q);
        b.push_back(p);
        return true;
      };
      // A bond that comes back can give others a neighbour in common.
      std::sort(cut.begin(), cut.end());
      for (auto end = cut.end(), last = end;; last = end)
        if (end = std::remove_if(cut.begin(), last, is_restored); end == last)
          return;
    }
  } // namespace


  template <int dim>
  Parting<dim>::Parting(const GridBox<dim>                  &box,
                        std::vector<unsigned int>            contested,
                        const std::vector<PartedCell<dim>>  &cells,
                        const std::vector<PartedPatch<dim>> &patches)
    : contested_(std::move(contested))
  {
    for (const PartedCell<dim> &cell : cells)
      {
        places.emplace(cell.id, positions.size());
        positions.push_back(cell.x);
        lengths.push_back(invert(cell.from_edges).norm() / std::sqrt(1. * dim));
      }
    for (const PartedPatch<dim> &patch : patches)
      patches_at.emplace(patch.id, patch.x);
    marks.assign(cells.size(), 0);
    bond(box, cells, patches);
    find_owners(box, cells, patches);
    find_parts(box, cells, patches);
  }


  template <int dim>
  void
  Parting<dim>::bond(const GridBox<dim>                  &box,
                     const std::vector<PartedCell<dim>>  &cells,
                     const std::vector<PartedPatch<dim>> &patches)
  {
    // Cells are neighbours by their distance in units of their own boxes, so
    // that flat and long ones keep theirs. A bond between neighbours is cut by
    // any patch that its segment crosses, whichever side's it is. A single bond
    // that slips through between irregular patches would weld two surfaces. So
    // a bond is also cut if the surfaces above its two cells face each other
    // and each cell is beyond that of the other.
    std::vector<Point<dim>> places_of_patches;
    double                  widest = 0.;
    for (const PartedPatch<dim> &patch : patches)
      {
        places_of_patches.push_back(patch.x);
        widest = std::max(widest, patch.spacing);
      }
    const PointBins<dim> bins(box, positions),
      bins_of_patches(box, places_of_patches);
    const auto is_near = [](const PartedCell<dim> &cell,
                            const Tensor<1, dim>  &distance) {
      return (cell.from_edges * distance).norm() <= longest_bond;
    };
    const auto above = faces_above(cells, lengths, patches, bins_of_patches);
    const auto is_across = [&](const unsigned int p, const unsigned int q) {
      for (const unsigned int i : above[p])
        for (const unsigned int j : above[q])
          if (i != no_patch && j != no_patch &&
              patches[i].n * patches[j].n < facing &&
              (cells[q].x - patches[i].x) * patches[i].n > 0. &&
              (cells[p].x - patches[j].x) * patches[j].n > 0.)
            return true;
      return false;
    };
    // As many cells of a lattice are within the longest bond.
    constexpr unsigned int usual = dim == 2 ? 20 : 56;
    bonds.resize(cells.size());
    for (std::vector<unsigned int> &list : bonds)
      list.reserve(usual);
    std::vector<NearPatch> around;
    std::vector<CutBond>   cut;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        // The smaller of the two relative distances counts. The search is as
        // wide as the cell's own box reaches; the partner looks, too. All
        // patches that a bond can cross are found once for the cell.
        const double farthest =
          longest_bond * largest_stretch_bound(invert(cells[p].from_edges));
        around.clear();
        bins_of_patches.visit_within(
          positions[p],
          farthest + farthest_patch<dim> * widest,
          [&](const unsigned int i) {
            around.push_back({i, (positions[p] - patches[i].x) * patches[i].n});
          });
        bins.visit_within(positions[p], farthest, [&](const unsigned int q) {
          const Tensor<1, dim> distance = cells[q].x - cells[p].x;
          if (q == p || cells[q].body != cells[p].body ||
              !is_near(cells[p], distance) ||
              (q < p && is_near(cells[q], distance)))
            return;
          if (is_across(p, q) ||
              crosses(cells[p].x, cells[q].x, around, patches))
            cut.emplace_back((cells[p].from_edges * distance).norm(), p, q);
          else
            {
              bonds[p].push_back(q);
              bonds[q].push_back(p);
            }
        });
      }
    restore<dim>(std::move(cut), bonds);
    for (std::vector<unsigned int> &list : bonds)
      std::sort(list.begin(), list.end());
  }


  template <int dim>
  void
  Parting<dim>::find_owners(const GridBox<dim>                  &box,
                            const std::vector<PartedCell<dim>>  &cells,
                            const std::vector<PartedPatch<dim>> &patches)
  {
    // The nearest cell alone would often be one across the gap. The search
    // grows until it finds a cell of the patch's body behind it.
    if (cells.empty())
      return;
    const PointBins<dim> bins(box, positions);
    for (const PartedPatch<dim> &patch : patches)
      {
        unsigned int owner   = cells.size();
        double       nearest = 0.;
        for (double reach = 2. * patch.spacing;
             owner == cells.size() && reach < 100. * patch.spacing;
             reach *= 2.)
          bins.visit_within(patch.x, reach, [&](const unsigned int p) {
            const Tensor<1, dim> distance = cells[p].x - patch.x;
            if (cells[p].body != patch.body || distance * patch.n >= 0.)
              return;
            const double length = distance.norm();
            if (owner == cells.size() || length < nearest ||
                (length == nearest && p < owner))
              {
                owner   = p;
                nearest = length;
              }
          });
        if (owner < cells.size())
          owners.emplace(patch.id, owner);
      }
  }



  template <int dim>
  bool
  Parting<dim>::are_connected(const types::particle_index a,
                              const types::particle_index b) const
  {
    // A search along bonds that stays in the ball, and goes on from the cell
    // that is nearest to the one it looks for: in one strand it arrives after a
    // few cells. Marks of earlier searches need not be removed.
    const auto first = owners.find(a), last = owners.find(b);
    if (first == owners.end() || last == owners.end() ||
        first->second == last->second)
      return true;
    const Point<dim> &x = patches_at.at(a), &y = patches_at.at(b);
    const Point<dim>  middle = x + 0.5 * (y - x);
    const double      radius =
      0.5 * x.distance(y) +
      beside_chain * std::max(lengths[first->second], lengths[last->second]);
    const Point<dim> &wanted = positions[last->second];
    std::priority_queue<std::pair<double, unsigned int>> queue;
    ++mark;
    const auto add = [&](const unsigned int q) {
      if (marks[q] == mark)
        return;
      marks[q] = mark;
      queue.emplace(-wanted.distance_square(positions[q]), q);
    };
    add(first->second);
    while (!queue.empty())
      {
        const unsigned int p = queue.top().second;
        queue.pop();
        for (const unsigned int q : bonds[p])
          {
            if (q == last->second)
              return true;
            if (positions[q].distance_square(middle) <= radius * radius)
              add(q);
          }
      }
    return false;
  }


  template class Parting<2>;
  template class Parting<3>;
} // namespace Morula
