// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/output/output_file.h>
#include <morula/output/point_fields.h>

#include <deal.II/base/data_out_base.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

namespace Morula
{
  namespace
  {
    const std::string end_of_array = "\n</DataArray>\n";
    const std::string end_of_piece = "</PointData>\n</Piece>\n";

    /** A scalar, vector or tensor of every point, as a VTU file holds it. */
    struct VtuArray
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

      /** The number of bytes of its values, with the size in front. */
      std::uint64_t
      n_bytes(const std::uint64_t n_points) const
      {
        // The size in front is part of the array.
        return sizeof(std::uint64_t) +
               (type == UInt8 ? 1 : 4) * n_components * n_points;
      }

      /** The number of bytes of its element, in base64. */
      std::uint64_t
      n_bytes_in_file(const std::uint64_t n_points) const
      {
        // Three bytes take four digits.
        return tag().size() + (n_bytes(n_points) + 2) / 3 * 4 +
               end_of_array.size();
      }
    };

    /** Arrays that are made at the same time. */
    using Group = std::vector<VtuArray>;

    template <int dim>
    std::vector<Group>
    groups_of(const PointFields<dim> &fields)
    {
      // Groups are made one after the other: coordinates, cells, then the
      // fields, some at a time, so that a group's values come from the same
      // rows while they are in the cache.
      constexpr std::size_t largest_group = 8;
      const Group           points = {{"Points", VtuArray::Float32, 3, 0, {}}};
      const Group cells = {{"connectivity", VtuArray::Int32, 1, 0, {}},
                           {"offsets", VtuArray::Int32, 1, 0, {}},
                           {"types", VtuArray::UInt8, 1, 0, {}}};

      std::vector<Group> groups = {points, cells, {}};
      const auto         add    = [&](const std::string              &name,
                           const unsigned int              first,
                           const unsigned int              n,
                           const std::vector<std::string> &components) {
        const bool whole = fields.whole.count(name) > 0;
        if (groups.back().size() == largest_group)
          groups.emplace_back();
        groups.back().push_back({name,
                                 whole ? VtuArray::Int32 : VtuArray::Float32,
                                 n,
                                 first,
                                 components});
      };
      for (unsigned int column = 0; column < fields.names.size(); ++column)
        if (!fields.names[column].empty() &&
            // Columns without a name, and those for CSV alone, are no arrays
            // here.
            fields.csv_only.count(fields.names[column]) == 0)
          add(fields.names[column], column, 1, {});
      for (const auto &nonscalar : fields.nonscalars)
        add(nonscalar.name,
            nonscalar.first_column,
            nonscalar.n_columns,
            nonscalar.components);
      return groups;
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
     *  encode_base64() took three times as long as all else in an output. */
    class Base64
    {
    public:
      explicit Base64(char *target)
        : target(target)
      {}

      template <typename T>
      void
      add(const T *const values, const std::size_t n_values)
      {
        // Base64 turns three bytes into four digits. Bytes that do not fill
        // three wait for the next call. 12 bits at a time are looked up, two
        // digits each.
        const auto *bytes     = reinterpret_cast<const unsigned char *>(values);
        const auto *const end = bytes + n_values * sizeof(T);
        for (; n > 0 && n < 3 && bytes != end; ++bytes)
          rest[n++] = *bytes;
        if (n == 3)
          {
            target = encode(rest.data(), rest.data() + n, target);
            n      = 0;
          }
        const auto *const whole = bytes + (end - bytes) / 3 * 3;
        target                  = encode(bytes, whole, target);
        for (bytes = whole; bytes != end; ++bytes)
          rest[n++] = *bytes;
      }

      /** Writes what is left. */
      void
      finish()
      {
        if (n == 0)
          return;
        // The missing bytes count as zeros; as many digits are replaced by '='.
        std::fill(rest.begin() + n, rest.end(), 0);
        encode(rest.data(), rest.data() + rest.size(), target);
        std::fill(target + n + 1, target + 4, '=');
      }

    private:
      /** Writes all bytes, whose number is one of threes; returns the end. */
      static char *
      encode(const unsigned char *bytes, const unsigned char *end, char *target)
      {
        static constexpr Pairs pairs = base64_pairs();
        for (; bytes != end; bytes += 3, target += 4)
          {
            // Base64 takes the first byte for the highest.
            const std::uint32_t bits =
              bytes[0] << 16 | bytes[1] << 8 | bytes[2];
            std::memcpy(target, pairs[bits >> 12].data(), 2);
            std::memcpy(target + 2, pairs[bits & 4095].data(), 2);
          }
        return target;
      }

      std::array<unsigned char, 3> rest;
      std::size_t                  n = 0; // bytes in it
      char                        *target;
    };

    /** Points whose values the cache holds while a group's arrays get them. */
    constexpr std::size_t n_at_once = 256;

    /** visit(first, end) for all points, some at a time. */
    template <typename Visit>
    void
    for_all(const std::size_t n_points, const Visit &visit)
    {
      for (std::size_t first = 0; first < n_points; first += n_at_once)
        visit(first, std::min(first + n_at_once, n_points));
    }

    /** Adds value(i, c) of some points i, component by component c. */
    template <typename T, typename Value>
    void
    add_values(const std::size_t  first,
               const std::size_t  end,
               const unsigned int n_components,
               const Value       &value,
               Base64            &array)
    {
      // Values are converted to the file's type some at a time, component by
      // component.
      std::vector<T> values((end - first) * n_components);
      T             *next = values.data();
      for (std::size_t i = first; i < end; ++i)
        for (unsigned int c = 0; c < n_components; ++c)
          *next++ = value(i, c);
      array.add(values.data(), values.size());
    }

    /** The arrays of a group as they stand in a file, between two other
     *  texts. */
    class GroupText
    {
    public:
      /** @param text becomes all of it; its memory is used again */
      GroupText(const Group       &group,
                const std::size_t  n_points,
                const std::string &before,
                const std::string &behind,
                std::string       &text)
      {
        // The length of all arrays is known before, so the text is made once,
        // with room for them. First the frame is written: tags, and the number
        // of bytes in front of each array. The values follow group by group.
        std::size_t size = before.size() + behind.size();
        for (const VtuArray &array : group)
          size += array.n_bytes_in_file(n_points);
        text.clear();
        text.resize(size);
        char      *place = text.data();
        const auto put   = [&place](const std::string &what) {
          place = std::copy(what.begin(), what.end(), place);
        };
        put(before);
        for (const VtuArray &array : group)
          {
            put(array.tag());
            arrays.emplace_back(place);
            // An array begins with the number of its bytes, as a number of 64
            // bits.
            const std::uint64_t n_bytes =
              array.n_bytes(n_points) - sizeof(std::uint64_t);
            arrays.back().add(&n_bytes, 1);
            place += (array.n_bytes(n_points) + 2) / 3 * 4;
            put(end_of_array);
          }
        put(behind);
      }

      /** Where the values of array number @p k go. */
      Base64 &
      array(const std::size_t k)
      {
        return arrays[k];
      }

      void
      finish()
      {
        for (Base64 &array : arrays)
          array.finish();
      }

    private:
      std::vector<Base64> arrays;
    };

    /** The first group. */
    template <int dim>
    void
    add_points(const PointFields<dim> &fields, GroupText &text)
    {
      const auto coordinate = [&](const std::size_t i, const unsigned int d) {
        return d < dim ? fields.positions[i][d] : 0.;
      };
      for_all(fields.size(), [&](const auto first, const auto end) {
        add_values<float>(first, end, 3, coordinate, text.array(0));
      });
    }

    /** The second one. */
    void
    add_cells(const std::size_t n_points, GroupText &text)
    {
      constexpr std::uint8_t vertex = 1; // of VTK
      const auto point  = [](const std::size_t i, unsigned int) { return i; };
      const auto behind = [](const std::size_t i, unsigned int) {
        return i + 1;
      };
      const auto type = [](std::size_t, unsigned int) { return vertex; };
      for_all(n_points, [&](const auto first, const auto end) {
        add_values<std::int32_t>(first, end, 1, point, text.array(0));
        add_values<std::int32_t>(first, end, 1, behind, text.array(1));
        add_values<std::uint8_t>(first, end, 1, type, text.array(2));
      });
    }

    /** Another one. */
    template <int dim>
    void
    add_fields(const PointFields<dim> &fields,
               const Group            &group,
               GroupText              &text)
    {
      // All arrays of a group take their values of some points before the next
      // points are read.
      for_all(fields.size(), [&](const auto first, const auto end) {
        for (std::size_t k = 0; k < group.size(); ++k)
          {
            const VtuArray &array = group[k];
            const auto value = [&](const std::size_t i, const unsigned int c) {
              return fields.row(i)[array.first_column + c];
            };
            const auto whole = [&](const std::size_t i, const unsigned int c) {
              return std::lround(value(i, c));
            };
            const unsigned int n = array.n_components;
            if (array.type == VtuArray::Int32)
              add_values<std::int32_t>(first, end, n, whole, text.array(k));
            else
              add_values<float>(first, end, n, value, text.array(k));
          }
      });
    }

    /** What stands before a group of a piece. */
    std::string
    before(const std::size_t g, const std::size_t n_points)
    {
      // Only the first three groups begin a section of the piece.
      if (g > 2)
        return "";
      if (g > 0)
        return g == 1 ? "</Points>\n<Cells>\n" : "</Cells>\n<PointData>\n";
      const std::string n = std::to_string(n_points);
      return "<Piece NumberOfPoints=\"" + n + "\" NumberOfCells=\"" + n +
             "\">\n<Points>\n";
    }

    /** Writes the points of @p fields as a piece of the file: the points, each
     *  as a cell of the file, then their fields. */
    template <int dim>
    void
    write_piece(OutputFile &file, const PointFields<dim> &fields)
    {
      // The text is made and written group by group, as all at once would take
      // as much memory again. Its memory is used again: in new memory, pages
      // would take as long as the text.
      const std::vector<Group> groups = groups_of(fields);
      std::string              text;
      for (std::size_t k = 0; k < groups.size(); ++k)
        {
          GroupText group(groups[k],
                          fields.size(),
                          before(k, fields.size()),
                          k + 1 == groups.size() ? end_of_piece : "",
                          text);
          if (k == 0)
            add_points(fields, group);
          else if (k == 1)
            add_cells(fields.size(), group);
          else
            add_fields(fields, groups[k], group);
          group.finish();
          file.write(text);
        }
    }

    /** What stands before the first piece: the time (day), and the file's
     *  number in its series. */
    std::string
    vtu_head(const double time, const unsigned int number)
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
  } // namespace

  // deal.II writes such files as well, but compressed: output then takes five
  // times as long, a third of a whole run of Fig. 4b (doc/performance.md, Five
  // days of Fig. 4b). VTK can append raw data, which are a quarter smaller, but
  // such a file is not XML: the ParaView of Debian 12 fails on them, and on
  // appended base64 as well.
  template <int dim>
  void
  write_vtu(const std::string                   &path,
            const std::vector<PointFields<dim>> &parts,
            const double                         time,
            const unsigned int                   number)
  {
    OutputFile file(path, OutputFile::Mode::replace);
    file.write(vtu_head(time, number));
    for (const PointFields<dim> &part : parts)
      write_piece(file, part);
    file.write("</UnstructuredGrid>\n</VTKFile>\n");
    file.commit();
  }

  void
  write_pvd(const std::string                                 &path,
            const std::vector<std::pair<double, std::string>> &times_and_names,
            const MPI_Comm                                     comm)
  {
    on_root(comm, [&]() {
      const auto directory = std::filesystem::path(path).parent_path();
      // A file that the user has deleted is no reason for a record that cannot
      // be opened.
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

  MORULA_INSTANTIATE(write_vtu);
} // namespace Morula
