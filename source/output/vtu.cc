// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/agreement.h>
#include <morula/output/atomic_file.h>
#include <morula/output/gather.h>
#include <morula/output/vtu.h>

#include <deal.II/base/data_out_base.h>

#include <filesystem>
#include <sstream>
#include <tuple>

namespace Morula
{
  namespace
  {
    using DataComponentInterpretation::component_is_part_of_tensor;
    using DataComponentInterpretation::component_is_part_of_vector;
    using Range =
      std::tuple<unsigned int,
                 unsigned int,
                 std::string,
                 DataComponentInterpretation::DataComponentInterpretation>;

    template <int dim>
    std::vector<DataOutBase::Patch<0, dim>>
    patches_of(const PointFields<dim> &fields)
    {
      std::vector<DataOutBase::Patch<0, dim>> patches(fields.size());
      for (std::size_t i = 0; i < patches.size(); ++i)
        {
          patches[i].vertices[0] = fields.positions[i];
          patches[i].patch_index = i;
          patches[i].data.reinit(fields.names.size(), 1);
          for (unsigned int c = 0; c < fields.names.size(); ++c)
            patches[i].data(c, 0) = fields.row(i)[c];
        }
      return patches;
    }

    template <int dim>
    std::vector<Range>
    nonscalar_ranges(const PointFields<dim> &fields)
    {
      std::vector<Range> ranges;
      for (const auto &nonscalar : fields.nonscalars)
        ranges.emplace_back(nonscalar.first_column,
                            nonscalar.first_column + nonscalar.n_columns - 1,
                            nonscalar.name,
                            nonscalar.n_columns == 9 ?
                              component_is_part_of_tensor :
                              component_is_part_of_vector);
      return ranges;
    }
  } // namespace

  // The pieces of DataOutInterface::write_vtu_in_parallel(), but written by
  // rank 0: when the disk is full, MPI I/O fails on some ranks only, and the
  // others wait for them for ever.
  template <int dim>
  void
  write_vtu(const std::string      &path,
            const PointFields<dim> &fields,
            const double            time,
            const unsigned int      number,
            const MPI_Comm          comm)
  {
    const DataOutBase::VtkFlags flags(time,
                                      number,
                                      /*print_date_and_time=*/false,
                                      DataOutBase::VtkFlags::best_speed);

    const auto n_points    = Utilities::MPI::sum(fields.size(), comm);
    const bool first_piece = Utilities::MPI::this_mpi_process(comm) == 0;
    std::ostringstream piece;
    if (fields.size() > 0 || (n_points == 0 && first_piece))
      DataOutBase::write_vtu_main(patches_of(fields),
                                  fields.names,
                                  nonscalar_ranges(fields),
                                  flags,
                                  piece);
    const std::vector<std::string> pieces = gather_to_root(piece.str(), comm);

    on_root(comm, [&]() {
      std::ostringstream header, footer;
      DataOutBase::write_vtu_header(header, flags);
      DataOutBase::write_vtu_footer(footer);

      AtomicFile file(path);
      file.write(header.str());
      for (const std::string &text : pieces)
        file.write(text);
      file.write(footer.str());
      file.commit();
    });
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
               const MPI_Comm);
  template void
  write_vtu<3>(const std::string &,
               const PointFields<3> &,
               const double,
               const unsigned int,
               const MPI_Comm);
} // namespace Morula
