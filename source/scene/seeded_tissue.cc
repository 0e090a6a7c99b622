// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/surface_mesh.h>
#include <morula/scene/mesh_surfaces.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/scene/size.h>
#include <morula/scene/warnings.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/cuts.h>
#include <morula/seeding/pieces_at_start.h>
#include <morula/seeding/points_surface.h>

#include <algorithm>

namespace Morula
{
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
        return seed_points_surface(scene.tissue, founders, comm);
      Founders<dim> as_one(founders);
      as_one.bodies.clear();
      SurfacePatches<dim> patches =
        scene.tissue.is_points() ?
          seed_points_surface(scene.tissue, as_one, comm) :
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
               seed_points_surface(scene.tissue, founders, comm) :
               SurfacePatches<dim>();
    }
  } // namespace


  template <int dim>
  std::string
  bodies_text(const Scene             &scene,
              const SeededTissue<dim> &tissue,
              const MPI_Comm           comm)
  {
    const BodyCounts counts =
      count_bodies(scene.grid, tissue.founders, tissue.surface, comm);
    return std::to_string(counts.bodies) +
           (counts.bodies == 1 ? " body" : " bodies") + " in " +
           std::to_string(counts.pieces) +
           (counts.pieces == 1 ? " piece" : " pieces") + " of the grid";
  }


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
    tissue.counts  = check_at_surface(model, tissue.surface, comm);
    tissue.applied = applied_conditions(model, tissue.surface, comm);
    if (scene.tissue.is_from_file() && interaction == nullptr)
      tissue.bodies = bodies_text(scene, tissue, comm);
    if (scene.tissue.is_mesh())
      tissue.mesh = surfaces_text(volumes_of_surfaces(
        SurfaceMesh(scene.tissue.surface_mesh.path(), scene.tissue.surface_mesh)
          .triangles()));
    tissue.pieces   = held_pieces(model, tissue.founders, tissue.surface, comm);
    tissue.warnings = scene_warnings(
      model, tissue.founders, tissue.surface, tissue.counts, comm);
    review_applied(scene, tissue.applied, tissue.warnings);
    review_held(scene, tissue.pieces, tissue.warnings);
    if (interaction != nullptr)
      interaction->review_bodies(tissue.measures, tissue.warnings);
    return tissue;
  }


  MORULA_INSTANTIATE(bodies_text);
  MORULA_INSTANTIATE(has_surface);
  MORULA_INSTANTIATE(seed_tissue);
} // namespace Morula
