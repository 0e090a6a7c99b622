// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/scene/first_cells.h>

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
  } // namespace


  template <int dim>
  std::vector<NearSurface<dim>>
  near_surface_of(const StateColumns<dim>   &state,
                  const Founders<dim>       &founders,
                  const SurfacePatches<dim> &patches,
                  const MPI_Comm             comm)
  {
    // The search is collective, and whether it is needed is the same on all
    // ranks.
    if (!state.needs_surface())
      return {};
    return near_surface(founders.positions,
                        patches.positions,
                        patches.normals,
                        comm);
  }


  template <int dim>
  std::vector<double>
  founder_row(const CellDevelopment<dim>          &development,
              const NamedEffects<Equation<dim>>   &equations,
              const Founders<dim>                 &founders,
              const std::vector<NearSurface<dim>> &surface,
              const std::size_t                    i,
              const double                         step)
  {
    // The row begins with the defaults of all columns. What the surface and the
    // file tell is set first, then fields and what else equations give, since
    // expressions of effects may read all of these; the development comes last.
    // The file's ids are global: the first of this rank plus i.
    const CellColumns<dim>  &columns = development.columns();
    const StateColumns<dim> &state   = development.state();
    std::vector<double>      row =
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
    for (const auto &[name, equation] : equations)
      equation->begin(cell);
    development.initialize(founders.first_id + i,
                           cell,
                           step,
                           given_state(founders, i));
    return row;
  }


  template <int dim>
  FirstCells<dim>::FirstCells(const TissueModel<dim>    &model,
                              const Founders<dim>       &founders,
                              const SurfacePatches<dim> &patches,
                              const MPI_Comm             comm)
    : model(model)
    , founders(founders)
    , surface(
        near_surface_of(model.development.state(), founders, patches, comm))
    , reader(model.development.reader(0.))
  {}


  template <int dim>
  std::vector<double>
  FirstCells<dim>::row(const std::size_t i) const
  {
    // The step is 0, so that nothing is checked: that is done elsewhere.
    return founder_row(
      model.development, model.equations, founders, surface, i, 0.);
  }


  template <int dim>
  PresentCell<dim>
  FirstCells<dim>::cell(std::vector<double> &row, const std::size_t i) const
  {
    return PresentCell<dim>(CellView<dim, double>(make_array_view(row),
                                                  model.development.columns()),
                            founders.first_id + i,
                            founders.positions[i],
                            reader);
  }


  MORULA_INSTANTIATE(near_surface_of);
  MORULA_INSTANTIATE(founder_row);
  template class FirstCells<2>;
  template class FirstCells<3>;
} // namespace Morula
