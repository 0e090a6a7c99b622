// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/scene/checks.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <unistd.h>

#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    std::string
    gigabytes(const double bytes)
    {
      std::ostringstream out;
      out.precision(3);
      out << bytes / 1e9 << " GB";
      return out.str();
    }

    /** Bytes of a run of this size at t = 0, on all ranks together: measured,
     *  right within a factor of about two. */
    double
    memory_of(const Scene &scene, const SceneSize &size)
    {
      // A compact tissue is a cube that is covered by splines: its edge in grid
      // spacings plus two, as quadratic B-splines reach out by one on either
      // side. A row couples with 5^dim splines, at 12 bytes an entry, for the
      // matrix, the preconditioner and the places of entries; a direct solver
      // has its factors, by nested dissection. A cell has about 70 numbers.
      const double dim = scene.dimension;
      const double equations =
        dim *
        std::pow(std::pow(size.volume, 1. / dim) / scene.grid.spacing + 2.,
                 dim);
      const double row = 2.6 * 12. * dim * std::pow(5., dim);
      const double factors =
        scene.solver.linear_solver != "direct" ? 0. :
        dim == 2. ? 370. * equations * std::log(equations) :
                    1000. * std::pow(equations, 4. / 3.);
      constexpr double program = 180e6, cell = 1800.;
      return program + (size.cells + scene.tissue.boundary_points) * cell +
             equations * row + factors;
    }
  } // namespace


  SceneSize
  initial_size(const Scene &scene)
  {
    // This is known without seeding a cell, so scenes that are far too large
    // are refused before their cells are made. A file has its cells already.
    if (scene.tissue.is_from_file())
      return {};
    const double volume = scene.dimension == 2 ?
                            make_shape<2>(scene.tissue)->volume() :
                            make_shape<3>(scene.tissue)->volume();
    return {volume / std::pow(scene.tissue.cell_spacing.value(),
                              scene.dimension.value()),
            volume};
  }


  double
  physical_memory(const MPI_Comm comm)
  {
    // Ranks of one machine share its memory, so only the first of each counts
    // it. The split is collective.
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
    // The bytes of a grid cell are measured: 430 in 2-D and 700 in 3-D for a
    // triangulation with the tables of one rank. Windows of several ranks
    // overlap, which takes 100 more.
    const double grid_cell =
      (scene.dimension == 2 ? 330. : 600.) +
      (Utilities::MPI::n_mpi_processes(comm) > 1 ? 200. : 100.);
    const double needed = memory_of(scene, size) + grid_cell * size.grid_cells;
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
                         "Tissue/Boundary points, or use more machines. Check "
                         "that files are in um.");
      }
  }


  namespace
  {
    template <int dim>
    void
    check_founders(const TissueModel<dim> &model, const Preview<dim> &at)
    {
      // Every effect checks what it can say at the founders of this rank before
      // there are cells. An exception may come on one rank only; the caller
      // takes care of that.
      for (const Point<dim> &X : at.founders)
        require_elastic(model.scene.material, X);
      for (const Effect<dim> *const effect : model.all_effects)
        effect->check(at);
    }

    /** Number of founders, over all ranks, that divide. Refuses an effect that
     *  acts on no founder. */
    template <int dim>
    types::particle_index
    count_dividing(const Scene                   &scene,
                   const std::vector<Point<dim>> &founders,
                   const MPI_Comm                 comm)
    {
      types::particle_index n_dividing = 0;
      for (const EffectKeys *const keys : scene.keys_in_use())
        {
          const EffectFacts          facts = keys->facts();
          const ExpressionKey *const where = facts.founders_key;
          const AnyKey *const        key   = facts.switch_key;
          if (where == nullptr)
            continue;
          const Expression     &holds = where->expression(dim);
          types::particle_index n     = 0;
          for (const Point<dim> &X : founders)
            n += holds.value(X, 0.) > 0.;
          // The sum is collective, so that all ranks refuse or none does.
          n = Utilities::MPI::sum(n, comm);
          if (n == 0)
            where->refuse("a condition that holds at some founder",
                          "It is positive at none: correct it" +
                            (key == nullptr ? "" :
                                              ", or set " + key->path() +
                                                " = " + key->default_text()) +
                            ". Founders sit at centers of cells, inside of the "
                            "tissue.");
          if (facts.divides_cells)
            n_dividing += n;
        }
      return n_dividing;
    }

    /** Where conditions act on the points of this rank, in their own order. */
    template <int dim>
    struct Acting
    {
      types::particle_index              fixed = 0;
      std::vector<types::particle_index> anywhere; // though another one may win
      std::vector<types::particle_index> winning;
    };

    template <int dim>
    Acting<dim>
    check_points(const BoundaryConditions<dim> &conditions,
                 const MaterialParameters      &material,
                 const Preview<dim>            &at)
    {
      // The loop is over the boundary points of this rank. At a point one
      // condition holds, but all loads act, so both counts are needed:
      // `anywhere` tells whether a condition is of any use, `winning` on how
      // many points it acts. A held point needs a stiffness there, since
      // Nitsche's penalty follows from it.
      for (const auto &[name, condition] : conditions.list())
        condition->check(at);
      const std::size_t n = conditions.list().size();
      Acting<dim>       acting;
      acting.anywhere.resize(n);
      acting.winning.resize(n);
      for (std::size_t i = 0; i < at.boundary_points.size(); ++i)
        {
          const Point<dim>      &X    = at.boundary_points[i];
          const Tensor<1, dim>  &N    = at.normals[i];
          const SurfaceCondition kind = conditions.condition(X, N);
          const unsigned int     k    = conditions.winner(X, N);
          if (is_held(kind))
            require_elastic(material, X);
          acting.fixed += kind == SurfaceCondition::fixed;
          for (unsigned int c = 0; c < n; ++c)
            {
              const auto &condition = *conditions.list()[c].condition;
              const bool  acts      = condition.acts_on(X, N);
              acting.anywhere[c] += acts;
              acting.winning[c] +=
                c == k || (acts && kind == SurfaceCondition::loaded);
            }
        }
      return acting;
    }
  } // namespace


  template <int dim>
  Preview<dim>
  preview(const TissueModel<dim>            &model,
          const std::vector<Point<dim>>     &founders,
          const std::vector<Point<dim>>     &boundary_points,
          const std::vector<Tensor<1, dim>> &normals,
          const MPI_Comm                     comm)
  {
    return {model.scene,
            founders,
            Utilities::MPI::sum<types::particle_index>(founders.size(), comm),
            boundary_points,
            normals,
            model.boundary_conditions.has(SurfaceCondition::fixed),
            comm};
  }


  template <int dim>
  std::vector<unsigned int>
  types_of(const TissueModel<dim>          &model,
           const std::vector<Point<dim>>   &founders,
           const std::vector<unsigned int> &given)
  {
    if (model.types == nullptr || !given.empty())
      return given;
    std::vector<unsigned int> list;
    for (const Point<dim> &X : founders)
      list.push_back(model.scene.cell_types.founder_type(X));
    return list;
  }


  template <int dim>
  std::vector<types::particle_index>
  founders_of_types(const TissueModel<dim>          &model,
                    const std::vector<Point<dim>>   &founders,
                    const MPI_Comm                   comm,
                    const std::vector<unsigned int> &given)
  {
    // The sum is over all ranks.
    std::vector<types::particle_index> n(model.scene.type_names().size(), 0);
    if (n.empty())
      return n;
    for (const unsigned int type : types_of(model, founders, given))
      ++n[type];
    Utilities::MPI::sum(n, comm, n);
    return n;
  }


  template <int dim>
  types::particle_index
  check_at_cells(const TissueModel<dim>        &model,
                 const std::vector<Point<dim>> &founders,
                 const MPI_Comm                 comm)
  {
    // The checks at founders come first, as only they tell which expression has
    // no value. Then numbers over all ranks are compared, which is collective.
    const std::vector<Point<dim>>     no_points;
    const std::vector<Tensor<1, dim>> no_normals;
    const Preview<dim>                at =
      preview<dim>(model, founders, no_points, no_normals, comm);
    everywhere(comm, [&] { check_founders(model, at); });
    model.scene.cell_types.check_founders(
      founders_of_types(model, founders, comm));
    return count_dividing(model.scene, founders, comm);
  }


  template <int dim>
  ConditionCounts
  check_at_surface(const TissueModel<dim>    &model,
                   const SurfacePatches<dim> &surface,
                   const MPI_Comm             comm)
  {
    // Three checks follow one another: conditions at the points of this rank,
    // the surface as a whole, for which the patches of all ranks are needed,
    // and equations at the surface. Then the counts are added up over the
    // ranks, and a condition that holds nowhere is refused.
    const BoundaryConditions<dim> &conditions = model.boundary_conditions;
    const std::vector<Point<dim>>  no_founders;
    const Preview<dim>             at = preview<dim>(
      model, no_founders, surface.positions, surface.normals, comm);
    Acting<dim> acting;
    everywhere(comm, [&] {
      acting = check_points(conditions, model.scene.material, at);
    });

    for (const auto &[name, condition] : conditions.list())
      condition->check_surface(at, surface.areas);

    for (const auto &[name, equation] : model.equations)
      equation->check_surface(surface.positions, comm);

    ConditionCounts counts;
    counts.points =
      Utilities::MPI::sum<types::particle_index>(surface.positions.size(),
                                                 comm);
    counts.fixed = Utilities::MPI::sum(acting.fixed, comm);
    // All ranks go through the same list, so that the sums in it match.
    for (const auto &choice : model.scene.catalogue.boundary_conditions)
      {
        types::particle_index &n = counts.acting[choice.name()];
        for (std::size_t c = 0; c < conditions.list().size(); ++c)
          {
            if (conditions.list()[c].name != choice.name())
              continue;
            n = Utilities::MPI::sum(acting.winning[c], comm);
            const AnyKey *const where = choice.keys().facts().switch_key;
            if (Utilities::MPI::sum(acting.anywhere[c], comm) == 0 &&
                where != nullptr)
              where->refuse("a condition that holds at some boundary point",
                            "It is positive at none: correct it, or leave it "
                            "empty. Boundary points sit at centers of surface "
                            "patches, not on edges or corners.");
          }
      }
    return counts;
  }


  MORULA_INSTANTIATE(types_of);
  MORULA_INSTANTIATE(founders_of_types);
  MORULA_INSTANTIATE(preview);
  MORULA_INSTANTIATE(check_at_cells);
  MORULA_INSTANTIATE(check_at_surface);
} // namespace Morula
