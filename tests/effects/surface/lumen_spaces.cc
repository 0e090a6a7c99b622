// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// ranks: 1 3

#include <morula/effects/surface/lumen_spaces.h>
#include <morula/surface/surface_from_cells.h>

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "common/tests.h"

using namespace Morula;

namespace
{
  /** Body, cavity that it faces and space of some points. */
  using Points = std::vector<std::array<unsigned int, 3>>;

  template <int dim>
  struct Surface
  {
    BoundaryColumns<dim>         columns;
    std::unique_ptr<Tissue<dim>> tissue;

    explicit Surface(const Points &points)
    {
      columns.need_bodies();
      columns.cavity = columns.template add<unsigned int>({"cavity", "", "c"});
      const auto lumen = columns.template add<unsigned int>({"lumen", "", "l"});
      tissue           = std::make_unique<Tissue<dim>>(GridParameters(),
                                             CellColumns<dim>(),
                                             MPI_COMM_WORLD,
                                             columns);
      PointList<dim> list(columns.n_numbers());
      for (std::size_t k = 0; k < points.size(); ++k)
        if (k % Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) ==
            Utilities::MPI::this_mpi_process(MPI_COMM_WORLD))
          {
            auto       row                  = columns.initial_row();
            const auto view                 = make_array_view(row);
            const auto [body, faced, space] = points[k];
            columns.body.set(view, body);
            columns.cavity.set(view, faced);
            lumen.set(view, space);
            Point<dim> x;
            x[0] = 90. * k;
            list.add(k, x, view);
          }
      tissue->place(PointList<dim>(), list);
    }

    /** The spaces of the points of all ranks, in their order. */
    std::vector<unsigned int>
    spaces() const
    {
      std::map<unsigned int, unsigned int> own;
      const auto                          &points = tissue->boundary_points();
      for (unsigned int p = 0; p < points.size(); ++p)
        own[points.id(p)] = points[p].get(space_column(*tissue));
      std::map<unsigned int, unsigned int> all;
      for (const auto &of_rank :
           Utilities::MPI::all_gather(MPI_COMM_WORLD, own))
        all.insert(of_rank.begin(), of_rank.end());
      std::vector<unsigned int> list;
      for (const auto &[id, space] : all)
        list.push_back(space);
      return list;
    }
  };

  using Numbers            = std::vector<unsigned int>;
  constexpr unsigned int a = 2, b = 3;
} // namespace


// Stray patches go to the space of their cavity, and outside there is none.
TEST_2D_3D(LumenSpaces, AreTheCavitiesOfMostOfTheirPoints)
{
  Surface<dim> surface({{{0, a, 1}},
                        {{0, a, 1}},
                        {{0, a, 2}},
                        {{0, b, 2}},
                        {{0, b, 2}},
                        {{0, b, 0}},
                        {{0, 1, 0}},
                        {{0, 1, 2}}});
  const auto   found = find_spaces({false, false}, *surface.tissue);
  EXPECT_EQ(found.into, (Numbers{1, 2}));
  EXPECT_EQ(found.n_cavities, (Numbers{1, 1}));
  EXPECT_TRUE(found.split_from.empty());
  EXPECT_EQ(surface.spaces(), (Numbers{1, 1, 1, 2, 2, 2, 0, 0}));
}

TEST_2D_3D(LumenSpaces, Merge)
{
  Surface<dim> surface({{{0, a, 1}}, {{0, a, 2}}, {{0, a, 2}}, {{0, 1, 0}}});
  const auto   found = find_spaces({false, false}, *surface.tissue);
  EXPECT_EQ(found.into, (Numbers{2, 2}));
  EXPECT_EQ(surface.spaces(), (Numbers{2, 2, 2, 0}));
}

TEST_2D_3D(LumenSpaces, Split)
{
  const Points points{{{0, a, 1}}, {{0, b, 1}}, {{0, b, 1}}, {{0, 1, 0}}};
  Surface<dim> surface(points), together(points);
  auto         found = find_spaces({false}, *surface.tissue);
  EXPECT_EQ(found.into, (Numbers{1}));
  EXPECT_EQ(found.split_from, (Numbers{1}));
  EXPECT_EQ(surface.spaces(), (Numbers{2, 1, 1, 0}));
  found = find_spaces({true}, *together.tissue);
  EXPECT_TRUE(found.split_from.empty());
  EXPECT_EQ(found.n_cavities, (Numbers{2}));
  EXPECT_EQ(together.spaces(), (Numbers{1, 1, 1, 0}));
}

TEST_2D_3D(LumenSpaces, OpenAndClose)
{
  Surface<dim> surface({{{0, 1, 1}}, {{0, 1, 1}}, {{0, a, 1}}, {{0, b, 0}}});
  const auto   found = find_spaces({false, false}, *surface.tissue);
  EXPECT_EQ(found.into, (Numbers{0, 0}));
  EXPECT_EQ(found.has_opened, (std::vector<bool>{true, false}));
  EXPECT_EQ(surface.spaces(), (Numbers{0, 0, 0, 0}));
}

// A body in the cavity of another one, and tracked surfaces.
TEST_2D_3D(LumenSpaces, KnowOtherBodies)
{
  const unsigned int of_second = faced_cavity(1, 1);
  Surface<dim>       surface({{{1, of_second, 1}},
                              {{1, of_second, 1}},
                              {{1, of_second, 1}},
                              {{0, 1, 1}},
                              {{1, 1, 1}},
                              {{2, 0, 2}},
                              {{2, 0, 0}}});
  const auto         found = find_spaces({false, false}, *surface.tissue);
  EXPECT_EQ(found.into, (Numbers{1, 2}));
  EXPECT_EQ(surface.spaces(), (Numbers{1, 1, 1, 1, 0, 2, 0}));
}
