// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/field_unknowns.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** The degrees of freedom of unknown splines. */
    IndexSet
    dofs_of(const IndexSet &splines, const unsigned int n_components)
    {
      IndexSet dofs(splines.size() * n_components);
      for (auto range = splines.begin_intervals();
           range != splines.end_intervals();
           ++range)
        dofs.add_range(*range->begin() * n_components,
                       (range->last() + 1) * n_components);
      dofs.compress();
      return dofs;
    }

    /** Marks the unknowns (positions in relevant()) that the extended splines
     *  of a grid cell depend on. */
    template <int dim>
    void
    mark_extensions(const typename SplineSpace<dim>::GridCell &grid_cell,
                    std::vector<bool>                         &marked)
    {
      const std::size_t n = grid_cell.unknowns.size();
      for (auto row = grid_cell.weights.begin(); row != grid_cell.weights.end();
           row += n)
        if (std::count(row, row + n, 0.) + 1 < static_cast<long>(n))
          for (std::size_t k = 0; k < n; ++k)
            if (row[k] != 0.)
              marked[grid_cell.unknowns[k]] = true;
    }
  } // namespace

  template <int dim, int n_components>
  FieldUnknowns<dim, n_components>::FieldUnknowns(const SplineSpace<dim> &space,
                                                  const MPI_Comm          comm)
    : space(space)
    , comm(comm)
    , owned_(dofs_of(space.owned(), n_components))
    , relevant_(dofs_of(space.relevant(), n_components))
  {}

  template <int dim, int n_components>
  const IndexSet &
  FieldUnknowns<dim, n_components>::owned() const
  {
    return owned_;
  }

  template <int dim, int n_components>
  const IndexSet &
  FieldUnknowns<dim, n_components>::relevant() const
  {
    return relevant_;
  }

  template <int dim, int n_components>
  IndexSet
  FieldUnknowns<dim, n_components>::of_extended_splines() const
  {
    std::vector<bool> marked(space.relevant().n_elements(), false);
    for (const auto &grid_cell : space.grid_cells())
      mark_extensions<dim>(grid_cell, marked);
    std::vector<types::global_dof_index> dofs;
    for (unsigned int s = 0; s < marked.size(); ++s)
      for (unsigned int i = 0; marked[s] && i < n_components; ++i)
        dofs.push_back(space.relevant().nth_index_in_set(s) * n_components + i);
    IndexSet result(relevant_.size());
    result.add_indices(dofs.begin(), dofs.end());
    result.compress();
    return result;
  }

  template <int dim, int n_components>
  TrilinosWrappers::MPI::Vector
  FieldUnknowns<dim, n_components>::vector(
    const std::vector<double> &values) const
  {
    Vector result = zero();
    std::copy(values.begin(), values.end(), result.begin());
    result.compress(VectorOperation::insert);
    return result;
  }

  template <int dim, int n_components>
  TrilinosWrappers::MPI::Vector
  FieldUnknowns<dim, n_components>::zero() const
  {
    return Vector(owned_, comm);
  }

  template <int dim, int n_components>
  TrilinosWrappers::MPI::Vector
  FieldUnknowns<dim, n_components>::sum(const std::vector<double> &values) const
  {
    Vector sum;
    sum.reinit(owned_, relevant_, comm, true);
    const std::vector<types::global_dof_index> dofs(relevant_.begin(),
                                                    relevant_.end());
    sum.add(dofs, values);
    sum.compress(VectorOperation::add);
    return sum;
  }

  template <int dim>
  std::vector<double>
  affine_displacement(const SplineSpace<dim> &space,
                      const unsigned int      piece,
                      const Tensor<1, dim>   &a,
                      const Tensor<2, dim>   &A)
  {
    std::vector<double> result(dim * space.owned().n_elements());
    for (unsigned int i = 0; i < dim; ++i)
      {
        const std::vector<double> component =
          space.affine_coefficients(piece, a[i], A[i]);
        for (std::size_t s = 0; s < component.size(); ++s)
          result[s * dim + i] = component[s];
      }
    return result;
  }

  template class FieldUnknowns<2, 1>;
  template class FieldUnknowns<2, 2>;
  template class FieldUnknowns<2, 3>;
  template class FieldUnknowns<3, 1>;
  template class FieldUnknowns<3, 2>;
  template class FieldUnknowns<3, 3>;
  template std::vector<double>
  affine_displacement(const SplineSpace<2> &,
                      const unsigned int,
                      const Tensor<1, 2> &,
                      const Tensor<2, 2> &);
  template std::vector<double>
  affine_displacement(const SplineSpace<3> &,
                      const unsigned int,
                      const Tensor<1, 3> &,
                      const Tensor<2, 3> &);
} // namespace Morula
