// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/agreement.h>
#include <morula/output/atomic_file.h>
#include <morula/output/gather.h>
#include <morula/output/vtu.h>

#include <deal.II/base/data_out_base.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** A scalar, vector or tensor of every point, as it stands in the file. */
    struct Array
    {
      enum Type
      {
        Float32,
        Int32,
        UInt8
      };

      std::string  name;
      Type         type;
      unsigned int n_components;
      /** A component of a point. */
      std::function<double(std::size_t, unsigned int)> value;

      const char *
      type_name() const
      {
        return type == Float32 ? "Float32" : type == Int32 ? "Int32" : "UInt8";
      }

      /** In the file, with the size in front. */
      std::uint64_t
      n_bytes(const std::uint64_t n_points) const
      {
        return sizeof(std::uint64_t) +
               (type == UInt8 ? 1 : 4) * n_components * n_points;
      }
    };

    /** The points themselves, each a cell of the file, then their fields. */
    template <int dim>
    std::vector<Array>
    arrays_of(const PointFields<dim> &fields)
    {
      constexpr double   vtk_vertex = 1;
      std::vector<Array> arrays(4);
      arrays[0] = {"Points", Array::Float32, 3, {}};
      arrays[1] = {"connectivity", Array::Int32, 1, {}};
      arrays[2] = {"offsets", Array::Int32, 1, {}};
      arrays[3] = {"types", Array::UInt8, 1, {}};

      arrays[0].value = [&fields](const std::size_t i, const unsigned int d) {
        return d < dim ? fields.positions[i][d] : 0.;
      };
      arrays[1].value = [](const std::size_t i, unsigned int) { return i; };
      arrays[2].value = [](const std::size_t i, unsigned int) { return i + 1; };
      arrays[3].value = [](std::size_t, unsigned int) { return vtk_vertex; };

      const auto add = [&](const std::string &name,
                           const unsigned int first_column,
                           const unsigned int n_columns) {
        const bool whole = fields.whole.count(name) > 0;
        arrays.push_back(
          {name, whole ? Array::Int32 : Array::Float32, n_columns, {}});
        arrays.back().value = [&fields, first_column](const std::size_t  i,
                                                      const unsigned int c) {
          return fields.row(i)[first_column + c];
        };
      };
      for (unsigned int column = 0; column < fields.names.size(); ++column)
        if (!fields.names[column].empty())
          add(fields.names[column], column, 1);
      for (const auto &nonscalar : fields.nonscalars)
        add(nonscalar.name, nonscalar.first_column, nonscalar.n_columns);
      return arrays;
    }

    /** This rank's part of an array, behind its size. */
    std::string
    raw_data(const Array &array, const std::size_t n_points)
    {
      std::string data;
      data.reserve(array.n_bytes(n_points));
      const auto add = [&data](const auto value) {
        char bytes[sizeof(value)];
        std::memcpy(bytes, &value, sizeof(value));
        data.append(bytes, sizeof(value));
      };
      add(array.n_bytes(n_points) - sizeof(std::uint64_t));
      for (std::size_t i = 0; i < n_points; ++i)
        for (unsigned int c = 0; c < array.n_components; ++c)
          switch (const double value = array.value(i, c); array.type)
            {
              case Array::Float32:
                add(static_cast<float>(value));
                break;
              case Array::Int32:
                add(static_cast<std::int32_t>(std::lround(value)));
                break;
              case Array::UInt8:
                add(static_cast<std::uint8_t>(value));
                break;
            }
      return data;
    }

    /** The part of the file before the data: where each array of each rank's
     *  piece is found in these, which hold one array after the other. */
    std::string
    description(const std::vector<Array>       &arrays,
                const std::vector<std::size_t> &n_points,
                const double                    time,
                const unsigned int              number)
    {
      std::ostringstream text;
      text.precision(17);
      text << "<?xml version=\"1.0\"?>\n"
           << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
              "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
           << "<UnstructuredGrid>\n<FieldData>\n"
           << "<DataArray type=\"Float64\" Name=\"TIME\" "
              "NumberOfTuples=\"1\" format=\"ascii\">"
           << time << "</DataArray>\n"
           << "<DataArray type=\"Float64\" Name=\"CYCLE\" "
              "NumberOfTuples=\"1\" format=\"ascii\">"
           << number << "</DataArray>\n</FieldData>\n";

      std::vector<std::uint64_t> offsets; // of each array, of the next piece
      std::uint64_t              end = 0;
      for (const Array &array : arrays)
        {
          offsets.push_back(end);
          for (const std::size_t n : n_points)
            end += array.n_bytes(n);
        }
      for (const std::size_t n : n_points)
        {
          const auto describe = [&](const unsigned int k) {
            text << "<DataArray type=\"" << arrays[k].type_name()
                 << "\" Name=\"" << arrays[k].name << "\" NumberOfComponents=\""
                 << arrays[k].n_components << "\" format=\"appended\" offset=\""
                 << offsets[k] << "\"/>\n";
            offsets[k] += arrays[k].n_bytes(n);
          };
          text << "<Piece NumberOfPoints=\"" << n << "\" NumberOfCells=\"" << n
               << "\">\n<Points>\n";
          describe(0);
          text << "</Points>\n<Cells>\n";
          for (unsigned int k = 1; k < 4; ++k)
            describe(k);
          text << "</Cells>\n<PointData>\n";
          for (unsigned int k = 4; k < arrays.size(); ++k)
            describe(k);
          text << "</PointData>\n</Piece>\n";
        }
      text << "</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
      return text.str();
    }
  } // namespace

  // deal.II writes such files as well, but encoded and compressed: output then
  // takes five times as long, a third of a whole run of Fig. 4b, for files that
  // are a fifth smaller (doc/performance.md, Five days of Fig. 4b). Rank 0
  // writes: when the disk is full, MPI I/O fails on some ranks only, and the
  // others wait for them for ever.
  template <int dim>
  void
  write_vtu(const std::string      &path,
            const PointFields<dim> &fields,
            const double            time,
            const unsigned int      number,
            const MPI_Comm          comm)
  {
    const std::vector<Array>       arrays = arrays_of(fields);
    const std::vector<std::size_t> n_points =
      Utilities::MPI::gather(comm, fields.size());
    std::optional<AtomicFile> file; // on rank 0
    on_root(comm, [&]() {
      file.emplace(path);
      file->write(description(arrays, n_points, time, number));
    });
    // One array at a time, as all at once would take as much memory again.
    for (const Array &array : arrays)
      {
        const std::vector<std::string> pieces =
          gather_to_root(raw_data(array, fields.size()), comm);
        on_root(comm, [&]() {
          for (const std::string &piece : pieces)
            file->write(piece);
        });
      }
    on_root(comm, [&]() {
      file->write("\n</AppendedData>\n</VTKFile>\n");
      file->commit();
    });
  }

  void
  write_pvd(const std::string                                 &path,
            const std::vector<std::pair<double, std::string>> &times_and_names,
            const MPI_Comm                                     comm)
  {
    on_root(comm, [&]() {
      const auto directory = std::filesystem::path(path).parent_path();
      std::vector<std::pair<double, std::string>> existing;
      for (const auto &entry : times_and_names)
        if (std::filesystem::exists(directory / entry.second))
          existing.push_back(entry);

      std::ostringstream record;
      record.precision(12);
      DataOutBase::write_pvd_record(record, existing);
      write_atomically(path, record.str());
    });
  }

  template void
  write_vtu<2>(const std::string &,
               const PointFields<2> &,
               const double,
               const unsigned int,
               const MPI_Comm);
  template void
  write_vtu<3>(const std::string &,
               const PointFields<3> &,
               const double,
               const unsigned int,
               const MPI_Comm);
} // namespace Morula
