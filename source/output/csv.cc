// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/global_order.h>
#include <morula/output/atomic_file.h>
#include <morula/output/csv.h>
#include <morula/output/csv_rows.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <map>
#include <utility>

namespace Morula
{
  namespace
  {
    /** Calls action(row's number, its text) for all rows. */
    template <typename Action>
    void
    each_row(const CsvRows &rows, const Action &action)
    {
      std::size_t begin = 0;
      for (std::size_t i = 0; i < rows.ids.size(); ++i)
        {
          action(i,
                 std::string_view(rows.text).substr(begin,
                                                    rows.ends[i] - begin));
          begin = rows.ends[i];
        }
    }

    /** Of all ranks' rows in the order of their ids those that this rank
     * writes: each rank about as many as the others. Collective. */
    std::string
    share_in_order(const CsvRows &local, const MPI_Comm comm)
    {
      const GlobalOrder   order   = global_order(local.ids, comm);
      const std::uint64_t n_ranks = Utilities::MPI::n_mpi_processes(comm);
      // place and length of each row; and the rows
      std::map<unsigned int, std::vector<std::uint64_t>> heads;
      std::map<unsigned int, std::vector<char>>          texts;
      each_row(local, [&](const std::size_t i, const std::string_view row) {
        const std::uint64_t place = order.places[i];
        const unsigned int  rank  = place * n_ranks / order.n_keys;
        heads[rank].push_back(place);
        heads[rank].push_back(row.size());
        texts[rank].insert(texts[rank].end(), row.begin(), row.end());
      });
      const auto all_heads = Utilities::MPI::some_to_some(comm, heads);
      const auto all_texts = Utilities::MPI::some_to_some(comm, texts);

      std::vector<std::pair<std::uint64_t, std::string_view>> rows;
      for (const auto &[rank, head] : all_heads)
        {
          const char *row = all_texts.at(rank).data();
          for (std::size_t k = 0; k < head.size(); row += head[k + 1], k += 2)
            rows.emplace_back(head[k], std::string_view(row, head[k + 1]));
        }
      std::sort(rows.begin(), rows.end());
      std::string text;
      for (const auto &row : rows)
        text += row.second;
      return text;
    }

    void
    write_together(SharedFile        &file,
                   const std::string &header,
                   const CsvRows     &local,
                   const MPI_Comm     comm)
    {
      const std::string   text   = share_in_order(local, comm);
      const std::uint64_t n_own  = text.size();
      std::uint64_t       before = 0; // stays on rank 0
      const int           error =
        MPI_Exscan(&n_own, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
      AssertThrowMPI(error);
      everywhere(comm, [&]() {
        if (Utilities::MPI::this_mpi_process(comm) == 0)
          file.write(header, 0);
        file.write(text, header.size() + before);
      });
      file.commit();
    }
  } // namespace

  template <int dim>
  void
  write_csv(const std::string      &path,
            const PointFields<dim> &fields,
            const MPI_Comm          comm,
            const std::uint64_t     shared_from)
  {
    CsvRows local;
    for (std::size_t i = 0; i < fields.size(); ++i)
      local.add(fields.ids[i], fields.row(i), fields.n_csv_columns);
    const std::string header = csv_header(
      {fields.names.begin(), fields.names.begin() + fields.n_csv_columns});

    const std::uint64_t size =
      header.size() +
      Utilities::MPI::sum(std::uint64_t(local.text.size()), comm);
    if (Utilities::MPI::n_mpi_processes(comm) > 1 && size >= shared_from)
      {
        SharedFile file(path, size, comm);
        if (file.is_shared())
          {
            write_together(file, header, local, comm);
            return;
          }
      }
    const GatheredRows rows(local, comm);
    on_root(comm, [&]() {
      AtomicFile file(path);
      file.write(header);
      for (const std::string_view row : rows.in_id_order())
        file.write(row);
      file.commit();
    });
  }

  template void
  write_csv<2>(const std::string &,
               const PointFields<2> &,
               const MPI_Comm,
               const std::uint64_t);
  template void
  write_csv<3>(const std::string &,
               const PointFields<3> &,
               const MPI_Comm,
               const std::uint64_t);
} // namespace Morula
