// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_parting_h
#define morula_grid_parting_h

#include <morula/grid/grid_box.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/particles/property_pool.h>

#include <algorithm>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A cell as the parting sees it. */
  template <int dim>
  struct PartedCell
  {
    types::particle_index id;
    unsigned int          body;
    Point<dim>            x;            // µm
    Tensor<2, dim>        from_edges;   // A⁻¹ of its edges A, 1/µm
    Point<dim>            lower, upper; // bounds of its domain, µm
  };

  /** A boundary point as the parting sees it. */
  template <int dim>
  struct PartedPatch
  {
    types::particle_index id;
    unsigned int          body;
    Point<dim>            x;       // µm
    Tensor<1, dim>        n;       // outward unit normal
    double                spacing; // to its neighbours, µm
  };

  /** A part of the tissue in a grid cell: the number of the grid cell in the
   *  grid's box, and of the part among those of this grid cell. */
  using GridCellPart = std::pair<unsigned int, unsigned int>;

  /**
   * Which tissue belongs together where surfaces face each other across a gap:
   * doc/theory.md, section 3.3a. A grid cell near such a gap is *contested*.
   * Two cells are *bonded* if they are neighbours and no patch of the surface
   * stands between them. The cells that reach into a contested grid cell form
   * parts, those that bonds inside of it connect. Parts of two grid cells that
   * touch are linked if they share a cell or a bond joins them. Everywhere else
   * a grid cell has one part, 0, which is linked with all that it touches.
   *
   * All ranks have the same parting. It follows from the configuration alone,
   * so it keeps no history: what has met can part again.
   */
  template <int dim>
  class Parting
  {
  public:
    /** Two patches face each other if the product of their normals is below
     *  this, doc/theory.md (4.8k). */
    static constexpr double facing = -0.3;

    /** No grid cell is contested. */
    Parting() = default;

    /**
     * @param contested numbers of grid cells, increasing; see
     *        contested_grid_cells()
     * @param cells   those whose domains reach into grid cells that touch a
     *                contested one, of all ranks, by id
     * @param patches those near contested grid cells, of all ranks, by id
     */
    Parting(const GridBox<dim>                  &box,
            std::vector<unsigned int>            contested,
            const std::vector<PartedCell<dim>>  &cells,
            const std::vector<PartedPatch<dim>> &patches);

    /** Whether no grid cell is contested. */
    bool
    is_trivial() const
    {
      return contested_.empty();
    }

    /** Whether a grid cell is contested. */
    bool
    is_contested(const unsigned int number) const
    {
      return std::binary_search(contested_.begin(), contested_.end(), number);
    }

    /** All parts but those with number 0, in order. */
    const std::vector<GridCellPart> &
    further_parts() const
    {
      return further;
    }

    /** Whether two parts, of one grid cell or of two that touch, are linked. A
     *  part is linked with itself. */
    bool
    are_linked(const GridCellPart &a, const GridCellPart &b) const
    {
      if (!is_contested(a.first) && !is_contested(b.first))
        return true;
      return a == b || std::binary_search(links.begin(),
                                          links.end(),
                                          std::make_pair(a, b));
    }

    /** The part of a grid cell that a cell belongs to. */
    unsigned int
    part_of_cell(const types::particle_index id,
                 const unsigned int          number) const
    {
      const auto place = places.find(id);
      if (place == places.end())
        return 0;
      for (unsigned int i = first_of_cells[place->second];
           i < first_of_cells[place->second + 1];
           ++i)
        if (const auto &[there, part] = parts[parts_of_cells[i]];
            there == number)
          return part;
      return 0;
    }

    /** The part of its grid cell that a boundary point belongs to: that of the
     *  nearest cell behind it. */
    unsigned int
    part_of_patch(const types::particle_index id) const
    {
      const auto part = parts_of_patches.find(id);
      return part == parts_of_patches.end() ? 0 : part->second;
    }

    /** Whether bonds connect the cells behind two boundary points inside a ball
     *  around the middle of these, which is wide enough for a straight chain of
     *  cells from one to the other. Then the points belong to one strand, and
     *  their facing each other is no contact. So do points whose surroundings
     *  are not contested. */
    bool
    are_connected(const types::particle_index a,
                  const types::particle_index b) const;

  private:
    void
    bond(const GridBox<dim>                  &box,
         const std::vector<PartedCell<dim>>  &cells,
         const std::vector<PartedPatch<dim>> &patches);
    void
    find_owners(const GridBox<dim>                  &box,
                const std::vector<PartedCell<dim>>  &cells,
                const std::vector<PartedPatch<dim>> &patches);
    void
    find_parts(const GridBox<dim>                  &box,
               const std::vector<PartedCell<dim>>  &cells,
               const std::vector<PartedPatch<dim>> &patches);

    void
    link(const GridBox<dim> &box);

    std::vector<unsigned int> contested_;
    std::vector<GridCellPart> further;
    /** Pairs of linked parts, both ways, sorted; of which one is contested. */
    std::vector<std::pair<GridCellPart, GridCellPart>> links;
    /** The parts of grid cells; places in this list by cell; and where those of
     *  each cell begin, and the end. */
    std::vector<GridCellPart> parts;
    std::vector<unsigned int> parts_of_cells, first_of_cells;
    std::unordered_map<types::particle_index, unsigned int> places; // by id
    std::unordered_map<types::particle_index, unsigned int> parts_of_patches;
    /** Place of the cell behind each patch, by the patch's id. */
    std::unordered_map<types::particle_index, unsigned int> owners;
    std::vector<std::vector<unsigned int>>                  bonds; // by place
    std::vector<Point<dim>>                                 positions;
    std::vector<double>                                     lengths;
    std::unordered_map<types::particle_index, Point<dim>>   patches_at;
    mutable std::vector<unsigned int> marks; // of are_connected(), by place
    mutable unsigned int              mark = 0;
  };

  /** The parting of a step, which several rooms keep. */
  template <int dim>
  using SharedParting = std::shared_ptr<const Parting<dim>>;

  /**
   * Grid cells that have two patches in their surroundings, the grid cells that
   * touch them, which face each other across a gap: nearly opposite normals,
   * and the other one in front. Their numbers, increasing. Also those around
   * which stand patches of two bodies.
   * @param overlap how deep the two may be in each other, µm; the sides of a
   *        sheet that is thicker do not count
   */
  template <int dim>
  std::vector<unsigned int>
  contested_grid_cells(const GridBox<dim>                  &box,
                       const std::vector<PartedPatch<dim>> &patches,
                       const double                         overlap);
} // namespace Morula

#endif
