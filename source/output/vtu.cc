// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/output/atomic_file.h>
#include <morula/output/gather.h>
#include <morula/output/vtu.h>
#include <morula/output/vtu_piece.h>

#include <deal.II/base/data_out_base.h>

#include <filesystem>
#include <optional>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Writes this rank's piece, from byte @p offset on. */
    template <int dim>
    void
    write_piece(SharedFile             &file,
                const VtuPiece<dim>    &piece,
                const PointFields<dim> &fields,
                std::uint64_t           offset)
    {
      // One part after the other is made and written, in the same memory.
      std::string text;
      for (std::size_t k = 0; k < piece.n_parts(); ++k)
        {
          piece.make_part(fields, k, text);
          file.write(text, offset);
          offset += text.size();
        }
    }

    /** Rank 0 writes what it gets from the others, one part of one rank after
     *  the other: as little as possible is in memory. */
    template <int dim>
    void
    write_gathered(const std::string      &path,
                   const std::string      &head,
                   const VtuPiece<dim>    &piece,
                   const PointFields<dim> &fields,
                   const MPI_Comm          comm)
    {
      const unsigned int        rank = Utilities::MPI::this_mpi_process(comm);
      std::optional<AtomicFile> file; // on rank 0
      on_root(comm, [&]() {
        file.emplace(path);
        file->write(head);
      });
      // All ranks take part in each round, though only one of them has
      // something to send: so rank 0 holds one part of one rank at a time.
      for (unsigned int r = 0; r < Utilities::MPI::n_mpi_processes(comm); ++r)
        for (std::size_t k = 0; k < piece.n_parts(); ++k)
          {
            std::string own;
            if (r == rank)
              piece.make_part(fields, k, own);
            const std::vector<std::string> texts = gather_to_root(own, comm);
            on_root(comm, [&]() { file->write(texts[r]); });
          }
      on_root(comm, [&]() {
        file->write(vtu_end);
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
  std::unique_ptr<PendingFile>
  begin_vtu(const std::string  &path,
            PointFields<dim>    fields,
            const double        time,
            const unsigned int  number,
            const MPI_Comm      comm,
            const std::uint64_t shared_from)
  {
    // The size of each rank's piece follows from its number of points alone. So
    // every rank knows where all pieces stand, and the file's length, without
    // making any. If all ranks can write the file, each writes its own piece in
    // the background. Else rank 0 writes them at once, as they come.
    const unsigned int  rank = Utilities::MPI::this_mpi_process(comm);
    const VtuPiece<dim> piece(fields);
    const std::string   head  = vtu_head(time, number);
    std::uint64_t       end   = head.size(); // of the pieces so far
    std::uint64_t       begin = 0;           // of this rank's
    const auto          n_points =
      Utilities::MPI::all_gather(comm, std::uint64_t(fields.size()));
    for (unsigned int r = 0; r < n_points.size(); ++r)
      {
        if (r == rank)
          begin = end;
        end += piece.n_bytes(n_points[r]);
      }

    auto file = SharedFile::make(path, end + vtu_end.size(), comm, shared_from);
    if (file == nullptr)
      {
        write_gathered(path, head, piece, fields, comm);
        return nullptr;
      }
    return pending(std::move(file),
                   [=, fields = std::move(fields)](SharedFile &file) {
                     // Rank 0 also writes the head, the last one the end.
                     if (rank == 0)
                       file.write(head, 0);
                     write_piece(file, piece, fields, begin);
                     if (rank + 1 == n_points.size())
                       file.write(vtu_end, end);
                   });
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

  MORULA_INSTANTIATE(begin_vtu);
} // namespace Morula
