// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/input_error.h>
#include <morula/output/agreement.h>
#include <morula/output/appended_csv.h>
#include <morula/output/csv_rows.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <fstream>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    /**
     * Size in bytes of the header and the first @p n_rows complete rows.
     * @throws InputError
     */
    std::size_t
    size_of_rows(const std::string  &path,
                 const std::string  &header,
                 const std::uint64_t n_rows)
    {
      std::ifstream in(path, std::ios::binary);
      if (!in)
        throw InputError("--resume",
                         path,
                         "a readable file next to the snapshot",
                         "Restore the file, or start the run anew.");

      std::string line;
      std::getline(in, line);
      if (in.eof() || line + '\n' != header)
        throw InputError("--resume",
                         path,
                         "a file with the header '" +
                           header.substr(0, header.size() - 1) + "'",
                         "Restore the file, or start the run anew.");

      std::size_t size = header.size();
      for (std::uint64_t row = 0; row < n_rows; ++row)
        {
          std::getline(in, line);
          // a last line without its newline was torn
          if (in.eof() || !in)
            throw InputError("--resume",
                             path,
                             "a file with at least the " +
                               std::to_string(n_rows) +
                               " rows that the snapshot counts (there are " +
                               std::to_string(row) + ")",
                             "Restore the file, or start the run anew.");
          size += line.size() + 1;
        }
      return size;
    }
  } // namespace

  AppendedCsv::AppendedCsv(const std::string              &path,
                           const std::vector<std::string> &names,
                           const MPI_Comm                  comm)
    : comm(comm)
    , n_rows_(0)
  {
    on_root(comm, [&]() {
      file = std::make_unique<PosixFile>(path, PosixFile::Mode::create);
      file->write(csv_header(names));
    });
  }

  AppendedCsv::AppendedCsv(const std::string              &path,
                           const std::vector<std::string> &names,
                           const std::uint64_t             n_rows,
                           const MPI_Comm                  comm)
    : comm(comm)
    , n_rows_(n_rows)
  {
    on_root(comm, [&]() {
      const std::size_t size = size_of_rows(path, csv_header(names), n_rows);
      file = std::make_unique<PosixFile>(path, PosixFile::Mode::change);
      file->truncate(size);
    });
  }

  void
  AppendedCsv::check(const std::string              &path,
                     const std::vector<std::string> &names,
                     const std::uint64_t             n_rows,
                     const MPI_Comm                  comm)
  {
    on_root(comm, [&]() { size_of_rows(path, csv_header(names), n_rows); });
  }

  void
  AppendedCsv::append(const std::string &rows)
  {
    on_root(comm, [&]() { file->write(rows); });
    const std::uint64_t n_new = std::count(rows.begin(), rows.end(), '\n');
    n_rows_ += Utilities::MPI::broadcast(comm, n_new);
  }

  void
  AppendedCsv::sync()
  {
    on_root(comm, [&]() { file->sync(); });
  }
} // namespace Morula
