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

    Key<std::string> shape{
      {this, "Tissue/Shape"},
      "sphere",
      "The initial tissue. In 2-D a sphere is a disc and a box a "
      "rectangle; cylinder and mesh exist in 3-D only.",
      {"sphere|box|ellipsoid|cylinder|mesh|points"}};

    Key<std::vector<double>> center{
      {this, "Tissue/Center"},
      {0., 0., 0.},
      "Center of the shape. A surface mesh stays where its "
      "file has it; only the lattice of cells moves with Center. "
      "Without effect on points. Units: um."};

    Key<double> radius{{this, "Tissue/Radius"},
                       250.,
                       "Of a sphere or cylinder. Units: um."};

    Key<double> inner_radius{
      {this, "Tissue/Inner radius"},
      0.,
      "Of a sphere: of the cavity around its center; 0: there is "
      "none. Units: um."};

    Key<std::vector<double>> size{
      {this, "Tissue/Size"},
      {200., 200., 200.},
      "Full edge lengths of a box, full axes of an ellipsoid; the "
      "third is the height of a cylinder, which stands along z. "
      "Units: um."};

    Key<std::string> surface_mesh{
      {this, TissueKeys::surface_mesh},
      "",
      "For the shape mesh: file with a closed surface in um, as "
      "STL, OFF, PLY or OBJ."};

    Key<std::string> points_file{
      {this, TissueKeys::points_file},
      "",
      "For the shape points: CSV file of the cells with a header "
      "line that names the columns in any order: x,y,z (2-D: z may "
      "be missing) in um; volume in um^3 (2-D: um^2), without it "
      "that of the Cell spacing; generation, divisions since the "
      "founder, without it 0; phase of the cell cycle, 0 G0, 1 S, 2 G2, 4 "
      "G1, 9 never, in which the cell begins at a point that is drawn, "
      "without it as Start says; type, a name in Cell types/Names or "
      "its number from 0 on, without it as Where says."};

    Key<std::string> points_surface{
      {this, TissueKeys::points_surface},
      "automatic",
      "For the shape points: whether there is a surface around the cells, "
      "with boundary points that can be held and loaded. automatic: where "
      "the scene has a boundary condition, or a key asks for the depth below "
      "the surface or its normal. always: also without one. It "
      "stands where the cells end, and encloses their volume. Gaps and "
      "cavities narrower than Closed gap are closed. Or the file of the "
      "closed surface around the cells in um, cavities and all: STL, OFF, "
      "PLY or OBJ; in 2-D polygons as well-known text, WKT."};

    Key<std::string> cuts{
      {this, TissueKeys::cuts},
      "",
      "File with cuts of no width through the tissue at t = 0, in um: in "
      "2-D lines as well-known text, WKT; in 3-D open surfaces as STL, "
      "OFF, PLY or OBJ. Their two faces are surface, and open or press on "
      "each other. They run between cells, and what lies outside of the "
      "tissue is left out. Needs Contact/Between = all."};

    Key<double> closed_gap{
      {this, "Tissue/Closed gap"},
      4.,
      "For the shape points: width of gaps and cavities that an "
      "automatic surface closes; from 2 on. Units: cell lengths.",
      {2.}};

    Key<double> cell_spacing{
      {this, "Tissue/Cell spacing"},
      10.,
      "L_p: cells sit on a regular lattice of this spacing, "
      "each with the volume L_p^3 (2-D: L_p^2). Units: um."};

    Key<std::vector<double>> lattice_offset{
      {this, "Tissue/Lattice offset"},
      {0., 0., 0.},
      "Shifts the lattice of cells against the shape. Without "
      "effect on points. Units: um."};

    Key<std::string> surface_cells{
      {this, "Tissue/Surface cells"},
      "whole",
      "Cells at a surface that cuts through the lattice. whole: each has the "
      "volume L_p^3 at its place on the lattice, the paper's. trimmed: each "
      "has the volume and the centroid of its part of the shape, so that the "
      "volumes add up to the shape's and smooth problems converge with "
      "second order. Without effect on points.",
      {"whole|trimmed"}};

    Key<unsigned int> boundary_points{
      {this, "Tissue/Boundary points"},
      0,
      "Number of points on the surface, met as nearly as the "
      "shape allows; 0: one per L_p^2 of surface (2-D: L_p)."};

    Key<bool> refine_surface{
      {this, "Tissue/Refine surface"},
      false,
      "Split boundary points whose patch has become longer than half a grid "
      "cell, for tissue that grows to several times its size. Area and "
      "normal are kept; false is the paper's method."};

    Key<bool> coarsen_surface{
      {this, "Tissue/Coarsen surface"},
      false,
      "Merge boundary points whose patch has shrunk to less than half of its "
      "area at t = 0, and split it again where it is twice that, for tissue "
      "that shrinks. Area and enclosed volume are kept. Needs Refine "
      "surface."};

    Key<double> renew_surface{
      {this, "Tissue/Renew surface"},
      0.,
      "Time after which the surface is made anew around the cells, as around "
      "points from a file, and at once when boundary points have lost "
      "the cells near them or are carried off: for tissue that is lost, parts, joins or turns over. "
      "Points that are held stay. 0: never. Needs Coarsen surface. Units: "
      "day.",
      {0.}};

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
   * moment; then for two cells at one place, a cell far away from all others,
   * and a file without cells
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

  /** Longest tissue along an axis, in units of h. A box of this length in all
   *  directions is more than any machine holds. In one direction it is some
   *  metres of tissue, and nearly always due to a single stray point. */
  constexpr double longest_tissue = 1000.;

  /** Longest cell, in units of h. A cell deforms as a whole, and one of this
   *  length takes longest_cell^dim quadrature points. */
  constexpr double longest_cell = 10.;

  /**
   * Refuses shapes and cells whose lengths, as the scene gives them, are beyond
   * these limits on a grid of spacing @p h (µm).
   * @throws InputError
   */
  void
  check_lengths(const TissueParameters &tissue,
                const double            h,
                const unsigned int      dim);

  /** Refuses a tissue of so many cells, with this volume (µm^dim), on a grid of
   *  so many grid cells, if the machines' memory cannot hold it. Collective. */
  using MemoryCheck =
    std::function<void(const double, const double, const double)>;

  /** The limits for tissue from files on a grid of spacing @p h (µm). */
  template <int dim>
  SeedingLimits<dim>
  seeding_limits(const TissueParameters &tissue,
                 const double            h,
                 const MemoryCheck      &check_memory);
} // namespace Morula

#endif
