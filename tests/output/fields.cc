// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/cell_fields.h>
#include <morula/output/surface_fields.h>
#include <morula/particles/boundary_state.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

using namespace Morula;

namespace
{
  /** Sets up a cell's property array. */
  template <int dim>
  class Cell
  {
  public:
    Cell(const bool growing, const bool proliferating)
      : slots(growing, proliferating)
      , data(slots.n_slots, 0.)
    {}

    CellView<dim, double>
    writer()
    {
      return {ArrayView<double>(data.data(), data.size()), slots};
    }

    CellView<dim, const double>
    reader() const
    {
      return {ArrayView<const double>(data.data(), data.size()), slots};
    }

    CellSlots<dim>      slots;
    std::vector<double> data;
  };

  template <int dim>
  Tensor<2, dim>
  diagonal(const std::vector<double> &entries)
  {
    Tensor<2, dim> t;
    for (unsigned int d = 0; d < dim; ++d)
      t[d][d] = entries[d];
    return t;
  }

  /** A table's row by column names; the csv columns only. */
  template <int dim>
  std::map<std::string, double>
  row(const PointFields<dim> &fields, const std::size_t i)
  {
    std::map<std::string, double> values;
    for (unsigned int c = 0; c < fields.n_csv_columns; ++c)
      values[fields.names[c]] = fields.row(i)[c];
    return values;
  }

  /** The first component of a nonscalar. */
  double
  vtu_value(const PointFields<2> &fields, const std::string &name)
  {
    for (const auto &nonscalar : fields.nonscalars)
      if (nonscalar.name == name)
        return fields.row(0)[nonscalar.first_column];
    for (unsigned int c = fields.n_csv_columns; c < fields.names.size(); ++c)
      if (fields.names[c] == name)
        return fields.row(0)[c];
    return NAN;
  }

  const Lame   lame_constants = lame(1., 0.4);
  const double lambda         = 0.4 / (1.4 * 0.2);
  const double mu             = 1. / 2.8;
} // namespace

TEST(CellFields, GivesCauchyStressInThreeDimensions)
{
  // F = diag(2, 1, 1) without growth: b = diag(4, 1, 1), J = 2
  Cell<3> cell(false, false);
  cell.writer().set_scalar(cell.slots.initial_volume, 1000.);
  cell.writer().set_tensor(cell.slots.deformation, diagonal<3>({2., 1., 1.}));
  for (const bool per_grown_volume : {false, true})
    {
      const CellQuantities q =
        cell_quantities<3>(cell.reader(), lame_constants, per_grown_volume);
      EXPECT_DOUBLE_EQ(q.initial_volume, 1000.);
      EXPECT_DOUBLE_EQ(q.volume, 2000.);
      EXPECT_DOUBLE_EQ(q.growth_volume_ratio, 1.);
      EXPECT_DOUBLE_EQ(q.elastic_volume_ratio, 2.);
      const double log_J = std::log(2.);
      EXPECT_NEAR(q.energy_density,
                  lambda / 2. * log_J * log_J +
                    mu / 2. * (6. - 3. - 2. * log_J),
                  1e-15);
      EXPECT_NEAR(q.stress[0][0], (3. * mu + lambda * log_J) / 2., 1e-15);
      EXPECT_NEAR(q.stress[1][1], lambda * log_J / 2., 1e-15);
      EXPECT_NEAR(q.stress[2][2], lambda * log_J / 2., 1e-15);
      EXPECT_NEAR(q.stress[0][1], 0., 1e-15);
    }
}

TEST(CellFields, GivesShearStress)
{
  // simple shear by 0.5 in the planes xy, then yz: b = F Fᵀ, J = 1, τ = μ(b-I)
  Cell<3>      cell(false, false);
  Tensor<2, 3> F = diagonal<3>({1., 1., 1.});
  F[0][1]        = 0.5;
  F[1][2]        = 0.25;
  cell.writer().set_scalar(cell.slots.initial_volume, 1.);
  cell.writer().set_tensor(cell.slots.deformation, F);
  CellFields<3> fields(0., 1, false);
  fields.add(0,
             cell.reader(),
             {},
             9,
             false,
             cell_quantities<3>(cell.reader(), lame_constants, false));
  auto values = row(fields.fields(), 0);
  EXPECT_NEAR(values["sigma_xx"], mu * 0.25, 1e-15);
  EXPECT_NEAR(values["sigma_yy"], mu * 0.0625, 1e-15);
  EXPECT_NEAR(values["sigma_zz"], 0., 1e-15);
  EXPECT_NEAR(values["sigma_xy"], mu * 0.5, 1e-15);
  EXPECT_NEAR(values["sigma_yz"], mu * 0.25, 1e-15);
  EXPECT_NEAR(values["sigma_zx"], 0., 1e-15);
}

