// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

enum class Fate
{
  lives,
  dies = 7
};

/** What an effect of a user's own might declare, of every type. */
template <int dim>
struct Own
{
  Column<double>         dose, amount, age;
  Column<int>            rank;
  Column<unsigned int>   type;
  Column<std::uint64_t>  key;
  Column<Fate>           fate;
  Column<Tensor<1, dim>> polarity;
  Column<Point<dim>>     home;
  Column<Tensor<2, dim>> fabric;

  explicit Own(Columns &columns)
  {
    dose   = columns.add<double>({"dose", "nM", "dose received", 0.5});
    amount = columns.add<double>(
      {"amount", "mol", "amount inside", 8., AtDivision::halved});
    age  = columns.add<double>({"age", "day", "age", 3., AtDivision::reset});
    rank = columns.add<int>({"rank", "", "a signed number", -3});
    type = columns.add<unsigned int>({"type", "", "kind of cell", 4u});
    key =
      columns.add<std::uint64_t>({"key", "", "64 bits", 0xfedcba9876543210ull});
    fate     = columns.add<Fate>({"fate", "", "what it does", Fate::dies});
    polarity = columns.add<Tensor<1, dim>>({"polarity", "", "a direction"});
    home     = columns.add<Point<dim>>({"home", "um", "a place"});
    fabric   = columns.add<Tensor<2, dim>>(
      {"fabric", "", "a tensor", unit_tensor<dim>()});
  }
};

template <int dim>
Tensor<2, dim>
some_tensor(const double a)
{
  Tensor<2, dim> t;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      t[i][j] = a + 10. * i + j;
  return t;
}


// Columns stand one behind the other, rows of tensors too.
TEST_2D_3D(Columns, KeepEveryValueApart)
{
  CellColumns<dim>   columns;
  const unsigned int n_core = dim + 1 + dim * dim;
  EXPECT_EQ(columns.n_numbers(), n_core);
  const Own<dim>     own(columns);
  const unsigned int n_own = 8 + 2 * dim + dim * dim;
  EXPECT_EQ(columns.n_numbers(), n_core + n_own);
  unsigned int next = 0;
  for (const Columns::Entry &entry : columns.entries())
    {
      EXPECT_EQ(entry.first, next);
      next += entry.n;
    }
  EXPECT_EQ(next, columns.n_numbers());

  // Initial values; and every column keeps its own value.
  Point<dim> X;
  X[1]                            = 5.;
  std::vector<double>         row = columns.founder(X, 80.);
  const CellView<dim, double> cell(make_array_view(row), columns);
  EXPECT_EQ(cell.founder_position(), X);
  EXPECT_EQ(cell.initial_volume(), 80.);
  EXPECT_EQ(cell.F(), unit_tensor<dim>());
  EXPECT_EQ(cell.get(own.dose), 0.5);
  EXPECT_EQ(cell.get(own.rank), -3);
  EXPECT_EQ(cell.get(own.type), 4u);
  EXPECT_EQ(cell.get(own.key), 0xfedcba9876543210ull);
  EXPECT_EQ(cell.get(own.fate), Fate::dies);
  EXPECT_EQ(cell.get(own.polarity), (Tensor<1, dim>()));
  EXPECT_EQ(cell.get(own.fabric), unit_tensor<dim>());

  const Tensor<2, dim> F = some_tensor<dim>(0.5), M = some_tensor<dim>(-1.);
  Tensor<1, dim>       n;
  n[dim - 1] = -2.;
  cell.set(columns.deformation, F);
  cell.set(own.dose, 1. / 3.);
  cell.set(own.rank, -2000000000);
  cell.set(own.type, 4000000000u);
  cell.set(own.key, 0xffffffffffffffffull);
  cell.set(own.fate, Fate::lives);
  cell.set(own.polarity, n);
  cell.set(own.home, X);
  cell.set(own.fabric, M);
  EXPECT_EQ(cell.F(), F);
  EXPECT_EQ(row[dim + 2], F[0][1]); // row by row, as in older snapshots
  EXPECT_EQ(cell.get(own.dose), 1. / 3.);
  EXPECT_EQ(cell.get(own.rank), -2000000000);
  EXPECT_EQ(cell.get(own.type), 4000000000u);
  EXPECT_EQ(cell.get(own.key), 0xffffffffffffffffull);
  EXPECT_EQ(cell.get(own.fate), Fate::lives);
  EXPECT_EQ(cell.get(own.polarity), n);
  EXPECT_EQ(cell.get(own.home), X);
  EXPECT_EQ(cell.get(own.fabric), M);
  EXPECT_EQ(cell.get(own.amount), 8.);
  EXPECT_EQ(cell.founder_position(), X);
}


