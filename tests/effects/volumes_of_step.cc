// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** A pooled material whose energy is counted per grown volume. */
  TissueMaterial
  pooled_material()
  {
    MaterialParameters parameters;
    parameters.volumetric_strain = "pooled";
    parameters.energy_per        = "grown volume";
    return TissueMaterial(parameters);
  }

  /** Growth that differs from cell to cell: every third one is about to
   *  vanish. */
  template <int dim>
  DevelopmentOfStep<dim>
  uneven_growth(const Tissue<dim> &tissue)
  {
    DevelopmentOfStep<dim> growth;
    growth.present = true;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const unsigned int id = tissue.cells().id(p);
        growth.previous.push_back(unit_tensor<dim>());
        growth.current.push_back((id % 3 == 0 ? 0.3 : 1. + 0.1 * (id % 5)) *
                                 unit_tensor<dim>());
      }
    return growth;
  }

  /** Some µm, another one for each unknown. */
  template <int dim>
  Equilibrium::Vector
  some_displacement(const SplineSpace<dim> &space)
  {
    const FieldUnknowns<dim> unknowns(space, MPI_COMM_WORLD);
    std::vector<double>      values;
    for (const auto dof : unknowns.owned())
      values.push_back(2. * std::sin(7. * dof));
    return unknowns.vector(values);
  }

  /** A step of a tissue of cells of the size @p spacing. */
  template <int dim>
  struct Step
  {
    explicit Step(const double spacing)
      : tissue(GridParameters(), growing_columns(), MPI_COMM_WORLD)
      , material(pooled_material())
    {
      DevelopmentEffects<dim> effects;
      effects.law = isotropic_growth<dim>("1 + t");
      const CellDevelopment<dim> development(std::move(effects),
                                             growing_columns(),
                                             StateColumns<dim>(),
                                             material,
                                             0);
      const auto places = ball_points(Point<dim>(), 130., spacing);
      tissue.place(only_first_rank(founders<dim>(places,
                                                 std::pow(spacing, dim),
                                                 development,
                                                 some_deformation<dim>),
                                   MPI_COMM_WORLD),
                   PointList<dim>(BoundaryColumns<dim>().n_numbers()));
      growth = uneven_growth(tissue);
      space.emplace(tissue.splines(true));
      field.emplace(*space, some_displacement(*space), MPI_COMM_WORLD);
      volumes =
        volumes_of_step(tissue, *space, growth, material, "automatic", *field);
    }

    static CellColumns<dim>
    growing_columns()
    {
      CellColumns<dim> columns;
      columns.need_growth();
      columns.need_pools();
      return columns;
    }

    /** Of a cell after the step, µm^dim. */
    double
    volume(const unsigned int p) const
    {
      return tissue.cells().initial_volume(p) * determinant(growth.current[p]) *
             volumes[p].J_e;
    }

    Tissue<dim>                           tissue;
    TissueMaterial                        material;
    DevelopmentOfStep<dim>                growth;
    std::optional<SplineSpace<dim>>       space;
    std::optional<DisplacementField<dim>> field;
    std::vector<VolumeOfStep>             volumes;
  };

  /** Cells of several points, some on grid lines, in grid cells of several
   *  ranks: the tissue keeps its volume. */
  template <int dim>
  void
  check_total(const double spacing)
  {
    const Step<dim>           step(spacing);
    const MaterialPoints<dim> points =
      material_points(step.tissue, *step.space, step.growth, step.material);
    ASSERT_TRUE(points.subdivided);
    double moved = 0., kept = 0., carried = 0.;
    for (unsigned int c = 0; c < step.space->grid_cells().size(); ++c)
      {
        const LocalField<dim> field = step.field->on_grid_cell(c);
        for (unsigned int q = points.offsets[c]; q < points.offsets[c + 1]; ++q)
          moved +=
            points.carried[q] * determinant(field.step_deformation(
                                  SplineValues<dim>(points.xi[q], points.h)));
      }
    for (unsigned int p = 0; p < step.tissue.cells().size(); ++p)
      {
        kept += step.volume(p);
        carried += step.volumes[p].carried;
      }
    moved   = Utilities::MPI::sum(moved, MPI_COMM_WORLD);
    kept    = Utilities::MPI::sum(kept, MPI_COMM_WORLD);
    carried = Utilities::MPI::sum(carried, MPI_COMM_WORLD);
    EXPECT_NEAR(kept, moved, 1e-12 * moved);
    EXPECT_NEAR(carried, moved, 1e-12 * moved);
  }
} // namespace


/** In each grid cell the volumes are those that the displacement has made,
 *  and each cell has as much of them as it has grown. */
TEST_2D_3D(VolumesOfStep, AreThoseOfTheStepInEachGridCell)
{
  const Step<dim> step(14.);
  // No cell is on a grid line, none is several points.
  ASSERT_FALSE(
    material_points(step.tissue, *step.space, step.growth, step.material)
      .subdivided);
  struct Sums
  {
    double moved = 0., kept = 0., smallest = 1e300, largest = 0.;
  };
  std::map<unsigned int, Sums> by_grid_cell;
  const auto                  &cells = step.tissue.cells();
  const GridBox<dim>          &box   = step.space->box();
  step.field->at_points(
    cells,
    [&](const unsigned int       p,
        const LocalField<dim>   &field,
        const SplineValues<dim> &splines) {
      Sums &sums = by_grid_cell[box.number(box.locate(cells.position(p)))];
      sums.moved += cells.initial_volume(p) *
                    determinant(field.step_deformation(splines) * cells[p].F());
      sums.kept += step.volume(p);
      sums.smallest = std::min(sums.smallest, step.volumes[p].J_e);
      sums.largest  = std::max(sums.largest, step.volumes[p].J_e);
    });
  EXPECT_GT(by_grid_cell.size(), 4u);
  for (const auto &[number, sums] : by_grid_cell)
    {
      EXPECT_NEAR(sums.kept, sums.moved, 1e-12 * sums.moved);
      EXPECT_EQ(sums.smallest, sums.largest);
    }
}


TEST_2D_3D(VolumesOfStep, ConserveTheTissuesVolume)
{
  check_total<dim>(31.); // some points a cell
  check_total<dim>(20.); // lattice of which points lie on grid lines
}