TEST(CellFields, CountsTheEnergyPerInitialOrGrownVolume)
{
  // the rigid box with θ = 1.1: F = I, F_e = I / θ; mean pressure per initial
  // volume μ(1 - θ⁻²) + 3 λ ln θ, per grown volume θ³ times as much, 626.18 Pa
  Cell<3> cell(true, false);
  cell.writer().set_scalar(cell.slots.initial_volume, 8.);
  cell.writer().set_tensor(cell.slots.deformation, diagonal<3>({1., 1., 1.}));
  cell.writer().set_tensor(cell.slots.growth, diagonal<3>({1.1, 1.1, 1.1}));
  const auto initial = cell_quantities<3>(cell.reader(), lame_constants, false);
  const auto grown   = cell_quantities<3>(cell.reader(), lame_constants, true);
  const double pressure = mu * (1. - 1. / 1.21) + 3. * lambda * std::log(1.1);
  EXPECT_NEAR(initial.stress[1][1], -pressure, 1e-14);
  EXPECT_NEAR(grown.stress[1][1], -0.62618, 5e-6);
  EXPECT_NEAR(grown.stress[2][2], -pressure * 1.331, 1e-14);
  for (const auto &q : {initial, grown})
    {
      EXPECT_NEAR(q.growth_volume_ratio, 1.331, 1e-15);
      EXPECT_NEAR(q.elastic_volume_ratio, 1. / 1.331, 1e-15);
      EXPECT_DOUBLE_EQ(q.volume, 8.);
    }
}

TEST(CellFields, KeepsTheOutOfPlaneStressInTwoDimensions)
{
  // F = diag(2, 1), F_g = 1.25 I: F_e = diag(1.6, 0.8), J_e = 1.28
  Cell<2>      cell(true, true);
  const double third = 1. / 3.;
  const auto   write = cell.writer();
  write.set_vector(cell.slots.founder_position, Point<2>(3., 4.));
  write.set_scalar(cell.slots.initial_volume, 50.);
  write.set_tensor(cell.slots.deformation, diagonal<2>({2., 1.}));
  write.set_tensor(cell.slots.growth, diagonal<2>({1.25, 1.25}));
  write.set_scalar(cell.slots.parent, 7.);
  write.set_scalar(cell.slots.generation, 2.);

  CellFields<2> fields(third, 1, false);
  const auto    q = cell_quantities<2>(cell.reader(), lame_constants, true);
  fields.add(12, cell.reader(), Point<2>(5., 6.), 3, false, q);
  const auto &table  = fields.fields();
  auto        values = row(table, 0);

  const std::vector<std::string> names(table.names.begin(),
                                       table.names.begin() +
                                         table.n_csv_columns);
  EXPECT_EQ(names,
            (std::vector<std::string>{"time",
                                      "id",
                                      "parent",
                                      "generation",
                                      "phase",
                                      "x",
                                      "y",
                                      "z",
                                      "X",
                                      "Y",
                                      "Z",
                                      "initial_volume",
                                      "volume",
                                      "growth_volume_ratio",
                                      "elastic_volume_ratio",
                                      "energy_density",
                                      "sigma_xx",
                                      "sigma_yy",
                                      "sigma_zz",
                                      "sigma_xy",
                                      "sigma_yz",
                                      "sigma_zx"}));
  EXPECT_EQ(table.ids, std::vector<types::particle_index>{12});
  EXPECT_EQ(values["time"], third);
  EXPECT_EQ(values["id"], 12.);
  EXPECT_EQ(values["parent"], 7.);
  EXPECT_EQ(values["generation"], 2.);
  EXPECT_EQ(values["phase"], 3.);
  EXPECT_EQ(values["x"], 5.);
  EXPECT_EQ(values["y"], 6.);
  EXPECT_EQ(values["z"], 0.);
  EXPECT_EQ(values["X"], 3.);
  EXPECT_EQ(values["Y"], 4.);
  EXPECT_EQ(values["Z"], 0.);
  EXPECT_EQ(values["initial_volume"], 50.);
  EXPECT_EQ(values["volume"], 100.);
  EXPECT_DOUBLE_EQ(values["growth_volume_ratio"], 1.5625);
  EXPECT_DOUBLE_EQ(values["elastic_volume_ratio"], 1.28);

  // per grown volume σ = τ / J_e
  const double log_J = std::log(1.28);
  const double xx    = (mu * (2.56 - 1.) + lambda * log_J) / 1.28;
  const double yy    = (mu * (0.64 - 1.) + lambda * log_J) / 1.28;
  const double zz    = lambda * log_J / 1.28;
  EXPECT_NEAR(values["energy_density"],
              lambda / 2. * log_J * log_J + mu / 2. * (3.2 - 2. - 2. * log_J),
              1e-15);
  EXPECT_NEAR(values["sigma_xx"], xx, 1e-15);
  EXPECT_NEAR(values["sigma_yy"], yy, 1e-15);
  EXPECT_NEAR(values["sigma_zz"], zz, 1e-15);
  EXPECT_EQ(values["sigma_xy"], 0.);
  EXPECT_EQ(values["sigma_yz"], 0.);
  EXPECT_EQ(values["sigma_zx"], 0.);

  EXPECT_NEAR(vtu_value(table, "pressure"), -(xx + yy + zz) / 3., 1e-15);
  EXPECT_NEAR(vtu_value(table, "principal_stress_1"), xx, 1e-15);
  EXPECT_NEAR(vtu_value(table, "principal_stress_2"), zz, 1e-15);
  EXPECT_NEAR(vtu_value(table, "principal_stress_3"), yy, 1e-15);
  EXPECT_EQ(vtu_value(table, "displacement"), 2.);
  EXPECT_NEAR(vtu_value(table, "sigma"), xx, 1e-15);
  EXPECT_EQ(table.values.size(), table.names.size());
}

