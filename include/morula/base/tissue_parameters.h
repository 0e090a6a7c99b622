// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_tissue_parameters_h
#define morula_base_tissue_parameters_h

#include <morula/base/key.h>

#include <string>
#include <vector>

namespace Morula
{
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
                       "Radius of a sphere or cylinder. Units: um."};

    Key<double> inner_radius{
      {this, "Tissue/Inner radius"},
      0.,
      "Radius of the cavity in the middle of a sphere; 0: there is none. "
      "Units: um."};

    Key<std::vector<double>> size{
      {this, "Tissue/Size"},
      {200., 200., 200.},
      "Full edge lengths of a box, full axes of an ellipsoid; the third is "
      "the height of a cylinder, whose axis is z. Units: um."};

    Key<std::string> surface_mesh{
      {this, TissueKeys::surface_mesh},
      "",
      "For the shape mesh: file with a closed surface in um, as "
      "STL, OFF, PLY or OBJ."};

    Key<std::string> points_file{
      {this, TissueKeys::points_file},
      "",
      "For the shape points: CSV file of the cells with a header line that "
      "names the columns in any order: x,y,z (2-D: z may be missing) in um; "
      "volume in um^3 (2-D: um^2), without it that of the Cell spacing; "
      "generation, divisions since the founder, without it 0; phase of the "
      "cell cycle, 0 G0, 1 S, 2 G2, 4 G1, 9 never, in which the cell begins "
      "at a random point, without it as Start says; type, a name in Cell "
      "types/Names or its number from 0 on, without it as Where says."};

    Key<std::string> points_surface{
      {this, TissueKeys::points_surface},
      "automatic",
      "For the shape points: whether there is a surface around the cells, "
      "with boundary points that can be fixed and loaded. automatic: where "
      "the scene has a boundary condition, or a key asks for the depth below "
      "the surface or its normal. always: also without one. It lies where "
      "the cells end, and encloses their volume. Or the file of the closed "
      "surface around the cells in um, cavities and all: STL, OFF, PLY or "
      "OBJ; in 2-D polygons as well-known text, WKT."};

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
      2.,
      "Of surfaces around cells: cavities with less room than a cube (2-D: a "
      "square) of this edge are filled, others have a surface of their own. "
      "Units: cell lengths."};

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
      "trimmed",
      "Cells at a surface that cuts through the lattice. whole: each has the "
      "volume L_p^3 at its place on the lattice, the paper's. trimmed: each "
      "has the volume and the centroid of its part of the shape, so that the "
      "volumes add up to the shape's and smooth problems converge with "
      "second order. Without effect on points.",
      {"whole|trimmed"}};

    Key<unsigned int> boundary_points{
      {this, "Tissue/Boundary points"},
      0,
      "Number of points on the surface, as nearly as the shape allows. 0: "
      "one per L_p^2 of surface (2-D: L_p), and around points one for each "
      "cell of a lattice of a third of Grid/Spacing, or of the length of a "
      "cell if that is shorter, that the surface crosses. Another number "
      "makes that lattice finer or coarser, and the surface less or more "
      "smooth with it."};

    Key<bool> refine_surface{
      {this, "Tissue/Refine surface"},
      true,
      "Split boundary points whose patch has become longer than half a grid "
      "cell, as where tissue grows. Area and normal are kept."};

    Key<bool> coarsen_surface{
      {this, "Tissue/Coarsen surface"},
      false,
      "Merge boundary points whose patch has shrunk to less than half of its "
      "area at t = 0, and split it again where it is twice that, for tissue "
      "that shrinks. Area and enclosed volume are kept. Needs Refine "
      "surface."};

    Key<std::string> surface{
      {this, "Tissue/Surface"},
      "automatic",
      "How the surface follows the tissue. tracked: its points are carried "
      "along, and only where cells are lost new ones close it. from cells: "
      "it is made anew around the cells when it has moved by half a cell of "
      "its lattice, and when points were lost; Fixed where and Slip where "
      "then act at the places of t = 0. automatic: from cells where cells "
      "exchange places, where tissue flows and loses cells, and where it "
      "flows and is fixed nowhere; tracked otherwise, with Traction where, "
      "with folds that never fuse (Contact/Between = all) and with Method = "
      "paper.",
      {"automatic|tracked|from cells"}};

    Key<std::string> redistribution{
      {this, "Tissue/Redistribution"},
      "automatic",
      "Whether cells keep places and volumes that fit each other. Cells of a "
      "body that come nearer to each other than their volumes allow move apart, "
      "where they divide, grow by type, flow or exchange places; and volumes "
      "follow the space that cells have, where pooled or projected tissue "
      "flows: automatic. true: the first everywhere, the second as with "
      "automatic. false: neither, as with Method = paper.",
      {"automatic|true|false"}};

    Key<double> renew_surface{
      {this, "Tissue/Renew surface"},
      0.,
      "Without effect since 0.3.0: see Surface. Units: day.",
      {0.}};

    /**
     * Refuses contradictions (missing mesh file, shape without cells, shapes
     * that do not exist in @p dim dimensions, ...).
     * @throws InputError
     */
    void
    check(const unsigned int dim) const;

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
} // namespace Morula

#endif
