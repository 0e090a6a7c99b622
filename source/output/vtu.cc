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
#include <numeric>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** A scalar, vector or tensor of every point. */
    struct Array
    {
      std::string  name;
      unsigned int first_column, n_components;
      bool         whole; // numbers without fraction

      std::size_t
      bytes_of_point() const
      {
        return n_components * (whole ? sizeof(std::int32_t) : sizeof(float));
      }
    };

    template <int dim>
    std::vector<Array>
    arrays_of(const PointFields<dim> &fields)
    {
      std::vector<Array> arrays;
      unsigned int       column = 0;
      for (const auto &nonscalar : fields.nonscalars)
        {
          for (; column < nonscalar.first_column; ++column)
            arrays.push_back({fields.names[column],
                              column,
                              1,
                              fields.whole.count(fields.names[column]) > 0});
          arrays.push_back(
            {nonscalar.name, column, nonscalar.n_columns, false});
          column += nonscalar.n_columns;
        }
      for (; column < fields.names.size(); ++column)
        arrays.push_back({fields.names[column],
                          column,
                          1,
                          fields.whole.count(fields.names[column]) > 0});
      return arrays;
    }

    /** Sizes in bytes of a piece's arrays, in the order of the file: positions,
     *  the vertices' connectivity, offsets and types, and the fields'. */
    std::vector<std::uint64_t>
    sizes_of(const std::vector<Array> &arrays, const std::uint64_t n_points)
    {
      std::vector<std::uint64_t> sizes = {3 * sizeof(float) * n_points,
                                          sizeof(std::int32_t) * n_points,
                                          sizeof(std::int32_t) * n_points,
                                          n_points};
      for (const Array &array : arrays)
        sizes.push_back(array.bytes_of_point() * n_points);
      return sizes;
    }

    template <typename T>
    void
    store(const T value, char *&target)
    {
      std::memcpy(target, &value, sizeof(T));
      target += sizeof(T);
    }

    /** A piece's arrays, each behind its size, as they stand in the file. */
    template <int dim>
    std::string
    raw_data(const PointFields<dim> &fields, const std::vector<Array> &arrays)
    {
      constexpr char      vtk_vertex = 1;
      std::vector<char *> targets;
      std::string         data;
      const auto          sizes = sizes_of(arrays, fields.size());
      data.resize(std::accumulate(sizes.begin(),
                                  sizes.end(),
                                  sizes.size() * sizeof(std::uint64_t)));
      char *target = data.data();
      for (const std::uint64_t size : sizes)
        {
          store(size, target);
          targets.push_back(target);
          target += size;
        }
      for (std::size_t i = 0; i < fields.size(); ++i)
        {
          for (unsigned int d = 0; d < 3; ++d)
            store<float>(d < dim ? fields.positions[i][d] : 0., targets[0]);
          store<std::int32_t>(i, targets[1]);
          store<std::int32_t>(i + 1, targets[2]);
          store<char>(vtk_vertex, targets[3]);
          for (std::size_t k = 0; k < arrays.size(); ++k)
            for (unsigned int c = 0; c < arrays[k].n_components; ++c)
              {
                const double value = fields.row(i)[arrays[k].first_column + c];
                if (arrays[k].whole)
                  store<std::int32_t>(std::lround(value), targets[4 + k]);
                else
                  store<float>(value, targets[4 + k]);
              }
        }
      return data;
    }

    /** The part of the file before the data: where each array of each piece
     *  is found in these. */
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
      std::uint64_t offset = 0;
      for (const std::size_t n : n_points)
        {
          const auto sizes = sizes_of(arrays, n);
          auto       size  = sizes.begin();
          const auto array = [&](const std::string &type,
                                 const std::string &name,
                                 const unsigned int n_components) {
            text << "<DataArray type=\"" << type << "\" Name=\"" << name
                 << "\" NumberOfComponents=\"" << n_components
                 << "\" format=\"appended\" offset=\"" << offset << "\"/>\n";
            offset += sizeof(std::uint64_t) + *size++;
          };
          text << "<Piece NumberOfPoints=\"" << n << "\" NumberOfCells=\"" << n
               << "\">\n<Points>\n";
          array("Float32", "Points", 3);
          text << "</Points>\n<Cells>\n";
          array("Int32", "connectivity", 1);
          array("Int32", "offsets", 1);
          array("UInt8", "types", 1);
          text << "</Cells>\n<PointData>\n";
          for (const Array &field : arrays)
            array(field.whole ? "Int32" : "Float32",
                  field.name,
                  field.n_components);
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
    const std::vector<std::string> pieces =
      gather_to_root(raw_data(fields, arrays), comm);
    on_root(comm, [&]() {
      AtomicFile file(path);
      file.write(description(arrays, n_points, time, number));
      for (const std::string &piece : pieces)
        file.write(piece);
      file.write("\n</AppendedData>\n</VTKFile>\n");
      file.commit();
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
