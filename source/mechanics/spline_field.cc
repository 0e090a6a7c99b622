// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/mechanics/spline_field.h>

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
      // Ranges of splines become ranges of degrees of freedom: component i of
      // spline s is s n_components + i.
      for (auto range = splines.begin_intervals();
           range != splines.end_intervals();
           ++range)
        dofs.add_range(*range->begin() * n_components,
                       (range->last() + 1) * n_components);
      dofs.compress();
      return dofs;
    }

    IndexSet
    without(IndexSet all, const IndexSet &some)
    {
      all.subtract_set(some);
      return all;
    }

    /** How many of @p some come before the first of @p others. */
    unsigned int
    n_before(const IndexSet &some, const IndexSet &others)
    {
      // Owned unknowns are one range, as numbers run rank by rank. So those of
      // other ranks fall into a lower and an upper part.
      if (others.n_elements() == 0)
        return some.n_elements();
      const auto end = some.at(others.nth_index_in_set(0));
      return end == some.end() ? some.n_elements() :
                                 some.index_within_set(*end);
    }
  } // namespace

  template <int dim, int n_components>
  FieldUnknowns<dim, n_components>::FieldUnknowns(const SplineSpace<dim> &space,
                                                  const MPI_Comm          comm)
    : owned_(dofs_of(space.owned(), n_components))
    , relevant_(dofs_of(space.relevant(), n_components))
    , own(relevant_ & owned_)
    , others(without(relevant_, owned_))
    , n_below(n_before(others, owned_))
    , halo(owned_, others, comm)
    , zero_(owned_, comm)
  {}


  template <int dim, int n_components>
  template <typename Action>
  void
  FieldUnknowns<dim, n_components>::for_own(const Action &action) const
  {
    // k counts positions in relevant(): those of lower ranks come first, then
    // the own ones, interval by interval.
    unsigned int k = n_below;
    for (auto range = own.begin_intervals(); range != own.end_intervals();
         ++range)
      {
        const unsigned int n = range->n_elements();
        action(k, owned_.index_within_set(*range->begin()), n);
        k += n;
      }
  }

  template <int dim, int n_components>
  std::vector<double>
  FieldUnknowns<dim, n_components>::fetch(const Vector &u) const
  {
    // Values of other ranks come through the halo, in the order of `others`.
    // The lower ones go to the front, the upper ones to the end; the own ones,
    // which are copied, fill the middle.
    std::vector<double> fetched(others.n_elements());
    halo.fetch(u.begin(), fetched.data());
    std::vector<double> values(relevant_.n_elements());
    const auto          above = fetched.begin() + n_below;
    std::copy(fetched.begin(), above, values.begin());
    std::copy(above, fetched.end(), values.end() - (fetched.end() - above));
    for_own(
      [&](const unsigned int k, const unsigned int l, const unsigned int n) {
        std::copy(u.begin() + l, u.begin() + l + n, values.begin() + k);
      });
    return values;
  }

  template <int dim, int n_components>
  TrilinosWrappers::MPI::Vector
  FieldUnknowns<dim, n_components>::sum(const std::vector<double> &values) const
  {
    // The reverse of fetch(): what this rank has for others is sent to them and
    // added there, its own part is copied.
    const unsigned int  n_above = others.n_elements() - n_below;
    std::vector<double> of_others(values.begin(), values.begin() + n_below);
    of_others.insert(of_others.end(), values.end() - n_above, values.end());
    Vector sum = zero();
    for_own(
      [&](const unsigned int k, const unsigned int l, const unsigned int n) {
        std::copy(values.begin() + k, values.begin() + k + n, sum.begin() + l);
      });
    halo.add_back(of_others.data(), sum.begin());
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
    // A scalar affine field for each component; splines reproduce it exactly.
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
  MORULA_INSTANTIATE(affine_displacement);
} // namespace Morula
