// ranks: 1 2 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/tissue.h>

#include <gtest/gtest.h>

#include <stdexcept>

#include "particles/random_points.h"

using namespace Morula;

namespace
{
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
      key  = columns.add<std::uint64_t>(
        {"key", "", "64 bits", 0xfedcba9876543210ull});
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

  /** Columns stand one behind the other, rows of tensors too. */
  template <int dim>
  void
  check_rows()
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

  /** A cell without columns that only effects need. */
  template <int dim>
  void
  check_absent()
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

  template <int dim>
  void
  check_daughter()
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

  /** Values that go with their cells from rank to rank, and back. */
  template <int dim>
  void
  check_tissue()
  {
    CellColumns<dim> columns;
    const Own<dim>   own(columns);
    PointList<dim>   all(columns.n_numbers());
    const auto       places = random_points<dim>(300, 150., 0, 1);
    for (std::size_t i = 0; i < places.size(); ++i)
      all.add(places.ids[i],
              places.positions[i],
              columns.founder(places.positions[i], 900.));
    Tissue<dim> tissue(GridParameters(), columns, MPI_COMM_WORLD);
    tissue.place(dealt(all), PointList<dim>());

    const Cells<dim>       &cells = tissue.cells();
    std::vector<Point<dim>> mirrored;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const auto cell = tissue.cell(p);
        cell.set(own.rank, -static_cast<int>(cells.id(p)));
        cell.set(own.home, cells.position(p));
        cell.set(own.fabric, some_tensor<dim>(cells.id(p)));
        mirrored.push_back(Point<dim>(-cells.position(p)));
      }
    tissue.move(mirrored, {});
    EXPECT_EQ(Utilities::MPI::sum(cells.size(), MPI_COMM_WORLD), all.size());
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        EXPECT_EQ(cells.get(own.rank, p), -static_cast<int>(cells.id(p)));
        EXPECT_EQ(cells.get(own.home, p), Point<dim>(-cells.position(p)));
        EXPECT_EQ(cells.get(own.fabric, p), some_tensor<dim>(cells.id(p)));
        EXPECT_EQ(cells.founder_position(p), cells.get(own.home, p));
        EXPECT_EQ(cells.volume(p), 900.);
      }
  }

  template <int dim>
  void
  check_boundary()
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
} // namespace


TEST(Columns, KeepEveryValueApart){MORULA_BOTH_DIMENSIONS(check_rows)}


TEST(Columns, CostNothingUnlessDeclared){MORULA_BOTH_DIMENSIONS(check_absent)}


TEST(Columns, AreInheritedByTheirRules){MORULA_BOTH_DIMENSIONS(check_daughter)}


TEST(Columns, GoWithTheirCells){MORULA_BOTH_DIMENSIONS(check_tissue)}


TEST(Columns, OfBoundaryPoints){MORULA_BOTH_DIMENSIONS(check_boundary)}


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


TEST(Columns, SayHowOthersDiffer)
{
  Columns columns;
  columns.add<double>({"a", "", ""});
  columns.add<Tensor<1, 2>>({"b", "", ""});
  EXPECT_EQ(columns.layout(), "a 1\nb 2\n");
  EXPECT_EQ(columns.differences(columns.layout()), "");
  EXPECT_EQ(columns.differences("b 2\na 1\n"), "has them in another order");
  EXPECT_EQ(columns.differences("a 1\n"), "lacks 'b'");
  EXPECT_EQ(columns.differences("a 1\nb 3\nc 1\n"),
            "has 'b' of 3 numbers, not 2 and has 'c'");
}
