// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/background_grid.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_generator.h>

namespace Morula
{
  namespace
  {
    /** Grid cells of a coarse cell per direction. A triangulation of coarse
     *  cells alone is several times dearer to make. */
    constexpr unsigned int n_refinements = 2;
    constexpr int          coarse_size   = 1 << n_refinements;

    int
    floor_to_coarse(const int i)
    {
      return coarse_size *
             static_cast<int>(std::floor(static_cast<double>(i) / coarse_size));
    }
  } // namespace

  template <int dim>
  BackgroundGrid<dim>::BackgroundGrid(const GridParameters &parameters,
                                      const MPI_Comm        comm)
    : comm(comm)
    , h(parameters.spacing)
    , tria(comm)
  {
    for (unsigned int d = 0; d < dim; ++d)
      offset[d] = parameters.offset[d];
    box_ = GridBox<dim>({}, {}, h, offset);
  }

  template <int dim>
  bool
  BackgroundGrid<dim>::covers(const GridIndex<dim> &first,
                              const GridIndex<dim> &last) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (first[d] - 1 < box_.first()[d] ||
          last[d] + 1 >= box_.first()[d] + box_.n()[d])
        return false;
    return true;
  }

  template <int dim>
  void
  BackgroundGrid<dim>::enclose(const GridIndex<dim> &first,
                               const GridIndex<dim> &last)
  {
    GridIndex<dim> lower, n;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int padding = 2 + (last[d] - first[d] + 1) / 8;
        lower[d]          = floor_to_coarse(first[d] - padding);
        n[d] = floor_to_coarse(last[d] + padding) + coarse_size - lower[d];
      }
    make(lower, n);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::make(const GridIndex<dim> &first,
                            const GridIndex<dim> &n)
  {
    box_ = GridBox<dim>(first, n, h, offset);
    std::vector<unsigned int> repetitions(dim);
    GridIndex<dim>            end;
    for (unsigned int d = 0; d < dim; ++d)
      {
        repetitions[d] = n[d] / coarse_size;
        end[d]         = first[d] + n[d];
      }
    cells.clear();
    tria.clear();
    GridGenerator::subdivided_hyper_rectangle(tria,
                                              repetitions,
                                              box_.corner(first),
                                              box_.corner(end));
    tria.refine_global(n_refinements);
    weights_.assign(box_.size(), 1);
    tabulate();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::partition(const std::vector<unsigned int> &weights)
  {
    AssertDimension(weights.size(), box_.size());
    weights_ = weights;
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    const auto connection = tria.signals.weight.connect(
      [&](const typename Triangulation<dim>::cell_iterator &cell,
          const typename Triangulation<dim>::CellStatus) -> unsigned int {
        return 1 + weights_[box_.number(box_.locate(cell->center()))];
      });
    tria.repartition();
    connection.disconnect();
    tabulate();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::tabulate()
  {
    cells.assign(box_.size(), tria.end());
    owners.assign(box_.size(), 0);
    const unsigned int rank = Utilities::MPI::this_mpi_process(comm);
    for (const auto &cell : tria.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int number = box_.number(box_.locate(cell->center()));
          cells[number]             = cell;
          owners[number]            = rank;
        }
    Utilities::MPI::sum(owners, comm, owners);
  }

  template <int dim>
  const std::vector<unsigned int> &
  BackgroundGrid<dim>::weights() const
  {
    return weights_;
  }

  template <int dim>
  const GridBox<dim> &
  BackgroundGrid<dim>::box() const
  {
    return box_;
  }

  template <int dim>
  unsigned int
  BackgroundGrid<dim>::owner(const unsigned int number) const
  {
    return owners[number];
  }

  template <int dim>
  typename BackgroundGrid<dim>::CellIterator
  BackgroundGrid<dim>::cell(const unsigned int number) const
  {
    return cells[number];
  }

  template <int dim>
  const Triangulation<dim> &
  BackgroundGrid<dim>::triangulation() const
  {
    return tria;
  }

  template <int dim>
  MPI_Comm
  BackgroundGrid<dim>::communicator() const
  {
    return comm;
  }

  template <int dim>
  GridIndex<dim>
  BackgroundGrid<dim>::locate(const Point<dim> &x) const
  {
    return box_.locate(x);
  }

  template class BackgroundGrid<2>;
  template class BackgroundGrid<3>;
} // namespace Morula
