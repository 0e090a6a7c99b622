// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/output/appended_csv.h>
#include <morula/output/csv_rows.h>
#include <morula/output/gather.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <stdexcept>

namespace Morula
{
  using namespace dealii;

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

      Beginning beginning;
      beginning.size = header.size();
      beginning.digest.add(header);
      for (std::uint64_t row = 0; row < kept.n_rows; ++row)
        {
          std::getline(in, line);
          // A last line without its newline is incomplete.
          if (in.eof() || !in)
            throw InputError("--resume",
                             path,
                             "a file with at least the " +
                               std::to_string(kept.n_rows) +
                               " rows that the snapshot counts (there are " +
                               std::to_string(row) + ")",
                             "Restore the file, or start the run anew.");
          line += '\n';
          beginning.size += line.size();
          beginning.digest.add(line);
        }
      if (beginning.digest.value() != kept.digest)
        throw InputError("--resume",
                         path,
                         "a file whose first " + std::to_string(kept.n_rows) +
                           " rows are those of the run (their digest is not "
                           "the snapshot's)",
                         "Restore the file, or start the run anew.");
      return beginning;
    }

    std::uint64_t
    lines(const std::string &rows)
    {
      return std::count(rows.begin(), rows.end(), '\n');
    }
  } // namespace

  AppendedCsv::AppendedCsv(const std::string              &path,
                           const std::vector<std::string> &names,
                           const MPI_Comm                  comm)
    : comm(comm)
    , path(path)
  {
    on_root(comm, [&]() {
      const std::string header = csv_header(names);
      file = std::make_unique<PosixFile>(path, PosixFile::Mode::create);
      file->write(header);
      digest.add(header);
      size = header.size();
    });
  }

  AppendedCsv::AppendedCsv(const std::string              &path,
                           const std::vector<std::string> &names,
                           const TableExtent              &kept,
                           const MPI_Comm                  comm)
    : comm(comm)
    , path(path)
    , n_rows(kept.n_rows)
  {
    on_root(comm, [&]() {
      const Beginning beginning = beginning_of(path, csv_header(names), kept);
      // Rows that were written after the snapshot are computed again.
      file   = std::make_unique<PosixFile>(path, PosixFile::Mode::overwrite);
      digest = beginning.digest;
      size   = beginning.size;
      file->truncate(size);
    });
  }

  void
  AppendedCsv::check(const std::string              &path,
                     const std::vector<std::string> &names,
                     const TableExtent              &kept,
                     const MPI_Comm                  comm)
  {
    on_root(comm, [&]() { beginning_of(path, csv_header(names), kept); });
  }

  void
  AppendedCsv::append(const std::string &rows)
  {
    on_root(comm, [&]() {
      // Somebody may have moved the file while the run went on.
      file->check_in_place();
      file->write_at(rows, size);
      digest.add(rows);
      size += rows.size();
    });
    n_rows += Utilities::MPI::broadcast(comm, lines(rows));
  }

  void
  AppendedCsv::append_parts(const std::string  &rows,
                            const std::uint64_t shared_from)
  {
    const auto sizes =
      Utilities::MPI::all_gather(comm, std::uint64_t(rows.size()));
    // Long lists are written by all ranks, each its part behind those of lower
    // ranks. Short ones, and all on file systems where that is not safe, are
    // gathered.
    const auto own = sizes.begin() + Utilities::MPI::this_mpi_process(comm);
    const std::uint64_t n_all =
      std::accumulate(sizes.begin(), sizes.end(), std::uint64_t(0));
    if (sizes.size() > 1 && n_all >= shared_from &&
        write_parts(rows,
                    std::accumulate(sizes.begin(), own, std::uint64_t(0)),
                    n_all))
      return;
    std::string all;
    for (const std::string &part : gather_to_root(rows, comm))
      all += part;
    append(all);
  }

  bool
  AppendedCsv::write_parts(const std::string  &rows,
                           const std::uint64_t n_before,
                           const std::uint64_t n_all)
  {
    // Each rank writes its part at its place. Rank 0 makes the file long enough
    // before, so that a full disk shows before anything is written. If any rank
    // fails, the file is cut to what it was, and all of them throw. The digest
    // of the rows follows from those of the parts, so that no rank reads the
    // others'.
    const std::uint64_t begin = Utilities::MPI::broadcast(comm, size);
    const auto cut = [&]() { on_root(comm, [&]() { file->truncate(begin); }); };
    try
      {
        on_root(comm, [&]() {
          file->check_in_place();
          file->reserve(begin + n_all);
        });
        PartOfFile part(path, begin + n_all, comm);
        if (!part.is_shared())
          {
            cut();
            return false;
          }
        everywhere(comm, [&]() {
          part.write(rows, begin + n_before);
          part.close();
        });
      }
    catch (const std::runtime_error &) // on all ranks
      {
        cut();
        throw;
      }
    Digest of_part;
    of_part.add(rows);
    const auto parts = Utilities::MPI::gather(
      comm, std::vector<std::uint64_t>{of_part.value(), rows.size()});
    for (const auto &one : parts) // on rank 0
      digest.add(one[0], one[1]);
    size = begin + n_all;
    n_rows += Utilities::MPI::sum(lines(rows), comm);
    return true;
  }

  void
  AppendedCsv::sync()
  {
    on_root(comm, [&]() {
      file->check_in_place();
      file->sync();
    });
  }
} // namespace Morula
