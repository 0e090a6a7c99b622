// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/atomic_file.h>
#include <morula/output/gather.h>
#include <morula/output/vtu.h>

#include <deal.II/base/data_out_base.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
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

      std::string              name;
      Type                     type;
      unsigned int             n_components;
      unsigned int             first_column; // of the fields
      std::vector<std::string> components;   // their names, if they have any

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

    /** Arrays that stand together, one behind the other, for each piece. */
    using Group = std::vector<Array>;

    /** First the points themselves, each a cell of the file, then their fields:
     *  some at a time, as all at once would take as much memory again. */
    template <int dim>
    std::vector<Group>
    groups_of(const PointFields<dim> &fields)
    {
      constexpr std::size_t largest_group = 8;
      const Group           points = {{"Points", Array::Float32, 3, 0, {}},
                                      {"connectivity", Array::Int32, 1, 0, {}},
                                      {"offsets", Array::Int32, 1, 0, {}},
                                      {"types", Array::UInt8, 1, 0, {}}};

      std::vector<Group> groups = {points, {}};
      const auto         add    = [&](const std::string              &name,
                           const unsigned int              first,
                           const unsigned int              n,
                           const std::vector<std::string> &components) {
        const bool whole = fields.whole.count(name) > 0;
        if (groups.back().size() == largest_group)
          groups.emplace_back();
        groups.back().push_back(
          {name, whole ? Array::Int32 : Array::Float32, n, first, components});
      };
      for (unsigned int column = 0; column < fields.names.size(); ++column)
        if (!fields.names[column].empty() &&
            fields.csv_only.count(fields.names[column]) == 0)
          add(fields.names[column], column, 1, {});
      for (const auto &nonscalar : fields.nonscalars)
        add(nonscalar.name,
            nonscalar.first_column,
            nonscalar.n_columns,
            nonscalar.components);
      return groups;
    }

    template <typename T>
    void
    store(const T value, char *&target)
    {
      std::memcpy(target, &value, sizeof(T));
      target += sizeof(T);
    }

    /** Room for a group's arrays, each behind its size; where each begins. */
    std::vector<char *>
    make_room(const Group &group, const std::size_t n_points, std::string &data)
    {
      std::size_t size = 0;
      for (const Array &array : group)
        size += array.n_bytes(n_points);
      data.resize(size);
      std::vector<char *> targets;
      char               *target = data.data();
      for (const Array &array : group)
        {
          char *const end = target + array.n_bytes(n_points);
          store(array.n_bytes(n_points) - sizeof(std::uint64_t), target);
          targets.push_back(target);
          target = end;
        }
      return targets;
    }

    /** This rank's piece of the first group. */
    template <int dim>
    std::string
    points_data(const PointFields<dim> &fields, const Group &group)
    {
      constexpr std::uint8_t    vtk_vertex = 1;
      std::string               data;
      const std::vector<char *> begins = make_room(group, fields.size(), data);
      char *points = begins[0], *connectivity = begins[1], *offsets = begins[2];
      for (std::size_t i = 0; i < fields.size(); ++i)
        {
          for (unsigned int d = 0; d < 3; ++d)
            store<float>(d < dim ? fields.positions[i][d] : 0., points);
          store<std::int32_t>(i, connectivity);
          store<std::int32_t>(i + 1, offsets);
        }
      std::memset(begins[3], vtk_vertex, fields.size());
      return data;
    }

    /** This rank's piece of another group. */
    template <int dim>
    std::string
    fields_data(const PointFields<dim> &fields, const Group &group)
    {
      std::string         data;
      std::vector<char *> targets = make_room(group, fields.size(), data);
      for (std::size_t i = 0; i < fields.size(); ++i)
        for (std::size_t k = 0; k < group.size(); ++k)
          {
            const double *const values = fields.row(i) + group[k].first_column;
            for (unsigned int c = 0; c < group[k].n_components; ++c)
              if (group[k].type == Array::Int32)
                store<std::int32_t>(std::lround(values[c]), targets[k]);
              else
                store<float>(values[c], targets[k]);
          }
      return data;
    }

    /** The part of the file before the data: where each array of each rank's
     *  piece is found in these, which hold one group after the other. */
    std::string
    description(const std::vector<Group>       &groups,
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

      std::vector<std::uint64_t> offsets; // of each group, of the next piece
      std::uint64_t              end = 0;
      for (const Group &group : groups)
        {
          offsets.push_back(end);
          for (const std::size_t n : n_points)
            for (const Array &array : group)
              end += array.n_bytes(n);
        }
      for (const std::size_t n : n_points)
        {
          const auto describe = [&](const unsigned int g, const Array &array) {
            text << "<DataArray type=\"" << array.type_name() << "\" Name=\""
                 << array.name << "\" NumberOfComponents=\""
                 << array.n_components << '"';
            for (std::size_t c = 0; c < array.components.size(); ++c)
              text << " ComponentName" << c << "=\"" << array.components[c]
                   << '"';
            text << " format=\"appended\" offset=\"" << offsets[g] << "\"/>\n";
            offsets[g] += array.n_bytes(n);
          };
          text << "<Piece NumberOfPoints=\"" << n << "\" NumberOfCells=\"" << n
               << "\">\n<Points>\n";
          describe(0, groups[0][0]);
          text << "</Points>\n<Cells>\n";
          for (unsigned int k = 1; k < groups[0].size(); ++k)
            describe(0, groups[0][k]);
          text << "</Cells>\n<PointData>\n";
          for (unsigned int g = 1; g < groups.size(); ++g)
            for (const Array &array : groups[g])
              describe(g, array);
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
    const std::vector<Group>       groups = groups_of(fields);
    const std::vector<std::size_t> n_points =
      Utilities::MPI::gather(comm, fields.size());
    std::optional<AtomicFile> file; // on rank 0
    on_root(comm, [&]() {
      file.emplace(path);
      file->write(description(groups, n_points, time, number));
    });
    for (std::size_t g = 0; g < groups.size(); ++g)
      {
        const std::vector<std::string> pieces =
          gather_to_root(g == 0 ? points_data(fields, groups[g]) :
                                  fields_data(fields, groups[g]),
                         comm);
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
