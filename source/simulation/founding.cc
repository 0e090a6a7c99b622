// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/parameter_file.h>
#include <morula/scene/first_cells.h>
#include <morula/simulation/founding.h>

#include <map>
#include <set>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Adds founder number @p i. @throws InputError */
    template <int dim>
    void
    add_founder(const TissueModel<dim>              &model,
                const Founders<dim>                 &founders,
                const std::size_t                    i,
                const std::vector<NearSurface<dim>> &surface,
                const CellReader<dim>               &reader,
                FirstPoints<dim>                    &points)
    {
      // The row of the founder is complete before any effect sees it: an effect
      // checks the cell that will be in the first step, and refuses what it
      // cannot handle. The founder is added to the cells and to lineage.csv,
      // where it has no mother (-1).
      const Point<dim>            X     = founders.positions[i];
      const types::particle_index id    = founders.first_id + i;
      std::vector<double>         row   = founder_row(model.development,
                                            model.equations,
                                            founders,
                                            surface,
                                            i,
                                            model.scene.time.step);
      const StateColumns<dim>    &state = model.development.state();
      const CellView<dim, double> cell(make_array_view(row),
                                       model.development.columns());
      const PresentCell<dim>      founder(cell, id, X, reader);
      for (const auto &named : model.equations)
        named.effect->check_cell(founder, model.scene.time.step);
      for (const auto &trait : model.traits)
        trait->check_cell(founder, model.scene.time.step);
      for (const auto &named : model.step_effects)
        named.effect->check_cell(founder, model.scene.time.step);
      for (const auto &named : model.forces)
        named.effect->check_cell(founder, model.scene.time.step);
      points.cells.add(id, X, make_array_view(row));
      points.births.push_back(
        {id,
         -1,
         founders.generations.empty() ? 0 : founders.generations[i],
         0.,
         X,
         state.type.exists() ? cell.get(state.type) : 0});
    }
  } // namespace


  template <int dim>
  FirstPoints<dim>
  found(const TissueModel<dim>  &model,
        const SeededTissue<dim> &seeded,
        const MPI_Comm           comm)
  {
    // Founders come first, as an effect may refuse one of them; patches cannot
    // fail. Each rank has a part of both, numbered from first_id on, so that
    // ids do not depend on who has which part. The points may lie anywhere:
    // Tissue::place() sends them to the owners of their grid cells later.
    const Founders<dim>       &founders = seeded.founders;
    const SurfacePatches<dim> &patches  = seeded.surface;
    const BoundaryColumns<dim> boundary = model.boundary_columns();
    FirstPoints<dim>           points{PointList<dim>(
                              model.development.columns().n_numbers()),
                            PointList<dim>(boundary.n_numbers()),
                                      {}};
    points.cells.reserve(founders.positions.size());
    points.births.reserve(founders.positions.size());
    // The distance to the surface needs the patches of all ranks, so that the
    // call is collective. The loop below is not, and may throw on one rank.
    const auto surface =
      near_surface_of(model.development.state(), founders, patches, comm);
    const CellReader<dim> reader = model.development.reader(0.);
    everywhere(comm, [&]() {
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        add_founder(model, founders, i, surface, reader, points);
    });
    for (std::size_t i = 0; i < patches.positions.size(); ++i)
      {
        // The condition of a patch is decided here, once for the whole run: it
        // depends on the initial position and normal only.
        const Point<dim>     X   = patches.positions[i];
        const Tensor<1, dim> N   = patches.normals[i];
        std::vector<double>  row = boundary.initial_point(
          X, N, patches.areas[i], model.boundary_conditions.condition(X, N));
        if (boundary.body.exists())
          boundary.body.set(make_array_view(row), patches.bodies.at(i));
        points.boundary_points.add(patches.first_id + i,
                                   X,
                                   make_array_view(row));
      }
    return points;
  }


  MORULA_INSTANTIATE(found);


  namespace
  {
    /** Paths of the keys in which a resumed run may differ. */
    std::set<std::string>
    may_differ(const Scene &scene)
    {
      // Method is a name for several keys, which are compared by themselves.
      std::set<std::string> paths = {scene.method.path(),
                                     scene.output_directory.path(),
                                     scene.time.end_time.path(),
                                     scene.time.step.path(),
                                     scene.time.stop_at_cells.path()};
      for (const AnyKey *key : scene.solver.list())
        paths.insert(key->path());
      for (const AnyKey *key : scene.output.list())
        paths.insert(key->path());
      return paths;
    }

    std::map<std::string, std::string>
    values(const std::string &parameters, const std::string &name)
    {
      // Comments and includes are no statements of this kind, so that only
      // values are compared.
      std::istringstream                 input(parameters);
      std::map<std::string, std::string> map;
      for (const Statement &statement : read_statements(input, name))
        if (statement.kind == Statement::set)
          map[statement.path] = statement.value;
      return map;
    }
  } // namespace

  void
  check_resumable(const Scene &scene, const std::string &parameters)
  {
    // Both scenes become maps from key to value. The program that wrote the
    // snapshot may not have had a key yet. Then the key's default counts, as
    // the default of a new key is what was done before. Keys that are gone are
    // looked for first: they have no value to be compared with.
    auto before = values(parameters, "the snapshot's scene");
    before.merge(
      values(scene.with_defaults().parameters(), "the default scene"));
    const auto now = values(scene.parameters(), "the scene");
    for (const auto &[path, value] : before)
      if (now.count(path) == 0)
        throw InputError(path,
                         value,
                         "a key that this program knows",
                         "The snapshot was written by another version of "
                         "Morula: resume with that one, or start a new run "
                         "without --resume.");
    const std::set<std::string> may = may_differ(scene);
    for (const auto &[path, value] : now)
      {
        // Numbers are compared as such: 1 and 1.0 are the same value.
        if (may.count(path) > 0 || same_value(before.at(path), value))
          continue;
        throw InputError(
          path,
          value,
          "'" + before.at(path) + "', as in the snapshot",
          "A resumed run may differ only in Time/End time, Time/Step, "
          "Time/Stop at cells, Solver and Output. Put the old value back, or "
          "start a new run without --resume.");
      }
  }
} // namespace Morula
