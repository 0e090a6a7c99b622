// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/seeding/lattice.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/patterns.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace Morula
{
  TissueParameters::TissueParameters()
  {
    surface_cells.with("paper", "whole");
    refine_surface.with("paper", "false");
    surface.with("paper", "tracked");
    redistribution.with("paper", "false");
    const std::string is = shape.path() + "=";
    radius.needs({is + "sphere", is + "cylinder"});
    inner_radius.needs({is + "sphere"});
    size.needs({is + "box", is + "ellipsoid", is + "cylinder"});
    points_surface.needs({is + "points"});
    // These keys name files, which are looked for beside the scene as well.
    for (Key<std::string> *key :
         {&surface_mesh, &points_file, &points_surface, &cuts})
      key->of_file();
  }

  namespace
  {
    void
    require_positive(const AnyKey &key, const double value)
    {
      if (!(value > 0.))
        throw InputError(key.path(),
                         Patterns::Tools::to_string(value),
                         "a length above 0 um",
                         "Give a positive length.");
    }

    void
    check_vector(const Key<std::vector<double>> &numbers,
                 const unsigned int              dim)
    {
      if (numbers->size() < dim || numbers->size() > 3)
        numbers.refuse(dim == 3 ?
                         "a list of 3 numbers in um" :
                         "a list of 2 or 3 numbers in um (2-D uses two)",
                       "Give one number for each direction.");
    }

    void
    check_readable(const Key<std::string> &file)
    {
      std::ifstream stream(file.value());
      stream.peek(); // a directory opens, but cannot be read
      if (stream.fail() && !stream.eof())
        file.refuse(
          "a file that can be read",
          "Check its name, seen from the directory in which Morula is "
          "started or from that of the scene, and its permissions.");
    }

    /** A file given if and only if the shape is @p shape_with_file. */
    void
    check_file(const Key<std::string> &file,
               const std::string      &shape_with_file,
               const Key<std::string> &shape)
    {
      if (shape != shape_with_file)
        {
          if (!file->empty())
            file.refuse("nothing, as Tissue/Shape = " + shape,
                        "Set Shape = " + shape_with_file +
                          ", or leave this key empty.");
          return;
        }
      if (file->empty())
        file.refuse("a file, as Tissue/Shape = " + shape,
                    "Name the file, or choose another Shape.");
      check_readable(file);
    }

    bool
    is_mesh_format(const std::string &file)
    {
      const std::string ending = boost::to_lower_copy(
        file.substr(std::min(file.rfind('.'), file.size())));
      return ending == ".stl" || ending == ".off" || ending == ".ply" ||
             ending == ".obj";
    }

    /** Refuses a file whose name does not end as it must: in 2-D as well-known
     *  text, in 3-D as a mesh. @param words that the key may have besides */
    void
    check_ending(const Key<std::string> &file,
                 const unsigned int      dim,
                 const std::string      &words,
                 const std::string      &remedy)
    {
      if (dim == 2 ? !boost::iends_with(file.value(), ".wkt") :
                     !is_mesh_format(file))
        file.refuse(words + "a file whose name ends with " +
                      (dim == 2 ? ".wkt" : ".stl, .off, .ply or .obj"),
                    remedy);
    }

    /** Refuses files that cannot be those of a surface, and what keys of the
     *  surface demand of each other. */
    void
    check_surface(const TissueParameters &tissue, const unsigned int dim)
    {
      if (tissue.has_surface_file())
        {
          check_ending(
            tissue.points_surface,
            dim,
            "automatic, always, none or ",
            dim == 2 && is_mesh_format(tissue.points_surface) ?
              "In 2-D the surface is made of polygons, as well-known text." :
              "Choose one of the words, or name the file of a surface.");
          check_readable(tissue.points_surface);
        }
      if (tissue.has_cuts())
        {
          check_ending(tissue.cuts,
                       dim,
                       "",
                       dim == 2 ? "In 2-D cuts are lines, as well-known text." :
                                  "In 3-D cuts are surfaces of triangles.");
          check_readable(tissue.cuts);
        }
      if (tissue.has_no_surface() && tissue.boundary_points > 0)
        tissue.boundary_points.refuse(
          "0, as Tissue/Points surface = none",
          "Set Boundary points = 0, or Points surface = automatic.");
      if (tissue.closed_gap != 2.)
        tissue.closed_gap.refuse("2",
                                 "Other cavities are those of a surface from a "
                                 "file: Tissue/Points surface.");
      if (tissue.coarsen_surface && !tissue.refine_surface)
        tissue.coarsen_surface.refuse(
          "false, as Tissue/Refine surface = false",
          "What is merged must be split again: set Refine surface = true.");
    }

    /** Refuses a lattice that misses the shape. */
    template <int dim>
    void
    check_some_cell_fits(const TissueParameters &parameters)
    {
      const auto         shape = make_shape<dim>(parameters);
      const Lattice<dim> lattice(parameters, shape->bounding_box());
      // Ends at the first cell: mostly it is in the middle.
      const std::uint64_t n = lattice.n_sites();
      for (std::uint64_t k = 0; k < n; ++k)
        if (lattice.is_occupied(*shape, lattice.position((n / 2 + k) % n)))
          return;
      throw_no_cell_fits(parameters);
    }
  } // namespace

  void
  TissueParameters::check(const unsigned int dim) const
  {
    // What any shape has is judged first, then what this shape needs, then what
    // keys demand of each other. All of it is independent of cells and files:
    // those that the scene names are opened here, but read later. So a bad
    // scene is refused before any work.
    if (dim == 2 && (shape == "cylinder" || is_mesh()))
      shape.refuse("sphere, box, ellipsoid or points in 2-D",
                   "Choose one of them, or set Dimension = 3.");
    check_vector(center, dim);
    check_vector(lattice_offset, dim);
    require_positive(cell_spacing, cell_spacing);
    check_file(surface_mesh, "mesh", shape);
    check_file(points_file, "points", shape);

    if (shape == "sphere" || shape == "cylinder")
      require_positive(radius, radius);
    if (shape == "sphere" && !(inner_radius >= 0. && inner_radius < radius))
      inner_radius.refuse("a length >= 0 um and less than " + radius.path(),
                          "The tissue is what lies between the two.");
    // Below this length the volume of the cavity would be lost in rounding.
    if (shape == "sphere" && inner_radius > 0. &&
        inner_radius < 1e-3 * cell_spacing)
      inner_radius.refuse("0 for no cavity, or a length in um of at least 1e-3 "
                          "of Tissue/Cell spacing",
                          "No cell could notice such a cavity.");
    // Of a cylinder Size has the height alone.
    const bool has_size = shape == "box" || shape == "ellipsoid";
    if (has_size || shape == "cylinder")
      {
        check_vector(size, dim);
        for (unsigned int d = has_size ? 0 : 2; d < dim; ++d)
          require_positive(size, size.value()[d]);
      }
    if (is_mesh())
      check_ending(surface_mesh,
                   3,
                   "",
                   "Convert the surface to one of these formats.");
    check_surface(*this, dim);
    if (is_from_file())
      return; // their files are judged when they are read
    if (dim == 2)
      check_some_cell_fits<2>(*this);
    else
      check_some_cell_fits<3>(*this);
  }


  template <int dim>
  double
  check_filled(const TissueParameters &tissue,
               const double            h,
               const BoundingBox<dim> &box,
               const double            cells,
               const double            volume)
  {
    // A thousand grid cells for each one with tissue are much more than any
    // real scene has: two spheroids with a gap of many diameters are far from
    // that. Tissue a thousand grid cells long is some metres of it, and nearly
    // always due to a single stray point.
    constexpr double most_per_cell = 1000., few_cells = 1000., longest = 1000.;
    double           n       = 1.; // grid cells
    bool             is_long = false;
    for (unsigned int d = 0; d < dim; ++d)
      {
        // The padding is that of BackgroundGrid::enclose().
        const double of_tissue = std::floor(box.side_length(d) / h) + 1.;
        n *= of_tissue + 2. * (2. + std::floor(of_tissue / 8.));
        is_long = is_long || box.side_length(d) > longest * h;
      }
    if (!is_long &&
        n <= most_per_cell *
               std::max({few_cells, cells, volume / std::pow(h, dim)}))
      return n;
    const bool              is_mesh = tissue.is_mesh();
    const Key<std::string> &file =
      is_mesh ? tissue.surface_mesh : tissue.points_file;
    std::ostringstream remedy;
    remedy << "It reaches from (" << box.get_boundary_points().first << ") to ("
           << box.get_boundary_points().second << ") um, " << n
           << " grid cells of " << h << " um, for some " << std::round(cells)
           << " cells: correct the " << (is_mesh ? "vertex" : "cell")
           << " that lies astray, or raise Grid/Spacing. If the file is in "
              "another unit, scale it to um.";
    file.refuse(
      "tissue that fills a part of the grid around it, and is at most " +
        as_text(longest * h) + " um long",
      remedy.str());
  }


  MORULA_INSTANTIATE(check_filled);
} // namespace Morula
