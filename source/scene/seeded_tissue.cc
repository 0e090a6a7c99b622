// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/surface_mesh.h>
#include <morula/scene/checks.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/closed_surface.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/tensor.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <map>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** What the file says of founder number @p i of this rank. Lists that the
     *  file does not have are empty. */
    template <int dim>
    GivenState
    given_state(const Founders<dim> &founders, const std::size_t i)
    {
      GivenState given;
      if (!founders.phases.empty())
        given.phase = founders.phases[i];
      if (!founders.types.empty())
        given.type = founders.types[i];
      return given;
    }

    /** All columns of founder number @p i, at t = 0. @throws InputError */
    template <int dim>
    std::vector<double>
    founder_row(const TissueModel<dim>              &model,
                const Founders<dim>                 &founders,
                const std::vector<NearSurface<dim>> &surface,
                const std::size_t                    i,
                const double                         step)
    {
      // The row begins with the defaults of all columns. What the surface and
      // the file tell is set first, then fields and what else equations give,
      // since expressions of effects may read all of these; the development
      // comes last. The file's ids are global: the first of this rank plus i.
      const CellDevelopment<dim> &development = model.development;
      const CellColumns<dim>     &columns     = development.columns();
      const StateColumns<dim>    &state       = development.state();
      std::vector<double>         row =
        columns.founder(founders.positions[i], founders.volumes[i]);
      const CellView<dim, double> cell(make_array_view(row), columns);
      if (state.depth.exists())
        cell.set(state.depth, surface[i].depth);
      if (state.present_depth.exists())
        cell.set(state.present_depth, surface[i].depth);
      if (state.surface_normal.exists())
        cell.set(state.surface_normal, surface[i].normal);
      if (columns.generation.exists() && !founders.generations.empty())
        cell.set(columns.generation, founders.generations[i]);
      if (columns.body.exists() && !founders.bodies.empty())
        cell.set(columns.body, founders.bodies[i]);
      const CellReader<dim>  reader = development.reader(0.);
      const PresentCell<dim> founder(cell,
                                     founders.first_id + i,
                                     founders.positions[i],
                                     reader);
      for (const auto &[name, equation] : model.equations)
        equation->begin(founder, cell);
      development.initialize(founders.first_id + i,
                             cell,
                             step,
                             given_state(founders, i));
      return row;
    }
  } // namespace


  template <int dim>
  void
  for_first_cells(
    const TissueModel<dim>                                           &model,
    const Founders<dim>                                              &founders,
    const SurfacePatches<dim>                                        &patches,
    const double                                                      step,
    const MPI_Comm                                                    comm,
    const std::function<void(
      std::size_t, std::vector<double> &, const PresentCell<dim> &)> &action)
  {
    // The distance to the surface needs the patches of all ranks, so that its
    // search is collective; whether it is needed is the same on all ranks. The
    // loop is not, and an expression may have no value at some founder: then
    // all ranks throw.
    std::vector<NearSurface<dim>> surface;
    if (model.development.state().needs_surface())
      surface = near_surface(founders.positions,
                             patches.positions,
                             patches.normals,
                             comm);
    const CellReader<dim> reader = model.development.reader(0.);
    everywhere(comm, [&]() {
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        {
          std::vector<double> row =
            founder_row(model, founders, surface, i, step);
          action(
            i,
            row,
            PresentCell<dim>(CellView<dim, double>(make_array_view(row),
                                                   model.development.columns()),
                             founders.first_id + i,
                             founders.positions[i],
                             reader));
        }
    });
  }


  MORULA_INSTANTIATE(for_first_cells);


  template <int dim>
  bool
  has_surface(const TissueModel<dim> &model)
  {
    // Only cells from a file of points may lack a surface. Then one is made if
    // something acts on it or reads the distance to it; else it would be work
    // for nothing.
    const Scene &scene = model.scene;
    if (!scene.tissue.is_points())
      return true;
    const std::vector<const EffectKeys *> keys = scene.keys_in_use();
    if (std::any_of(keys.begin(), keys.end(), [](const EffectKeys *const one) {
          return one->facts().needs_surface;
        }))
      return true;
    if (scene.tissue.points_surface != "automatic")
      return !scene.tissue.has_no_surface();
    return model.development.state().needs_surface() ||
           !model.boundary_conditions.list().empty();
  }


  namespace
  {
    /** E.g. "2 closed surfaces, 1 of them around cavities of 4188 um^3". */
    std::string
    surfaces_text(const std::vector<SurfaceTriangle> &triangles)
    {
      // Triangles are joined with their neighbours. The volume in a surface is
      // a sum of tetrahedra with one apex, which lies on the surface itself:
      // far from the origin that loses fewer digits. It is negative where the
      // normals point inwards, as those of a cavity do.
      boost::disjoint_sets_with_storage<> sets(triangles.size());
      std::map<std::size_t, double>       volumes;
      for (std::size_t i = 0; i < triangles.size(); ++i)
        for (const std::size_t neighbor : triangles[i].neighbors)
          sets.union_set(i, neighbor);
      for (std::size_t i = 0; i < triangles.size(); ++i)
        {
          const std::size_t set  = sets.find_set(i);
          const auto       &v    = triangles[i].vertices;
          const Point<3>    apex = triangles[set].vertices[0];
          volumes[set] +=
            (v[0] - apex) * cross_product_3d(v[1] - apex, v[2] - apex) / 6.;
        }
      unsigned int n_cavities = 0;
      double       cavities   = 0.;
      for (const auto &[set, volume] : volumes)
        if (volume < 0.)
          {
            ++n_cavities;
            cavities -= volume;
          }
      std::ostringstream text;
      text.precision(4);
      text << volumes.size()
           << (volumes.size() == 1 ? " closed surface" : " closed surfaces");
      if (n_cavities > 0)
        text << ", " << n_cavities << " of them around cavities of " << cavities
             << " um^3";
      return text.str();
    }

    /** The bodies of founders. Collective. @throws InputError */
    template <int dim>
    std::vector<unsigned int>
    bodies(const TissueModel<dim> &model,
           const Founders<dim>    &founders,
           const MPI_Comm          comm)
    {
      if (!model.interaction->effect->takes_types_as_bodies())
        return bodies_apart(founders, comm);
      std::vector<unsigned int> list;
      everywhere(comm, [&]() {
        list = types_of(model, founders.positions, founders.types);
      });
      // Without types all cells are of one.
      list.resize(founders.positions.size(), 0);
      return list;
    }

    /** The surface of bodies that interact: one around each of them. */
    template <int dim>
    SurfacePatches<dim>
    surface_of_bodies(const Scene            &scene,
                      const Interaction<dim> &interaction,
                      const Founders<dim>    &founders,
                      const MPI_Comm          comm)
    {
      // A surface from a file is that of all bodies, and so is that of a shape
      // whose bodies stand apart. Each patch learns its body from the cells
      // behind it. Otherwise each body's cells get a surface of their own.
      const bool is_of_all =
        scene.tissue.has_surface_file() || scene.tissue.is_mesh() ||
        (!scene.tissue.is_points() && !interaction.takes_types_as_bodies());
      if (!is_of_all)
        return seed_points_surface(scene.tissue, scene.grid, founders, comm);
      Founders<dim> as_one(founders);
      as_one.bodies.clear();
      SurfacePatches<dim> patches =
        scene.tissue.is_points() ?
          seed_points_surface(scene.tissue, scene.grid, as_one, comm) :
          seed_surface<dim>(scene.tissue, comm);
      patches.bodies = bodies_of_patches(patches, founders, comm);
      return patches;
    }

    template <int dim>
    SurfacePatches<dim>
    surface(const TissueModel<dim> &model,
            const Founders<dim>    &founders,
            const MPI_Comm          comm)
    {
      const Scene &scene = model.scene;
      if (model.interaction)
        return surface_of_bodies(scene,
                                 *model.interaction->effect,
                                 founders,
                                 comm);
      if (!scene.tissue.is_points())
        return seed_surface<dim>(scene.tissue, comm);
      return has_surface(model) ?
               seed_points_surface(scene.tissue, scene.grid, founders, comm) :
               SurfacePatches<dim>();
    }


    /** The limits of tissue from a file, and the names of its cells' types. */
    template <int dim>
    SeedingLimits<dim>
    seeding_limits(const Scene &scene, const MPI_Comm comm)
    {
      // Seeding calls the function when it knows how many cells there would be,
      // before it makes them.
      const double       h = scene.grid.spacing;
      SeedingLimits<dim> limits;
      limits.farthest     = farthest_place * h;
      limits.cell_length  = longest_cell * h;
      limits.types        = scene.type_names();
      limits.check_memory = [&scene, h, comm](const BoundingBox<dim> &box,
                                              const double            cells,
                                              const double            volume) {
        const double grid_cells =
          check_filled(scene.tissue, h, box, cells, volume);
        check_memory(scene, {cells, volume, grid_cells}, comm);
      };
      return limits;
    }
  } // namespace


  template <int dim>
  SeededTissue<dim>
  seed_tissue(const TissueModel<dim> &model, const MPI_Comm comm)
  {
    // Founders come first, since a surface around points is made from them.
    // Both are checked before anything is applied or warned of: warnings
    // evaluate expressions that must have a value. All of it is collective.
    const Scene      &scene = model.scene;
    SeededTissue<dim> tissue;
    tissue.founders =
      seed_founders(scene.tissue, comm, seeding_limits<dim>(scene, comm));
    const Interaction<dim> *const interaction =
      model.interaction ? model.interaction->effect.get() : nullptr;
    if (interaction != nullptr)
      tissue.founders.bodies = bodies(model, tissue.founders, comm);
    tissue.surface = surface(model, tissue.founders, comm);
    if (interaction != nullptr)
      {
        tissue.measures =
          measures_of_bodies(tissue.founders, tissue.surface, comm);
        interaction->check_bodies(tissue.measures, scene);
      }
    if (scene.tissue.has_cuts())
      tissue.cuts =
        add_cuts(scene.tissue.cuts, tissue.founders, comm, tissue.surface);
    tissue.n_proliferating =
      check_at_cells(model, tissue.founders.positions, comm);
    tissue.counts            = check_at_surface(model, tissue.surface, comm);
    const auto of_conditions = describe_conditions(model, tissue, comm);
    if (scene.tissue.is_mesh())
      tissue.mesh = surfaces_text(
        SurfaceMesh(scene.tissue.surface_mesh.path(), scene.tissue.surface_mesh)
          .triangles());
    const auto of_pieces = describe_pieces(model, tissue, comm);
    tissue.warnings      = scene_warnings(
      model, tissue.founders, tissue.surface, tissue.counts, comm);
    for (const auto &more : {of_conditions, of_pieces})
      tissue.warnings.insert(tissue.warnings.end(), more.begin(), more.end());
    if (interaction != nullptr)
      interaction->review_bodies(tissue.measures, tissue.warnings);
    return tissue;
  }


  MORULA_INSTANTIATE(has_surface);
  MORULA_INSTANTIATE(seed_tissue);
} // namespace Morula
