// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_seeding_h
#define morula_seeding_seeding_h

#include <morula/base/key.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/particles/property_pool.h>

#include <mpi.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Paths of the keys that name files. The code that reads the files sees no
   *  more of the scene. */
  namespace TissueKeys
  {
    inline const std::string surface_mesh   = "Tissue/Surface mesh";
    inline const std::string points_file    = "Tissue/Points file";
    inline const std::string points_surface = "Tissue/Points surface";
    inline const std::string cuts           = "Tissue/Cuts";
  } // namespace TissueKeys

  /** Section "Tissue": the initial tissue. */
  struct TissueParameters : public Keys
  {
    TissueParameters();

    Key<std::string>         shape;
    Key<std::vector<double>> center;
    Key<double>              radius;
    Key<double>              inner_radius;
    Key<std::vector<double>> size;
    Key<std::string>         surface_mesh;
    Key<std::string>         points_file;
    Key<std::string>         points_surface;
    Key<double>              closed_gap;
    Key<std::string>         cuts;
    Key<double>              cell_spacing;
    Key<std::vector<double>> lattice_offset;
    Key<std::string>         surface_cells;
    Key<unsigned int>        boundary_points;
    Key<bool>                refine_surface;
    Key<bool>                coarsen_surface;
    Key<double>              renew_surface;

    using Keys::list;
    KeyList
    list() override;

    /**
     * Refuses contradictions (missing mesh file, shape without cells, shapes
     * that do not exist in @p dim dimensions, ...).
     * @throws InputError
     */
    void
    check(const unsigned int dim) const;

    /** Whether the shape has a Radius. */
    bool
    has_radius() const
    {
      return shape == "sphere" || shape == "cylinder";
    }

    /** Whether Size is an extent of the shape in direction @p d. */
    bool
    has_size(const unsigned int d) const;

    /** Whether the cells fill a closed surface from a file. */
    bool
    is_mesh() const
    {
      return shape == "mesh";
    }

    /** Whether the cells themselves come from a file. */
    bool
    is_points() const
    {
      return shape == "points";
    }

    /** Whether the tissue comes from a file, and may lie anywhere. */
    bool
    is_from_file() const
    {
      return is_mesh() || is_points();
    }

    /** Whether there are no boundary points. */
    bool
    has_no_surface() const
    {
      return is_points() && points_surface == "none";
    }

    /** Whether the tissue is cut at t = 0. */
    bool
    has_cuts() const
    {
      return !cuts.value().empty();
    }

    /** Whether the surface around the cells comes from a file, too. */
    bool
    has_surface_file() const
    {
      return is_points() && points_surface != "automatic" &&
             points_surface != "always" && points_surface != "none";
    }
  };

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
    /** Room without cells that a surface around points has closed, about,
     *  µm^dim; the same on all ranks. */
    double closed_room = 0.;
  };

  /**
   * Limits of a tissue from a file: how far it may reach, how large its cells
   * may be, and which types they may have. With one vertex or cell far away
   * from all others, the grid between them would not fit into memory. Lengths
   * in µm.
   */
  template <int dim>
  struct SeedingLimits
  {
    /** Largest absolute value of a coordinate. */
    double farthest = std::numeric_limits<double>::infinity();
    /** Largest extent along an axis. */
    double extent = std::numeric_limits<double>::infinity();
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

  /** Tiles the shape's surface. Points from a file have none: for one around
   *  them see seed_points_surface(). */
  template <int dim>
  SurfacePatches<dim>
  seed_surface(const TissueParameters &parameters, const MPI_Comm comm);
} // namespace Morula

#endif
