// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/expression.h>
#include <morula/input_error.h>
#include <morula/particles/cell_state.h>
#include <morula/scene_refusals.h>
#include <morula/scene_size.h>

#include <deal.II/base/mpi.h>

#include <boost/math/special_functions/lambert_w.hpp>

#include <unistd.h>

#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Volume of the shape, µm^dim; 0 for shapes from files. */
    double
    shape_volume(const TissueParameters &tissue, const unsigned int dim)
    {
      const double R       = tissue.radius;
      const auto  &size    = tissue.size;
      double       product = 1.;
      for (unsigned int d = 0; d < std::min<std::size_t>(dim, size.size()); ++d)
        product *= size[d];
      if (tissue.shape == "sphere")
        return dim == 2 ? numbers::PI * R * R :
                          4. / 3. * numbers::PI * R * R * R;
      if (tissue.shape == "box")
        return product;
      if (tissue.shape == "ellipsoid")
        return product * numbers::PI / (dim == 2 ? 4. : 6.);
      if (tissue.shape == "cylinder" && size.size() == 3)
        return numbers::PI * R * R * size[2];
      return 0.;
    }

    /** Number of descendants of a founder at @p X at End time. */
    template <int dim>
    class Descendants
    {
    public:
      explicit Descendants(const Scene &scene)
        : proliferates(scene.has_proliferation())
        , end_time(scene.time.end_time)
        , where(section + "Where", scene.cell_cycle.where)
        , duration(section + "Duration", scene.cell_cycle.duration)
        , rate(section + "G0 exit rate", scene.cell_cycle.exit_rate)
        , checkpoint(section + "Size checkpoint",
                     scene.cell_cycle.size_checkpoint)
      {}

      double
      operator()(const Point<dim> &X) const
      {
        if (!proliferates || !(where.value(X, 0.) > 0.) ||
            checkpoint.value(X, 0.) > 0.)
          return 1.;
        const double r = growth_rate(duration.value(X, 0.), rate.value(X, 0.));
        return 2. * std::exp(r * end_time);
      }

    private:
      static inline const std::string section = "Proliferation/Cell cycle/";

      bool       proliferates;
      double     end_time;
      Expression where, duration, rate, checkpoint;
    };

    // What follows is fitted to the runs of the table "estimates" of
    // doc/performance.md; contrib/benchmark estimates measures them anew. The
    // exponents of the direct solver are those of nested dissection.

    /** Bytes of a run with @p n_cells cells and @p n equations, on one rank. */
    template <int dim>
    double
    memory(const Scene &scene, const double n_cells, const double n)
    {
      constexpr double program = 180e6;
      // position, reference position, id, place in the grid: about 200 bytes;
      // and what a step makes of them
      const CellSlots<dim> slots(scene.has_growth(), scene.has_proliferation());
      const double cell = (dim == 2 ? 3. : 4.) * (8. * slots.n_slots + 200.);
      // a row couples with 5^dim splines, 12 bytes an entry; matrix,
      // preconditioner and positions of the entries
      const double row     = 2.7 * 12. * dim * std::pow(5., dim);
      const double factors = scene.solver.linear_solver != "direct" ? 0. :
                             dim == 2 ? 370. * n * std::log(n) :
                                        1500. * std::pow(n, 4. / 3.);
      // boundary points hold less than cells; without a wished number they are
      // fewer, too
      return program + (n_cells + scene.tissue.boundary_points) * cell +
             n * row + factors;
    }

    /** Whether anything but the clamps acts on the tissue. */
    bool
    is_driven(const Scene &scene)
    {
      const BoundaryConditionParameters &given = scene.boundary_conditions;
      return scene.has_growth() || scene.has_proliferation() ||
             !given.traction_where.empty() || !given.pressure_where.empty() ||
             !Refusals::same_value(scene.body_force.force_density, "0; 0; 0") ||
             !Refusals::same_value(given.displacement, "0; 0; 0");
    }

    /** Seconds of a step of one core with @p n_cells cells, @p n equations. */
    template <int dim>
    double
    step_seconds(const Scene &scene, const double n_cells, const double n)
    {
      if (!is_driven(scene))
        return 2e-6 * n_cells;
      constexpr double newton_iterations = 4.;
      const bool       is_projected =
        scene.material.volumetric_form() == VolumetricStrain::projected;
      const double n_points =
        n_cells * std::pow(scene.grid.points_per_cell, dim);
      const double point    = dim == 2 ? (is_projected ? 1.5e-6 : 0.6e-6) :
                                         (is_projected ? 5e-6 : 1.5e-6);
      const double equation = dim == 2 ? 10e-6 : 50e-6;
      const double factors  = scene.solver.linear_solver != "direct" ? 0. :
                              dim == 2 ? 4.5e-7 * std::pow(n, 1.5) :
                                         1.7e-7 * n * n;
      return newton_iterations * (n_points * point + n * equation + factors);
    }

    /** Equations of a compact tissue of this volume. */
    double
    n_equations(const Scene &scene, const double volume)
    {
      const double dim = scene.dimension;
      return dim *
             std::pow(std::pow(volume, 1. / dim) / scene.grid.spacing + 2.,
                      dim);
    }

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
    const double volume = shape_volume(scene.tissue, scene.dimension);
    return {volume / std::pow(scene.tissue.cell_spacing, scene.dimension),
            volume};
  }


  double
  growth_rate(const double T, const double Lambda)
  {
    if (Lambda == 0.)
      return 0.;
    // beyond, exp(Lambda T) overflows, and r is ln(2)/T within 0.2 %
    if (Lambda * T > 500.)
      return std::log(2.) / T;
    // (Lambda + r) T exp((Lambda + r) T) = 2 Lambda T exp(Lambda T)
    return boost::math::lambert_w0(2. * Lambda * T * std::exp(Lambda * T)) / T -
           Lambda;
  }


  template <int dim>
  SceneSize
  expected_size(const Scene                   &scene,
                const std::vector<Point<dim>> &founders,
                const MPI_Comm                 comm)
  {
    const double           t = scene.time.end_time;
    const double           V = std::pow(scene.tissue.cell_spacing, dim);
    const IsotropicGrowth  growth(scene.isotropic_growth);
    const Descendants<dim> descendants(scene);
    SceneSize              size;
    for (const Point<dim> &X : founders)
      {
        const double n = descendants(X);
        size.cells += n;
        size.volume +=
          n * V *
          (scene.has_growth() ? std::pow(growth.stretch(X, t), dim) : 1.);
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
  estimated_memory(const Scene &scene, const SceneSize &size)
  {
    const double n = n_equations(scene, size.volume);
    return scene.dimension == 2 ? memory<2>(scene, size.cells, n) :
                                  memory<3>(scene, size.cells, n);
  }


  template <int dim>
  SizeEstimate
  estimated_size(const Scene         &scene,
                 const Founders<dim> &founders,
                 const unsigned int   n_unknowns,
                 const MPI_Comm       comm)
  {
    const SceneSize last = expected_size(scene, founders.positions, comm);
    const double    first_volume =
      founders.n_global * std::pow(scene.tissue.cell_spacing, dim);

    SizeEstimate size;
    size.cells             = last.cells;
    size.unknowns_at_start = n_unknowns;
    size.unknowns          = n_unknowns * n_equations(scene, last.volume) /
                    n_equations(scene, first_volume);
    size.steps  = std::ceil(scene.time.end_time / scene.time.step - 1e-9);
    size.memory = memory<dim>(scene, size.cells, size.unknowns);

    // the means over a time in which both grow exponentially
    const auto mean = [](const double a, const double b) {
      return std::abs(b - a) < 1e-3 * a ? a : (b - a) / std::log(b / a);
    };
    size.seconds =
      size.steps * step_seconds<dim>(scene,
                                     mean(founders.n_global, size.cells),
                                     mean(n_unknowns, size.unknowns));
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
    const double needed    = estimated_memory(scene, size);
    const double available = physical_memory(comm);
    if (!(needed <= available))
      {
        std::ostringstream value;
        value << size.cells << " cells of " << scene.tissue.cell_spacing
              << " um on a grid of " << scene.grid.spacing << " um";
        throw InputError("The scene",
                         value.str() + ", about " + gigabytes(needed),
                         "at most the " + gigabytes(available) +
                           " of memory here",
                         "Raise Tissue/Cell spacing or Grid/Spacing, lower "
                         "Tissue/Boundary points, shorten Time/End time, set "
                         "Time/Stop at cells, or use more machines.");
      }
  }


  template SceneSize
  expected_size(const Scene &, const std::vector<Point<2>> &, const MPI_Comm);
  template SceneSize
  expected_size(const Scene &, const std::vector<Point<3>> &, const MPI_Comm);
  template SizeEstimate
  estimated_size(const Scene &,
                 const Founders<2> &,
                 const unsigned int,
                 const MPI_Comm);
  template SizeEstimate
  estimated_size(const Scene &,
                 const Founders<3> &,
                 const unsigned int,
                 const MPI_Comm);
} // namespace Morula
