// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

using Tree = boost::property_tree::ptree;

/** Points 0 ... n-1 dealt out from the second rank on, if there is one. */
template <int dim>
PointFields<dim>
dealt_points(const unsigned int n)
{
  const unsigned int rank    = this_rank();
  const unsigned int n_ranks = number_of_ranks();
  PointFields<dim>   fields;
  fields.names         = {"time", "id", "energy", "both_a", "b"};
  fields.n_csv_columns = 5;
  fields.whole         = {"id"};
  fields.csv_only      = {"time"};
  fields.add_nonscalar("displacement", 3);
  fields.add_nonscalar("sigma", 9);
  fields.combine("both", "both_a", 2);
  for (unsigned int id = 0; id < n; ++id)
    if (n_ranks == 1 || 1 + id % (n_ranks - 1) == rank)
      {
        Point<dim> position;
        for (unsigned int d = 0; d < dim; ++d)
          position[d] = 10. * id + d;
        fields.ids.push_back(id);
        fields.positions.push_back(position);
        for (const double value : {0.5, 1. * id, 0.5 * id, 7. * id, -1. * id})
          fields.values.push_back(value);
        fields.add_vector(0.25 * position);
        for (unsigned int i = 0; i < 9; ++i)
          fields.values.push_back(100. * id + i);
      }
  return fields;
}


/** Writes them. Collective. */
template <int dim>
void
write_dealt(const std::string &path, const unsigned int n)
{
  const auto parts = gather_to_root(dealt_points<dim>(n), MPI_COMM_WORLD);
  on_root(MPI_COMM_WORLD, [&]() { write_vtu(path, parts, 0.5, 2); });
}


/** Checks in Python what the VTK library, that is ParaView, reads. */
const char *const reader = R"(
import sys
import xml.etree.ElementTree
import vtk
for path, dim in ((sys.argv[1], 2), (sys.argv[2], 3)):
    formats = {array.get('format') for array in
               xml.etree.ElementTree.parse(path).iter('DataArray')}
    assert formats == {'ascii', 'binary'}, formats
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    assert grid.GetNumberOfPoints() == 7 and grid.GetNumberOfCells() == 7
    assert grid.GetCellType(0) == vtk.VTK_VERTEX
    assert grid.GetFieldData().GetArray('TIME').GetValue(0) == 0.5
    for i in range(7):
        n = data.GetArray('id').GetValue(i)
        x = [10 * n + d if d < dim else 0 for d in range(3)]
        assert grid.GetPoint(i) == tuple(x), grid.GetPoint(i)
        assert data.GetArray('id').GetDataTypeAsString() == 'int'
        assert data.GetArray('energy').GetValue(i) == 0.5 * n
        assert data.GetArray('both').GetTuple(i) == (7 * n, -n)
        u = data.GetArray('displacement').GetTuple(i)
        assert u == tuple(0.25 * c for c in x), u
        sigma = data.GetArray('sigma').GetTuple(i)
        assert sigma == tuple(100 * n + k for k in range(9)), sigma
    both = data.GetArray('both')
    names = [both.GetComponentName(k) for k in range(2)]
    assert names == ['a', 'b'], names
    ids = sorted(data.GetArray('id').GetValue(i) for i in range(7))
    assert ids == list(range(7)), ids
)";

/** The command of one; the first in the path may be without. Collective. */
std::string
python_with_vtk()
{
  std::string found;
  on_root(MPI_COMM_WORLD, [&]() {
    for (const std::string python : {"python3", "/usr/bin/python3"})
      if (found.empty() &&
          std::system((python + " -c 'import vtk' 2> /dev/null").c_str()) == 0)
        found = python;
  });
  return Utilities::MPI::broadcast(MPI_COMM_WORLD, found);
}


TEST(Vtu, IsReadByTheVtkLibrary)
{
  const ScratchDirectory directory;
  write_dealt<2>(directory / "a.vtu", 7);
  write_dealt<3>(directory / "b.vtu", 7);
  const std::string python = python_with_vtk();
  if (python.empty())
    GTEST_SKIP() << "there is no Python with the VTK library";

  int status = 0;
  on_root(MPI_COMM_WORLD, [&]() {
    write(directory / "reader.py", reader);
    status =
      std::system((python + " '" + (directory / "reader.py") + "' '" +
                   (directory / "a.vtu") + "' '" + (directory / "b.vtu") + "'")
                    .c_str());
  });
  EXPECT_EQ(status, 0);
}


TEST(Pvd, ListsTheFilesThatExist)
{
  const ScratchDirectory directory;
  on_root(MPI_COMM_WORLD, [&]() {
    write(directory / "cells-0000.vtu", "");
    write(directory / "cells-0002.vtu", "");
  });
  write_pvd(directory / "cells.pvd",
            {{0., "cells-0000.vtu"},
             {0.25, "cells-0001.vtu"},
             {1. / 3., "cells-0002.vtu"}},
            MPI_COMM_WORLD);

  Tree record;
  boost::property_tree::read_xml(directory / "cells.pvd", record);
  std::vector<std::pair<double, std::string>> entries;
  for (const auto &entry : record.get_child("VTKFile.Collection"))
    if (entry.first == "DataSet")
      entries.emplace_back(entry.second.get<double>("<xmlattr>.timestep"),
                           entry.second.get<std::string>("<xmlattr>.file"));
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].first, 0.);
  EXPECT_EQ(entries[0].second, "cells-0000.vtu");
  EXPECT_NEAR(entries[1].first, 1. / 3., 1e-11);
  EXPECT_EQ(entries[1].second, "cells-0002.vtu");
}
