// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/global_order.h>
#include <morula/base/instantiate.h>
#include <morula/output/csv.h>
#include <morula/output/csv_rows.h>
#include <morula/output/gather.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The numbers of rows, each behind its id. */
    class Rows
    {
    public:
      /** The rows that this rank is to write: an equal part of all ranks' rows,
       *  rank 0 the first ones. Collective. */
      template <int dim>
      Rows(const PointFields<dim> &fields, const MPI_Comm comm)
        : n_columns(fields.n_csv_columns)
      {
        // A row's place among those of all ranks tells which rank writes it.
        // Rows travel as numbers, since the text of a number takes more time to
        // make, which the other thread has, and more room.
        const std::uint64_t n_ranks = Utilities::MPI::n_mpi_processes(comm);
        GlobalOrder         order;
        if (n_ranks > 1)
          order = global_order(fields.ids, comm);
        std::map<unsigned int, std::vector<double>> sent;
        for (std::size_t i = 0; i < fields.size(); ++i)
          {
            std::vector<double> &to =
              sent[n_ranks > 1 ? order.places[i] * n_ranks / order.n_keys : 0];
            if (to.empty())
              to.reserve((1 + n_columns) * fields.size() / n_ranks);
            to.push_back(fields.ids[i]);
            to.insert(to.end(), fields.row(i), fields.row(i) + n_columns);
          }
        received = n_ranks == 1 ? std::move(sent) :
                                  Utilities::MPI::some_to_some(comm, sent);
      }

      /** Appends all rows, in the order of their ids. */
      void
      append_to(std::string &text) const
      {
        std::vector<std::pair<double, const double *>> rows;
        for (const auto &[rank, numbers] : received)
          for (std::size_t i = 0; i < numbers.size(); i += 1 + n_columns)
            rows.emplace_back(numbers[i], &numbers[i + 1]);
        std::sort(rows.begin(), rows.end());
        // A number has about a dozen characters; moving a longer and longer
        // text would take as long as making it.
        text.reserve(text.size() + 12 * n_columns * rows.size());
        for (const auto &[id, row] : rows)
          append_row(text, row, n_columns);
      }

    private:
      unsigned int                                n_columns;
      std::map<unsigned int, std::vector<double>> received; // by rank
    };

    /** Begins the file of all ranks' texts, one behind the other. Collective.
     */
    std::unique_ptr<PendingFile>
    begin_text(const std::string  &path,
               std::string       &&text,
               const MPI_Comm      comm,
               const std::uint64_t shared_from)
    {
      // If all ranks can write the file each writes its part from where lower
      // ranks' end. Else the first one gets the text of all, and is the only
      // one with a file. The bytes are the same.
      const std::uint64_t n_own  = text.size();
      std::uint64_t       before = 0; // MPI_Exscan() leaves it alone on rank 0
      const int           error =
        MPI_Exscan(&n_own, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
      AssertThrowMPI(error);
      auto shared = SharedFile::make(path,
                                     Utilities::MPI::sum(n_own, comm),
                                     comm,
                                     shared_from);
      if (shared != nullptr)
        return pending(std::move(shared),
                       [before, text = std::move(text)](SharedFile &file) {
                         file.write(text, before);
                       });

      std::string all;
      for (const std::string &part : gather_to_root(std::move(text), comm))
        all += part;
      std::unique_ptr<PendingFile> own;
      on_root(comm, [&]() {
        own = pending(SharedFile::make(path, all.size(), MPI_COMM_SELF, 0),
                      [all = std::move(all)](SharedFile &file) {
                        file.write(all, 0);
                      });
      });
      if (own == nullptr)
        own = std::make_unique<PendingFile>(PendingFile{{}, []() {}, {}});
      own->commit = [comm, commit = own->commit]() { on_root(comm, commit); };
      return own;
    }
  } // namespace

  template <int dim>
  std::unique_ptr<PendingFile>
  begin_csv(const std::string      &path,
            const PointFields<dim> &fields,
            const MPI_Comm          comm,
            const std::uint64_t     shared_from)
  {
    // The other thread makes the text first. Only then it is known how long
    // the parts of all ranks are, so that the file itself is the second stage.
    auto rows = std::make_shared<Rows>(fields, comm);
    auto text = std::make_shared<std::string>();
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      *text = csv_header(
        {fields.names.begin(), fields.names.begin() + fields.n_csv_columns});
    return std::make_unique<PendingFile>(PendingFile{
      [rows = std::move(rows), text]() { rows->append_to(*text); },
      {},
      [=]() { return begin_text(path, std::move(*text), comm, shared_from); }});
  }

  MORULA_INSTANTIATE(begin_csv);
} // namespace Morula
