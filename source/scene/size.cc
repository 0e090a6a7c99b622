// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression.h>
#include <morula/base/input_error.h>
#include <morula/scene/estimates.h>
#include <morula/scene/size.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/mpi.h>

#include <boost/math/special_functions/gamma.hpp>

#include <unistd.h>

#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Expected number of descendants of a founder at @p X at End time. */
    template <int dim>
    class Descendants
    {
    public:
      explicit Descendants(const Scene &scene)
        : proliferates(scene.has_proliferation())
        , together(scene.cell_cycle.start == "together")
        , end_time(scene.time.end_time)
        , where(scene.cell_cycle.where.expression(dim))
        , duration(scene.cell_cycle.duration.expression(dim))
        , rate(scene.cell_cycle.exit_rate.expression(dim))
        , checkpoint(scene.cell_cycle.size_checkpoint.expression(dim))
      {}

      double
      operator()(const Point<dim> &X)
      {
        if (!proliferates || !(where.value(X, 0.) > 0.) ||
            checkpoint.value(X, 0.) > 0.)
          return 1.;
        const std::pair<double, double> here = {duration.value(X, 0.),
                                                rate.value(X, 0.)};
        if (here != last)
          {
            last = here;
            n    = expected_cells(here.first, here.second, end_time, together);
          }
        return n;
      }

    private:
      const bool   proliferates, together;
      const double end_time;
      // most founders are like the one before
      std::pair<double, double> last = {-1., -1.};
      double                    n    = 1.;
      Expression                where, duration, rate, checkpoint;
    };

    std::string
    gigabytes(const double bytes)
    {
      std::ostringstream out;
      out.precision(3);
      out << bytes / 1e9 << " GB";
      return out.str();
    }
  } // namespace


  SceneSize
  initial_size(const Scene &scene)
  {
    const std::string &shape = scene.tissue.shape;
    if (shape == "mesh" || shape == "points")
      return {};
    const double volume = scene.dimension == 2 ?
                            make_shape<2>(scene.tissue)->volume() :
                            make_shape<3>(scene.tissue)->volume();
    return {volume / std::pow(scene.tissue.cell_spacing, scene.dimension),
            volume};
  }


  double
  expected_cells(const double T,
                 const double Lambda,
                 const double t,
                 const bool   together)
  {
    double n = 1.;
    for (unsigned int k = 1; (k - 0.5) * T <= t && std::isfinite(n); ++k)
      {
        // the k-th division comes after k waits, without the first if all
        // start together
        const unsigned int waits = together ? k - 1 : k;
        const double       share =
          waits == 0 ?
                  1. :
                Lambda == 0. ?
                  0. :
                  boost::math::gamma_p(waits, Lambda * (t - (k - 0.5) * T));
        if (share == 0.)
          break;
        n += std::exp2(k - 1.) * share;
      }
    return n;
  }


  template <int dim>
  SceneSize
  expected_size(const Scene                   &scene,
                const std::vector<Point<dim>> &founders,
                const MPI_Comm                 comm)
  {
    const double     t   = scene.time.end_time;
    const double     V   = std::pow(scene.tissue.cell_spacing, dim);
    const auto       law = growth_law_of<dim>(scene);
    Descendants<dim> descendants(scene);
    SceneSize        size;
    for (const Point<dim> &X : founders)
      {
        const double n = descendants(X);
        size.cells += n;
        size.volume += n * V * (law ? law->expected_volume_ratio(X, t) : 1.);
      }
    size.cells  = Utilities::MPI::sum(size.cells, comm);
    size.volume = Utilities::MPI::sum(size.volume, comm);

    const double limit =
      std::max(2. * scene.time.stop_at_cells,
               Utilities::MPI::sum(1. * founders.size(), comm));
    if (scene.time.stop_at_cells > 0 && size.cells > limit)
      size = {limit, size.volume * limit / size.cells};
    return size;
  }


  double
  physical_memory(const MPI_Comm comm)
  {
    MPI_Comm machine;
    MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    const bool first = Utilities::MPI::this_mpi_process(machine) == 0;
    MPI_Comm_free(&machine);
    const double mine = 1. * sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
    return Utilities::MPI::sum(first ? mine : 0., comm);
  }


  void
  check_memory(const Scene &scene, const SceneSize &size, const MPI_Comm comm)
  {
    // Measured: 430 bytes of a triangulation in 2-D, 700 in 3-D, with the
    // tables over the box, which every rank has.
    const double grid_cell = (scene.dimension == 2 ? 330. : 600.) +
                             100. * Utilities::MPI::n_mpi_processes(comm);
    const double needed =
      estimated_memory(scene, size) + grid_cell * size.grid_cells;
    const double available = physical_memory(comm);
    if (!(needed <= available))
      {
        std::ostringstream value;
        value << size.cells << " cells of " << scene.tissue.cell_spacing
              << " um on a grid of " << scene.grid.spacing << " um";
        if (size.grid_cells > 0.)
          value << ", " << size.grid_cells << " grid cells around them";
        throw InputError("The scene",
                         value.str() + ", about " + gigabytes(needed),
                         "at most the " + gigabytes(available) +
                           " of memory here",
                         "Raise Tissue/Cell spacing or Grid/Spacing, lower "
                         "Tissue/Boundary points, shorten Time/End time, set "
                         "Time/Stop at cells, or use more machines. Check "
                         "that files are in um.");
      }
  }


  template SceneSize
  expected_size(const Scene &, const std::vector<Point<2>> &, const MPI_Comm);
  template SceneSize
  expected_size(const Scene &, const std::vector<Point<3>> &, const MPI_Comm);
} // namespace Morula
