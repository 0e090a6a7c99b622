// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/seeding/lattice.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/patterns.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>

namespace Morula
{
  TissueParameters::TissueParameters()
  {
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
      if (!(value > 0. && std::isfinite(value)))
        throw InputError(key.path(),
                         Patterns::Tools::to_string(value),
                         "a length above 0 um",
                         "Give a positive length.");
    }

    void
    check_vector(const Key<std::vector<double>> &numbers,
                 const unsigned int              dim)
    {
      // A NaN fails as well, as it is not above 0.
      if (numbers->size() < dim || numbers->size() > 3)
        numbers.refuse(dim == 3 ?
                         "a list of 3 numbers in um" :
                         "a list of 2 or 3 numbers in um (2-D uses two)",
                       "Give one number for each direction.");
      for (const double number : numbers.value())
        if (!std::isfinite(number))
          numbers.refuse("a list of finite numbers in um",
                         "Give one length in um for each direction.");
    }

    void
    check_shape(const Key<std::string> &shape, const unsigned int dim)
    {
      const std::vector<std::string> allowed =
        dim == 3 ?
          std::vector<std::string>{
            "sphere", "box", "ellipsoid", "cylinder", "mesh", "points"} :
          std::vector<std::string>{"sphere", "box", "ellipsoid", "points"};
      if (std::find(allowed.begin(), allowed.end(), shape.value()) ==
          allowed.end())
        shape.refuse(dim == 3 ?
                       "sphere, box, ellipsoid, cylinder, mesh or points" :
                       "sphere, box, ellipsoid or points in 2-D",
                     dim == 3 ? "Choose one of them." :
                                "Choose one of them, or set Dimension = 3.");
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

    /** The end of a file's name, from the last '.' on, in small letters. */
    std::string
    ending_of(const std::string &file)
    {
      std::string ending = file.substr(std::min(file.rfind('.'), file.size()));
      std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
        return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      });
      return ending;
    }

    bool
    is_mesh_format(const std::string &ending)
    {
      return ending == ".stl" || ending == ".off" || ending == ".ply" ||
             ending == ".obj";
    }

    void
    check_cuts(const Key<std::string> &cuts, const unsigned int dim)
    {
      const std::string ending = ending_of(cuts);
      if (dim == 2 && ending != ".wkt")
        cuts.refuse("a file whose name ends with .wkt",
                    "In 2-D cuts are lines, as well-known text.");
      if (dim == 3 && !is_mesh_format(ending))
        cuts.refuse("a file whose name ends with .stl, .off, .ply or .obj",
                    "In 3-D cuts are surfaces of triangles.");
      check_readable(cuts);
    }

    void
    check_points_surface(const Key<std::string> &surface,
                         const unsigned int      dim)
    {
      const std::string ending = ending_of(surface);
      if (dim == 2 ? ending != ".wkt" : !is_mesh_format(ending))
        surface.refuse(
          dim == 2 ?
            "automatic, always, none or a file whose name ends with .wkt" :
            "automatic, always, none or a file whose name ends with .stl, "
            ".off, .ply or .obj",
          dim == 2 && is_mesh_format(ending) ?
            "In 2-D the surface is made of polygons, as well-known text." :
            "Choose one of the words, or name the file of a surface.");
      check_readable(surface);
    }

    void
    check_mesh_format(const Key<std::string> &file)
    {
      if (!is_mesh_format(ending_of(file)))
        file.refuse("a file whose name ends with .stl, .off, .ply or .obj",
                    "Convert the surface to one of these formats.");
    }

    /** Refuses a lattice that misses the shape. */
    template <int dim>
    void
    check_some_cell_fits(const TissueParameters &parameters)
    {
      const auto         shape = make_shape<dim>(parameters);
      const Lattice<dim> lattice(parameters, shape->bounding_box());
      // Ends at the first cell: mostly it is among the first sites.
      for (std::uint64_t site = 0; site < lattice.n_sites(); ++site)
        if (lattice.is_occupied(*shape, lattice.position(site)))
          return;
      throw_no_cell_fits(parameters);
    }
  } // namespace

  bool
  TissueParameters::has_size(const unsigned int d) const
  {
    return shape == "box" || shape == "ellipsoid" ||
           (shape == "cylinder" && d == 2); // its axis
  }

  void
  TissueParameters::check(const unsigned int dim) const
  {
    // What any shape has is judged first, then what this shape needs, then what
    // keys demand of each other. All of it is independent of cells and files:
    // those that the scene names are opened here, but read later. So a bad
    // scene is refused before any work.
    check_shape(shape, dim);
    check_vector(center, dim);
    check_vector(lattice_offset, dim);
    require_positive(cell_spacing, cell_spacing);
    check_file(surface_mesh, "mesh", shape);
    check_file(points_file, "points", shape);

    if (has_radius())
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
    if (has_size(dim - 1))
      check_vector(size, dim);
    for (unsigned int d = 0; d < dim; ++d)
      if (has_size(d))
        require_positive(size, size.value()[d]);
    if (is_mesh())
      check_mesh_format(surface_mesh);
    if (has_surface_file())
      check_points_surface(points_surface, dim);
    if (has_cuts())
      check_cuts(cuts, dim);
    if (has_no_surface() && boundary_points > 0)
      boundary_points.refuse("0, as Tissue/Points surface = none",
                             "Set Boundary points = 0, or Points surface = "
                             "automatic.");
    if (has_no_surface() && refine_surface)
      refine_surface.refuse("false, as Tissue/Points surface = none",
                            "Set Refine surface = false, or Points surface = "
                            "automatic.");
    if (coarsen_surface && !refine_surface)
      coarsen_surface.refuse("false, as Tissue/Refine surface = false",
                             "What is merged must be split again: set Refine "
                             "surface = true.");
    if (renew_surface > 0. && !coarsen_surface)
      renew_surface.refuse("0, as Tissue/Coarsen surface = false",
                           "Between two renewals patches are split and merged: "
                           "set Coarsen surface = true.");

    // Their files are judged when they are read.
    if (is_from_file())
      return; // their files are judged when they are read
    if (dim == 2)
      check_some_cell_fits<2>(*this);
    else
      check_some_cell_fits<3>(*this);
  }
} // namespace Morula
