// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/output/table.h>

#include <boost/algorithm/string/replace.hpp>

#include <charconv>
#include <cmath>
#include <fstream>

namespace Morula
{
  using namespace dealii;

  void
  append_number(std::string &text, const double value)
  {
    // %.10g needs at most sign, 10 digits, point and exponent. to_chars() gives
    // the same several times faster, in every locale. Whole numbers of up to 10
    // digits are printed as such, which is faster again; -0 becomes 0.
    char       digits[32];
    const auto whole =
      std::abs(value) < 1e10 ? static_cast<std::int64_t>(value) : 0;
    const auto end =
      static_cast<double>(whole) == value ?
        std::to_chars(digits, digits + sizeof(digits), whole).ptr :
        std::to_chars(digits,
                      digits + sizeof(digits),
                      value,
                      std::chars_format::general,
                      10)
          .ptr;
    text.append(digits, end);
  }


  namespace
  {
    struct Beginning
    {
      std::size_t size = 0; // bytes
      Digest      digest;
    };

    /**
     * The header and the first complete rows of a file, as many rows as in
     * @p kept.
     * @throws InputError
     */
    Beginning
    beginning_of(const std::string &path,
                 const std::string &header,
                 const TableExtent &kept)
    {
      // A resumed run appends to this file, so what it has must be what the run
      // has written up to the snapshot. Header, number of rows and digest are
      // compared, and the reason is said. What stands behind, rows of steps
      // after the snapshot, is cut off by the caller.
      const auto refuse = [&path](const std::string &allowed) {
        throw InputError("--resume",
                         path,
                         allowed,
                         "Restore the file, or start the run anew.");
      };
      std::ifstream in(path, std::ios::binary);
      if (!in)
        refuse("a readable file next to the snapshot");

      std::string line;
      std::getline(in, line);
      // A column of runs before 0.3.0 is called otherwise today.
      if (in.eof() ||
          boost::replace_all_copy(line, ",pieces,", ",connected_tissues,") +
              '\n' !=
            header)
        refuse("a file with the header '" +
               header.substr(0, header.size() - 1) + "'");

      Beginning beginning;
      line += '\n';
      beginning.size = line.size();
      beginning.digest.process_bytes(line.data(), line.size());
      for (std::uint64_t row = 0; row < kept.n_rows; ++row)
        {
          std::getline(in, line);
          // A last line without its newline is incomplete.
          if (in.eof() || !in)
            refuse("a file with at least the " + std::to_string(kept.n_rows) +
                   " rows that the snapshot counts (there are " +
                   std::to_string(row) + ")");
          line += '\n';
          beginning.size += line.size();
          beginning.digest.process_bytes(line.data(), line.size());
        }
      if (beginning.digest.checksum() != kept.digest)
        refuse("a file whose first " + std::to_string(kept.n_rows) +
               " rows are those of the run (their digest is not "
               "the snapshot's)");
      return beginning;
    }
  } // namespace

  AppendedCsv::AppendedCsv(const std::string &path,
                           const std::string &header,
                           const MPI_Comm     comm)
    : comm(comm)
  {
    on_root(comm, [&]() {
      file = std::make_unique<OutputFile>(path, OutputFile::Mode::create);
      file->write(header);
      digest.process_bytes(header.data(), header.size());
    });
  }

  AppendedCsv::AppendedCsv(const std::string &path,
                           const std::string &header,
                           const TableExtent &kept,
                           const MPI_Comm     comm)
    : comm(comm)
    , n_rows(kept.n_rows)
  {
    on_root(comm, [&]() {
      const Beginning beginning = beginning_of(path, header, kept);
      // Rows that were written after the snapshot are computed again.
      file   = std::make_unique<OutputFile>(path, OutputFile::Mode::change);
      digest = beginning.digest;
      file->truncate(beginning.size);
    });
  }

  void
  AppendedCsv::check(const std::string &path,
                     const std::string &header,
                     const TableExtent &kept,
                     const MPI_Comm     comm)
  {
    on_root(comm, [&]() { beginning_of(path, header, kept); });
  }

  void
  AppendedCsv::append(const std::string &rows)
  {
    on_root(comm, [&]() {
      // Somebody may have moved the file while the run went on.
      file->check_in_place();
      file->write(rows);
      digest.process_bytes(rows.data(), rows.size());
    });
    n_rows += Utilities::MPI::broadcast(
      comm, std::uint64_t(std::count(rows.begin(), rows.end(), '\n')));
  }
} // namespace Morula