// A cell without columns that only effects need.
TEST_2D_3D(Columns, CostNothingUnlessDeclared)
{
  const CellColumns<dim>            columns;
  const std::vector<double>         row = columns.initial_row();
  const CellView<dim, const double> cell(make_array_view(row), columns);
  EXPECT_FALSE(columns.growth.exists());
  EXPECT_EQ(cell.growth(), unit_tensor<dim>());
  EXPECT_EQ(cell.parent(), -1);
  EXPECT_EQ(cell.generation(), 0u);

  CellColumns<dim> more;
  more.need_growth();
  more.need_lineage();
  const unsigned int n = more.n_numbers();
  EXPECT_EQ(n, columns.n_numbers() + dim * dim + 2);
  more.need_growth();
  more.need_lineage();
  EXPECT_EQ(more.n_numbers(), n);
}


TEST_2D_3D(Columns, AreInheritedByTheirRules)
{
  CellColumns<dim> columns;
  columns.need_lineage();
  const Own<dim>              own(columns);
  std::vector<double>         row = columns.founder(Point<dim>(), 30.);
  const CellView<dim, double> mother(make_array_view(row), columns);
  mother.set(columns.deformation, some_tensor<dim>(2.));
  mother.set(own.dose, 9.);
  mother.set(own.amount, 7.);
  mother.set(own.age, 11.);
  const std::vector<double>         born = columns.daughter(mother.row());
  const CellView<dim, const double> daughter(make_array_view(born), columns);
  EXPECT_EQ(daughter.initial_volume(), 15.);
  EXPECT_EQ(daughter.F(), some_tensor<dim>(2.));
  EXPECT_EQ(daughter.get(own.dose), 9.);
  EXPECT_EQ(daughter.get(own.amount), 3.5);
  EXPECT_EQ(daughter.get(own.age), 3.);
  EXPECT_EQ(daughter.get(own.key), mother.get(own.key));
  EXPECT_EQ(mother.get(own.amount), 7.);
}


TEST_2D_3D(Columns, OfBoundaryPoints)
{
  Tensor<1, dim> N;
  N[0] = -1.;
  Point<dim> X;
  X[dim - 1] = 3.;
  for (const bool with_patch : {false, true})
    {
      const BoundaryColumns<dim> columns(with_patch);
      EXPECT_EQ(columns.n_numbers(),
                2 * dim + 2 + dim * dim + (with_patch ? dim * dim : 0));
      const auto row =
        columns.initial_point(X, N, 4., SurfaceCondition::loaded);
      const BoundaryView<dim> point(make_array_view(row), columns);
      EXPECT_EQ(point.has_patch(), with_patch);
      EXPECT_EQ(point.initial_position(), X);
      EXPECT_EQ(point.seed_position(), X);
      EXPECT_EQ(point.initial_normal(), N);
      EXPECT_EQ(point.initial_area(), 4.);
      EXPECT_EQ(point.condition(), SurfaceCondition::loaded);
      EXPECT_EQ(point.area_vector(), 4. * N);
      EXPECT_EQ(row[2 * dim + 1], 3.); // the condition, as in older snapshots
    }
}


TEST(Columns, HaveNamesOfTheirOwn)
{
  CellColumns<2> columns;
  columns.add<double>({"dose", "nM", "dose received"});
  EXPECT_THROW(columns.add<int>({"dose", "", "another"}),
               std::invalid_argument);
  for (const char *name : {"", "Dose", "my dose", "a,b", "a/b"})
    EXPECT_THROW(columns.add<double>({name, "", ""}), std::invalid_argument);
  EXPECT_TRUE(columns.find<double>("dose").exists());
  EXPECT_FALSE(columns.find<int>("dose").exists());
  EXPECT_FALSE((columns.find<Tensor<1, 2>>("dose").exists()));
  EXPECT_FALSE(columns.find<double>("rate").exists());
}
