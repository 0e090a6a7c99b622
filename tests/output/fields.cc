// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

/** A cell of its own. */
template <int dim>
class Cell
{
public:
  Cell(const bool growing, const bool proliferating)
  {
    if (growing)
      columns.need_growth();
    if (proliferating)
      columns.need_lineage();
    row = columns.initial_row();
  }

  CellView<dim, double>
  writer()
  {
    return {make_array_view(row), columns};
  }

  CellView<dim, const double>
  reader() const
  {
    return {make_array_view(row), columns};
  }

  CellQuantities
  quantities(const bool per_grown_volume) const
  {
    return cell_quantities<dim>(reader(),
                                neo_hookean(),
                                lame(1., 0.4),
                                per_grown_volume);
  }

  CellColumns<dim>    columns;
  std::vector<double> row;
};

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

const double lambda = 0.4 / (1.4 * 0.2);
const double mu     = 1. / 2.8;


TEST(CellFields, GivesShearStress)
{
  // simple shear by 0.5 in the planes xy, then yz: b = F Fᵀ, J = 1, τ = μ(b-I)
  Cell<3>      cell(false, false);
  Tensor<2, 3> F = diagonal<3>({1., 1., 1.});
  F[0][1]        = 0.5;
  F[1][2]        = 0.25;
  cell.writer().set(cell.columns.initial_volume, 1.);
  cell.writer().set(cell.columns.deformation, F);
  CellFields<3> fields(0., 1, cell.columns, false);
  fields.add(0, cell.reader(), {}, 9, false, cell.quantities(false));
  auto values = row(fields, 0);
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
  cell.writer().set(cell.columns.initial_volume, 8.);
  cell.writer().set(cell.columns.deformation, diagonal<3>({1., 1., 1.}));
  cell.writer().set(cell.columns.growth, diagonal<3>({1.1, 1.1, 1.1}));
  const auto   initial  = cell.quantities(false);
  const auto   grown    = cell.quantities(true);
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
  write.set(cell.columns.founder_position, Point<2>(3., 4.));
  write.set(cell.columns.initial_volume, 50.);
  write.set(cell.columns.deformation, diagonal<2>({2., 1.}));
  write.set(cell.columns.growth, diagonal<2>({1.25, 1.25}));
  write.set(cell.columns.parent, 7);
  write.set(cell.columns.generation, 2);

  CellFields<2> fields(third, 1, cell.columns, false);
  const auto    q = cell.quantities(true);
  fields.add(12, cell.reader(), Point<2>(5., 6.), 3, false, q);
  const auto &table  = fields;
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


TEST(CellFields, HaveTheColumnsThatEffectsWantThere)
{
  Cell<2>    cell(false, false);
  const auto dose  = cell.columns.add<double>({"dose", "nM", "received"});
  const auto shown = cell.columns.add<unsigned int>(
    {"type", "", "kind", 2u, AtDivision::copied, true});
  const auto axis = cell.columns.add<Tensor<1, 2>>(
    {"axis", "", "a direction", {}, AtDivision::copied, true});
  const auto fabric = cell.columns.add<Tensor<2, 2>>(
    {"fabric", "", "a tensor", {}, AtDivision::copied, true});
  cell.row = cell.columns.founder(Point<2>(3., 4.), 50.);
  cell.writer().set(dose, 9.);
  cell.writer().set(axis, Tensor<1, 2>({5., 6.}));
  cell.writer().set(fabric, Tensor<2, 2>({{1., 2.}, {3., 4.}}));
  EXPECT_EQ(cell.reader().get(shown), 2u);

  CellFields<2> fields(0., 1, cell.columns, true);
  const auto    q = cell.quantities(false);
  fields.add(7, cell.reader(), Point<2>(5., 6.), 3, false, q);
  const auto &table  = fields;
  auto        values = row(table, 0);
  EXPECT_EQ(values.count("dose"), 0u);
  const std::vector<std::pair<std::string, double>> expected = {
    {"held_at_checkpoint", 0.},
    {"type", 2.},
    {"axis_x", 5.},
    {"axis_y", 6.},
    {"axis_z", 0.},
    {"fabric_xx", 1.},
    {"fabric_xy", 2.},
    {"fabric_xz", 0.},
    {"fabric_yx", 3.},
    {"fabric_yy", 4.},
    {"fabric_yz", 0.},
    {"fabric_zx", 0.},
    {"fabric_zy", 0.},
    {"fabric_zz", 0.}};
  for (std::size_t i = 0; i < expected.size(); ++i)
    {
      const std::size_t column = table.n_csv_columns - expected.size() + i;
      EXPECT_EQ(table.names[column], expected[i].first);
      EXPECT_EQ(table.row(0)[column], expected[i].second);
    }
  EXPECT_EQ(table.values.size(), table.names.size());
  EXPECT_EQ(table.whole.count("type"), 1u);
  EXPECT_EQ(table.whole.count("axis_x"), 0u);
  EXPECT_EQ(vtu_value(table, "axis"), 5.);
  EXPECT_EQ(table.nonscalars.back().name, "fabric");
  EXPECT_EQ(table.nonscalars.back().n_columns, 9u);
  EXPECT_EQ(table.nonscalars.back().components[3], "yx");
  EXPECT_EQ(vtu_value(table, "displacement"), 2.);

  // Names that the table has, and numbers that its files cannot hold.
  for (const char *name : {"volume", "phase", "pressure", "sigma"})
    {
      CellColumns<2> columns;
      columns.add<double>({name, "", "", 0., AtDivision::copied, true});
      EXPECT_THROW(CellFields<2>(0., 1, columns, false), std::invalid_argument)
        << name;
    }
  CellColumns<2> columns;
  columns.add<std::uint64_t>({"key", "", "", 0, AtDivision::copied, true});
  EXPECT_THROW(CellFields<2>(0., 1, columns, false), std::invalid_argument);
}

TEST(SurfaceFields, FollowNanson)
{
  const BoundaryColumns<3> columns;
  Tensor<1, 3>             N;
  N[2] = 1.;
  std::vector<double> data =
    columns.initial_point(Point<3>(1., 0., 0.), N, 10., SurfaceCondition::slip);
  // F = [2 0 0; 0 3 0; 1 0 1]: the patch spanned by e_x and e_y becomes the one
  // spanned by (2, 0, 1) and (0, 3, 0), whose cross product is (-3, 0, 6)
  Tensor<2, 3> F = diagonal<3>({2., 3., 1.});
  F[2][0]        = 1.;
  const BoundaryView<3, double> point(make_array_view(data), columns);
  point.set(columns.deformation, F);

  SurfaceFields<3> fields(0.5, columns);
  fields.add(4, point, Point<3>(7., 8., 9.));
  auto values = row(fields, 0);
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
  const BoundaryColumns<2> columns;
  Tensor<1, 2>             N;
  N[0] = 1.;
  std::vector<double> data =
    columns.initial_point(Point<2>(), N, 2., SurfaceCondition::free);
  // F = [1 1; 0 3]: the edge along e_y becomes (1, 3), its normal (3, -1)
  Tensor<2, 2> F = diagonal<2>({1., 3.});
  F[0][1]        = 1.;
  const BoundaryView<2, double> point(make_array_view(data), columns);
  point.set(columns.deformation, F);
  const auto vector = point.area_vector();
  EXPECT_NEAR(vector[0], 6., 1e-15);
  EXPECT_NEAR(vector[1], -2., 1e-15);
}
