// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_seeding_h
#define morula_seeding_seeding_h

#include <morula/base/tissue_parameters.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/particles/property_pool.h>

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * The founders that one rank seeds. Founders have the numbers 0...N-1 in the
   * order of the lattice, x fastest. Each rank holds consecutive numbers, so
   * that no rank holds all founders.
   */
  template <int dim>
  struct Founders
  {
    types::particle_index   first_id = 0;
    std::vector<Point<dim>> positions; // µm
    std::vector<double>     volumes;   // µm^dim
    types::particle_index   n_global = 0;
    /** Divisions since the founder; empty if the file does not say. */
    std::vector<unsigned int> generations;
    /** Phases of the cell cycle: 0 G0, 1 S, 2 G2, 4 G1, 9 never; empty
     *  likewise. */
    std::vector<unsigned int> phases;
    /** Numbers of their types, in the order of SeedingLimits::types; empty
     *  likewise. */
    std::vector<unsigned int> types;
    /** Numbers of their bodies; empty without contact. */
    std::vector<unsigned int> bodies;
    /** Columns of their file that say nothing about cells here. */
    std::vector<std::string> skipped_columns;
  };

  /** One patch of a tissue's initial surface. */
  template <int dim>
  struct SurfacePatch
  {
    /** Centre: a point of the surface that is on no edge or corner; µm. */
    Point<dim> position;
    /** Outward unit normal. */
    Tensor<1, dim> normal;
    /** µm^(dim-1) */
    double area;
  };

  /**
   * The boundary points that one rank seeds. They are the centres of patches
   * that tile the tissue's surface, with outward unit normal and area. The
   * areas add up to the exact area of the surface.
   */
  template <int dim>
  struct SurfacePatches
  {
    types::particle_index       first_id = 0;
    std::vector<Point<dim>>     positions; // µm
    std::vector<Tensor<1, dim>> normals;
    std::vector<double>         areas; // µm^(dim-1)
    types::particle_index       n_global = 0;
    /** Numbers of their bodies; empty without contact. */
    std::vector<unsigned int> bodies;
    /** Of a surface around points: the volume of the cavities that it has
     *  filled, µm^dim, and how many cells are outside of it; the same on all
     *  ranks. */
    double        filled    = 0.;
    std::uint64_t n_outside = 0;

    /** Adds a patch at the end. */
    void
    add(const SurfacePatch<dim> &patch)
    {
      positions.push_back(patch.position);
      normals.push_back(patch.normal);
      areas.push_back(patch.area);
    }
  };

  /**
   * Limits of a tissue from a file: how far away it may be, how large its cells
   * may be, and which types they may have. Lengths in µm.
   */
  template <int dim>
  struct SeedingLimits
  {
    /** Largest absolute value of a coordinate. */
    double farthest = std::numeric_limits<double>::infinity();
    /** Largest V^(1/dim) of a cell. */
    double cell_length = std::numeric_limits<double>::infinity();
    /** Names of the types of cells; empty: there are none. */
    std::vector<std::string> types;
    /**
     * Refuses a tissue that keeps to these limits but does not fit into memory.
     * It is called before the cells are processed, with their bounding box,
     * number and volume (µm^dim). Collective.
     */
    std::function<void(const BoundingBox<dim> &, const double, const double)>
      check_memory;
  };

  /**
   * Fills the shape with the regular lattice of section 2.5 of the paper, or
   * reads the cells from a file.
   * @throws InputError if no cell fits, or if a file exceeds the limits
   */
  template <int dim>
  Founders<dim>
  seed_founders(const TissueParameters   &parameters,
                const MPI_Comm            comm,
                const SeedingLimits<dim> &limits = {});

  /**
   * Reads this rank's part of the cells in a CSV file. Its header line names
   * the columns in any order: x, y, in 3-D z, in µm, volume, in µm^dim,
   * generation, phase and type; others are skipped. Entries are separated by
   * commas. Without a column of volumes every cell has @p default_volume. In
   * 2-D a column z is allowed if it holds only zeros. Blank lines and lines
   * that begin with # are skipped. The order of the rows is the order of the
   * ids. Rank 0 reads the file. Collective.
   * @throws InputError on all ranks with the file's first bad line and column:
   * values that are no numbers, wrong columns, volumes that are not positive,
   * generations that are no whole number, a cell beyond the limits, a second
   * moment; then for two cells at one place, and a file without cells
   */
  template <int dim>
  Founders<dim>
  read_points(const std::string        &file,
              const double              default_volume,
              const MPI_Comm            comm,
              const SeedingLimits<dim> &limits = {});

  /** Tiles the shape's surface. Points from a file have none: for one around
   *  them see seed_points_surface(). */
  template <int dim>
  SurfacePatches<dim>
  seed_surface(const TissueParameters &parameters, const MPI_Comm comm);


  /** Largest distance from the origin, in units of h. Farther out positions
   *  lose their digits, and grid cells are counted by integers. */
  constexpr double farthest_place = 1e8;

  /** Longest cell, in units of h. A cell deforms as a whole, and one of this
   *  length takes longest_cell^dim quadrature points. */
  constexpr double longest_cell = 10.;

  /**
   * Refuses tissue that fills next to nothing of the grid around it, as with
   * one vertex or cell that lies astray.
   * @param h       spacing of the grid, µm
   * @param cells, volume how many cells there are, and their volume, µm^dim
   * @return the number of the grid's cells
   * @throws InputError
   */
  template <int dim>
  double
  check_filled(const TissueParameters &tissue,
               const double            h,
               const BoundingBox<dim> &box,
               const double            cells,
               const double            volume);


  /**
   * Adds to the surface both faces of cuts that have no width: each patch of a
   * cut becomes two at one place with opposite normals, about as large as those
   * of the surface. What lies outside of the tissue is left out. Collective.
   * @param file its cuts at t = 0, in µm: in 2-D lines as well-known text
   * (WKT), in 3-D open surfaces of triangles as STL, OFF, PLY or OBJ
   * @return how far the tissue is cut, in words
   * @throws InputError if the file cannot be read, or cuts no tissue
   */
  template <int dim>
  std::string
  add_cuts(const Key<std::string> &file,
           const Founders<dim>    &founders,
           const MPI_Comm          comm,
           SurfacePatches<dim>    &surface);
} // namespace Morula

#endif
