// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/atomic_file.h>
#include <morula/output/gather.h>
#include <morula/output/vtu.h>

#include <deal.II/base/data_out_base.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

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

    const std::string end_of_array = "\n</DataArray>\n";
    const std::string end_of_piece = "</PointData>\n</Piece>\n";
    const std::string end_of_file  = "</UnstructuredGrid>\n</VTKFile>\n";

    /** Size of an array with what stands around it. */
    std::uint64_t
    n_bytes_in_file(const Array &array, const std::uint64_t n_points)
    {
      return array.tag().size() + (array.n_bytes(n_points) + 2) / 3 * 4 +
             end_of_array.size();
    }

    /** The digits of base64 for 12 bits, two each. */
    using Pairs = std::array<std::array<char, 2>, 4096>;

    constexpr Pairs
    base64_pairs()
    {
      constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      Pairs pairs{};
      for (unsigned int bits = 0; bits < pairs.size(); ++bits)
        {
          pairs[bits][0] = digits[bits >> 6];
          pairs[bits][1] = digits[bits & 63];
        }
      return pairs;
    }

    /** Writes numbers in base64 to where there is room for them. deal.II's
     *  encode_base64() takes three times as long as all else in an output. */
    class Base64
    {
    public:
      explicit Base64(char *target)
        : target(target)
      {}

      template <typename T>
      void
      add(const T value)
      {
        if (n + sizeof(T) > buffer.size())
          flush();
        std::memcpy(&buffer[n], &value, sizeof(T));
        n += sizeof(T);
      }

      /** Writes what is left; returns the end. */
      char *
      finish()
      {
        flush();
        if (n > 0)
          {
            std::fill(buffer.begin() + n, buffer.begin() + 3, 0);
            encode(0);
            std::fill(target + n + 1, target + 4, '=');
            target += 4;
          }
        return target;
      }

    private:
      void
      encode(const std::size_t i)
      {
        static constexpr Pairs pairs = base64_pairs();
        const std::uint32_t    bits =
          buffer[i] << 16 | buffer[i + 1] << 8 | buffer[i + 2];
        std::memcpy(target, pairs[bits >> 12].data(), 2);
        std::memcpy(target + 2, pairs[bits & 4095].data(), 2);
      }

      /** Writes all whole threes of bytes. */
      void
      flush()
      {
        std::size_t i = 0;
        for (; i + 3 <= n; i += 3, target += 4)
          encode(i);
        std::copy(buffer.begin() + i, buffer.begin() + n, buffer.begin());
        n -= i;
      }

      std::array<unsigned char, 3072> buffer;
      std::size_t                     n = 0; // bytes in it
      char                           *target;
    };

    /** The arrays of a group as they stand in a file. */
    class GroupText
    {
    public:
      GroupText(const Group &group, const std::size_t n_points)
      {
        std::size_t size = 0;
        for (const Array &array : group)
          size += n_bytes_in_file(array, n_points);
        text.resize(size);
        char      *place = text.data();
        const auto put   = [&place](const std::string &what) {
          place = std::copy(what.begin(), what.end(), place);
        };
        for (const Array &array : group)
          {
            put(array.tag());
            arrays.emplace_back(place);
            arrays.back().add<std::uint64_t>(array.n_bytes(n_points) -
                                             sizeof(std::uint64_t));
            place += (array.n_bytes(n_points) + 2) / 3 * 4;
            put(end_of_array);
          }
      }

      /** Where the values of array number @p k go. */
      Base64 &
      array(const std::size_t k)
      {
        return arrays[k];
      }

      std::string
      finish()
      {
        for (Base64 &array : arrays)
          array.finish();
        return std::move(text);
      }

    private:
      std::string         text;
      std::vector<Base64> arrays;
    };

    /** The first group. */
    template <int dim>
    void
    add_points(const PointFields<dim> &fields, GroupText &text)
    {
      for (const Point<dim> &position : fields.positions)
        for (unsigned int d = 0; d < 3; ++d)
          text.array(0).add<float>(d < dim ? position[d] : 0.);
    }

    /** The second one. */
    void
    add_cells(const std::size_t n_points, GroupText &text)
    {
      constexpr std::uint8_t vtk_vertex = 1;
      for (std::size_t i = 0; i < n_points; ++i)
        {
          text.array(0).add<std::int32_t>(i);
          text.array(1).add<std::int32_t>(i + 1);
          text.array(2).add(vtk_vertex);
        }
    }

    /** Another one. */
    template <int dim>
    void
    add_fields(const PointFields<dim> &fields,
               const Group            &group,
               GroupText              &text)
    {
      for (std::size_t i = 0; i < fields.size(); ++i)
        for (std::size_t k = 0; k < group.size(); ++k)
          {
            const double *const values = fields.row(i) + group[k].first_column;
            for (unsigned int c = 0; c < group[k].n_components; ++c)
              if (group[k].type == Array::Int32)
                text.array(k).add<std::int32_t>(std::lround(values[c]));
              else
                text.array(k).add<float>(values[c]);
          }
    }

    /** The arrays of a group as they stand in this rank's piece. */
    template <int dim>
    std::string
    elements(const PointFields<dim>   &fields,
             const std::vector<Group> &groups,
             const std::size_t         g)
    {
      GroupText text(groups[g], fields.size());
      if (g == 0)
        add_points(fields, text);
      else if (g == 1)
        add_cells(fields.size(), text);
      else
        add_fields(fields, groups[g], text);
      return text.finish();
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
            size += n_bytes_in_file(array, n_points);
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
