// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/atomic_file.h>
#include <morula/output/gather.h>
#include <morula/output/vtu.h>

#include <deal.II/base/data_out_base.h>

#include <algorithm>
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
    /** A scalar, vector or tensor of every point. */
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

      /** Begin of its element in the file. */
      std::string
      tag() const
      {
        std::ostringstream text;
        text << "<DataArray type=\""
             << (type == Float32 ? "Float32" :
                 type == Int32   ? "Int32" :
                                   "UInt8")
             << "\" Name=\"" << name << "\" NumberOfComponents=\""
             << n_components << '"';
        for (std::size_t c = 0; c < components.size(); ++c)
          text << " ComponentName" << c << "=\"" << components[c] << '"';
        text << " format=\"binary\">\n";
        return text.str();
      }

      /** With the size in front. */
      std::uint64_t
      n_bytes(const std::uint64_t n_points) const
      {
        return sizeof(std::uint64_t) +
               (type == UInt8 ? 1 : 4) * n_components * n_points;
      }
    };

    /** Arrays that are made at the same time. */
    using Group = std::vector<Array>;

    /** First the points themselves, then each as a cell of the file, then their
     *  fields: some at a time, as all at once would take as much memory again.
     */
    template <int dim>
    std::vector<Group>
    groups_of(const PointFields<dim> &fields)
    {
      constexpr std::size_t largest_group = 8;
      const Group           points = {{"Points", Array::Float32, 3, 0, {}}};
      const Group           cells  = {{"connectivity", Array::Int32, 1, 0, {}},
                                      {"offsets", Array::Int32, 1, 0, {}},
                                      {"types", Array::UInt8, 1, 0, {}}};

      std::vector<Group> groups = {points, cells, {}};
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

    /** This rank's part of the first group. */
    template <int dim>
    std::string
    points_data(const PointFields<dim> &fields, const Group &group)
    {
      std::string data;
      char       *target = make_room(group, fields.size(), data)[0];
      for (const Point<dim> &position : fields.positions)
        for (unsigned int d = 0; d < 3; ++d)
          store<float>(d < dim ? position[d] : 0., target);
      return data;
    }

    /** Of the second one. */
    std::string
    cells_data(const std::size_t n_points, const Group &group)
    {
      constexpr std::uint8_t    vtk_vertex = 1;
      std::string               data;
      const std::vector<char *> begins       = make_room(group, n_points, data);
      char                     *connectivity = begins[0], *offsets = begins[1];
      for (std::size_t i = 0; i < n_points; ++i)
        {
          store<std::int32_t>(i, connectivity);
          store<std::int32_t>(i + 1, offsets);
        }
      std::memset(begins[2], vtk_vertex, n_points);
      return data;
    }

    /** Of another one. */
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

    /** Appends data in base64. deal.II's encode_base64() takes three times as
     *  long as all else in an output. */
    void
    append_base64(const char *data, const std::size_t size, std::string &text)
    {
      constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      const std::size_t begin = text.size();
      text.resize(begin + (size + 2) / 3 * 4, '=');
      char *target = &text[begin];
      for (std::size_t i = 0; i < size; i += 3)
        {
          const std::size_t n    = std::min<std::size_t>(size - i, 3);
          std::uint32_t     bits = 0;
          for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 |
                   (k < n ? static_cast<unsigned char>(data[i + k]) : 0u);
          for (std::size_t k = 0; k < 4; ++k, ++target)
            if (k <= n)
              *target = digits[bits >> (18 - 6 * k) & 63];
        }
    }

    const std::string end_of_array = "\n</DataArray>\n";
    const std::string end_of_piece = "</PointData>\n</Piece>\n";
    const std::string end_of_file  = "</UnstructuredGrid>\n</VTKFile>\n";

    /** The arrays of a group as they stand in this rank's piece. */
    template <int dim>
    std::string
    elements(const PointFields<dim>   &fields,
             const std::vector<Group> &groups,
             const std::size_t         g)
    {
      const Group      &group = groups[g];
      const std::string data  = g == 0 ? points_data(fields, group) :
                                g == 1 ? cells_data(fields.size(), group) :
                                         fields_data(fields, group);
      std::string       text;
      std::size_t       begin = 0;
      for (const Array &array : group)
        {
          const std::size_t size = array.n_bytes(fields.size());
          text += array.tag();
          append_base64(data.data() + begin, size, text);
          text += end_of_array;
          begin += size;
        }
      return text;
    }

    std::string
    head(const double time, const unsigned int number)
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
      return text.str();
    }

    /** What stands before a group of a piece. */
    std::string
    before(const std::size_t g, const std::size_t n_points)
    {
      if (g > 2)
        return "";
      if (g > 0)
        return g == 1 ? "</Points>\n<Cells>\n" : "</Cells>\n<PointData>\n";
      const std::string n = std::to_string(n_points);
      return "<Piece NumberOfPoints=\"" + n + "\" NumberOfCells=\"" + n +
             "\">\n<Points>\n";
    }

    /** Size of a rank's piece. */
    std::uint64_t
    n_bytes(const std::vector<Group> &groups, const std::uint64_t n_points)
    {
      std::uint64_t size = end_of_piece.size();
      for (std::size_t g = 0; g < groups.size(); ++g)
        {
          size += before(g, n_points).size();
          for (const Array &array : groups[g])
            size += array.tag().size() + (array.n_bytes(n_points) + 2) / 3 * 4 +
                    end_of_array.size();
        }
      return size;
    }

    /** A group of this rank's piece, and the end of the piece behind the last
     *  one. */
    template <int dim>
    std::string
    part_of_piece(const PointFields<dim>   &fields,
                  const std::vector<Group> &groups,
                  const std::size_t         g)
    {
      return before(g, fields.size()) + elements(fields, groups, g) +
             (g + 1 == groups.size() ? end_of_piece : "");
    }

    /** All ranks write, each its piece. @p ends of the pieces */
    template <int dim>
    void
    write_together(SharedFile                       &file,
                   const std::string                &beginning,
                   const PointFields<dim>           &fields,
                   const std::vector<Group>         &groups,
                   const std::vector<std::uint64_t> &ends,
                   const MPI_Comm                    comm)
    {
      const unsigned int rank = Utilities::MPI::this_mpi_process(comm);
      everywhere(comm, [&]() {
        std::uint64_t offset = rank == 0 ? beginning.size() : ends[rank - 1];
        if (rank == 0)
          file.write(beginning, 0);
        for (std::size_t g = 0; g < groups.size(); ++g)
          {
            const std::string text = part_of_piece(fields, groups, g);
            file.write(text, offset);
            offset += text.size();
          }
        AssertThrow(offset == ends[rank], ExcInternalError());
        if (rank + 1 == ends.size())
          file.write(end_of_file, offset);
      });
      file.commit();
    }

    /** Rank 0 writes what it gets from the others, one group of one rank after
     *  the other: as little as possible is in memory. */
    template <int dim>
    void
    write_gathered(const std::string        &path,
                   const std::string        &beginning,
                   const PointFields<dim>   &fields,
                   const std::vector<Group> &groups,
                   const MPI_Comm            comm)
    {
      const unsigned int        rank = Utilities::MPI::this_mpi_process(comm);
      std::optional<AtomicFile> file; // on rank 0
      on_root(comm, [&]() {
        file.emplace(path);
        file->write(beginning);
      });
      for (unsigned int piece = 0;
           piece < Utilities::MPI::n_mpi_processes(comm);
           ++piece)
        for (std::size_t g = 0; g < groups.size(); ++g)
          {
            const std::vector<std::string> texts =
              gather_to_root(piece == rank ? part_of_piece(fields, groups, g) :
                                             std::string(),
                             comm);
            on_root(comm, [&]() { file->write(texts[piece]); });
          }
      on_root(comm, [&]() {
        file->write(end_of_file);
        file->commit();
      });
    }
  } // namespace

  // deal.II writes such files as well, but compressed: output then takes five
  // times as long, a third of a whole run of Fig. 4b (doc/performance.md, Five
  // days of Fig. 4b). VTK can append raw data, which are a quarter smaller, but
  // such a file is not XML: the ParaView of Debian 12 fails on them, and on
  // appended base64 as well.
  template <int dim>
  void
  write_vtu(const std::string      &path,
            const PointFields<dim> &fields,
            const double            time,
            const unsigned int      number,
            const MPI_Comm          comm,
            const std::uint64_t     shared_from)
  {
    const std::vector<Group>   groups    = groups_of(fields);
    const std::string          beginning = head(time, number);
    std::vector<std::uint64_t> ends;
    std::uint64_t              end = beginning.size();
    for (const std::uint64_t n_points :
         Utilities::MPI::all_gather(comm, std::uint64_t(fields.size())))
      ends.push_back(end += n_bytes(groups, n_points));

    const std::uint64_t size = end + end_of_file.size();
    if (ends.size() > 1 && size >= shared_from)
      {
        SharedFile file(path, size, comm);
        if (file.is_shared())
          {
            write_together(file, beginning, fields, groups, ends, comm);
            return;
          }
      }
    write_gathered(path, beginning, fields, groups, comm);
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
               const MPI_Comm,
               const std::uint64_t);
  template void
  write_vtu<3>(const std::string &,
               const PointFields<3> &,
               const double,
               const unsigned int,
               const MPI_Comm,
               const std::uint64_t);
} // namespace Morula