TEST(CellFields, SayWhichCellsTheCheckpointHolds)
{
  Cell<3> cell(true, true);
  cell.writer().set_scalar(cell.slots.initial_volume, 8.);
  cell.writer().set_tensor(cell.slots.deformation, diagonal<3>({1., 1., 1.}));
  cell.writer().set_tensor(cell.slots.growth, diagonal<3>({1.1, 1.1, 1.1}));
  const auto q = cell_quantities<3>(cell.reader(), lame_constants, false);
  for (const bool held : {false, true})
    {
      CellFields<3> fields(0., 1, true);
      fields.add(0, cell.reader(), {}, 0, held, q);
      const auto &table = fields.fields();
      EXPECT_EQ(table.names[table.n_csv_columns - 1], "held_at_checkpoint");
      EXPECT_EQ(row(table, 0)["held_at_checkpoint"], held);
      // and nothing else has moved
      EXPECT_EQ(row(table, 0)["sigma_zx"], q.stress[0][2]);
      EXPECT_EQ(table.row(0)[table.n_csv_columns], -trace(q.stress) / 3.);
      EXPECT_EQ(table.values.size(), table.names.size());
    }
}

TEST(SurfaceFields, FollowNanson)
{
  using Slots = BoundarySlots<3>;
  std::vector<double> data(Slots::n_slots, 0.);
  data[Slots::initial_position]   = 1.;
  data[Slots::initial_normal + 2] = 1.;
  data[Slots::initial_area]       = 10.;
  data[Slots::condition]          = 2.;
  // F = [2 0 0; 0 3 0; 1 0 1]: the patch spanned by e_x and e_y becomes the one
  // spanned by (2, 0, 1) and (0, 3, 0), whose cross product is (-3, 0, 6)
  data[Slots::deformation + 0] = 2.;
  data[Slots::deformation + 4] = 3.;
  data[Slots::deformation + 6] = 1.;
  data[Slots::deformation + 8] = 1.;

  SurfaceFields<3> fields(0.5);
  fields.add(4,
             ArrayView<const double>(data.data(), data.size()),
             Point<3>(7., 8., 9.));
  auto values = row(fields.fields(), 0);
  EXPECT_EQ(values.size(), 13u);
  EXPECT_EQ(values["time"], 0.5);
  EXPECT_EQ(values["id"], 4.);
  EXPECT_EQ(values["x"], 7.);
  EXPECT_EQ(values["y"], 8.);
  EXPECT_EQ(values["z"], 9.);
  EXPECT_EQ(values["X"], 1.);
  EXPECT_EQ(values["Y"], 0.);
  EXPECT_NEAR(values["nx"], -1. / std::sqrt(5.), 1e-15);
  EXPECT_NEAR(values["ny"], 0., 1e-15);
  EXPECT_NEAR(values["nz"], 2. / std::sqrt(5.), 1e-15);
  EXPECT_NEAR(values["area"], 10. * std::sqrt(45.), 1e-13);
  EXPECT_EQ(values["condition"], 2.);
}

TEST(SurfaceFields, AreLengthsInTwoDimensions)
{
  using Slots = BoundarySlots<2>;
  std::vector<double> data(Slots::n_slots, 0.);
  data[Slots::initial_normal] = 1.;
  data[Slots::initial_area]   = 2.;
  // F = [1 1; 0 3]: the edge along e_y becomes (1, 3), its normal (3, -1)
  data[Slots::deformation + 0] = 1.;
  data[Slots::deformation + 1] = 1.;
  data[Slots::deformation + 3] = 3.;
  const auto vector =
    BoundaryView<2>(ArrayView<const double>(data.data(), data.size()))
      .area_vector();
  EXPECT_NEAR(vector[0], 6., 1e-15);
  EXPECT_NEAR(vector[1], -2., 1e-15);
}
