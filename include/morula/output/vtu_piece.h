// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_vtu_piece_h
#define morula_output_vtu_piece_h

#include <morula/output/point_fields.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace Morula
{
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
    tag() const;

    /** The number of bytes of its values, with the size in front. */
    std::uint64_t
    n_bytes(const std::uint64_t n_points) const;

    /** The number of bytes of its element, in base64. */
    std::uint64_t
    n_bytes_in_file(const std::uint64_t n_points) const;
  };

  /**
   * The text of the pieces of a VTU file: the points, each as a cell of the
   * file, then their fields. It is made part by part, some arrays at a time, as
   * all at once would take as much memory again.
   */
  template <int dim>
  class VtuPiece
  {
  public:
    /** @param fields whose columns are written; their rows do not matter */
    explicit VtuPiece(const PointFields<dim> &fields);

    std::size_t
    n_parts() const
    {
      return parts.size();
    }

    /** Bytes of a piece with so many points. */
    std::uint64_t
    n_bytes(const std::uint64_t n_points) const;

    /** Makes @p text part number @p k of the piece that holds the @p fields.
     *  Its memory is used again: in new memory, pages would take as long as the
     *  text. */
    void
    make_part(const PointFields<dim> &fields,
              const std::size_t       k,
              std::string            &text) const;

  private:
    std::vector<std::vector<VtuArray>> parts;
  };

  /** What stands before the first piece: the time (day), and the file's number
   *  in its series. */
  std::string
  vtu_head(const double time, const unsigned int number);

  /** What stands behind the last piece. */
  inline constexpr std::string_view vtu_end =
    "</UnstructuredGrid>\n</VTKFile>\n";
} // namespace Morula

#endif
