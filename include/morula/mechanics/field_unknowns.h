// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_field_unknowns_h
#define morula_mechanics_field_unknowns_h

#include <morula/base/halo.h>
#include <morula/grid/spline_space.h>

#include <deal.II/base/index_set.h>
#include <deal.II/lac/trilinos_vector.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  /**
   * The degrees of freedom of a field of n components on a spline space:
   * component i of unknown spline s is number s n + i, over all ranks. Without
   * a number of components the field is the displacement. It knows once and for
   * all which values ranks exchange.
   */
  template <int dim, int n_components = dim>
  class FieldUnknowns
  {
  public:
    using Vector = TrilinosWrappers::MPI::Vector;

    /** Collective. */
    FieldUnknowns(const SplineSpace<dim> &space, const MPI_Comm comm);

    /** The degrees of freedom of the splines that this rank owns. */
    const IndexSet &
    owned() const;

    /** The degrees of freedom of the splines that this rank's active grid cells
     *  use. */
    const IndexSet &
    relevant() const;

    /** The vector with these values at owned(), in order. */
    Vector
    vector(const std::vector<double> &values) const;

    /** Zero everywhere. */
    Vector
    zero() const;

    /** The values of @p u at relevant(), in order. Neighbours exchange them. */
    std::vector<double>
    fetch(const Vector &u) const;

    /** Adds up what all ranks have at relevant(), in order. Neighbours exchange
     *  it. */
    Vector
    sum(const std::vector<double> &values) const;

  private:
    /** Calls action(k, l, n) for intervals of relevant() that are owned, too:
     *  from k on they are number l ... l + n - 1 of owned(). */
    template <typename Action>
    void
    for_own(const Action &action) const;

    const IndexSet     owned_, relevant_;
    const IndexSet     own, others; // of the relevant ones
    const unsigned int n_below;     // others that come before the own ones
    const Halo         halo;        // of the others
    const Vector       zero_;       // copies share its map
  };

  /**
   * Coefficients of the displacement a + A x (µm) in one piece, zero in the
   * others: of this rank's unknowns, in the order of FieldUnknowns::owned().
   */
  template <int dim>
  std::vector<double>
  affine_displacement(const SplineSpace<dim> &space,
                      const unsigned int      piece,
                      const Tensor<1, dim>   &a,
                      const Tensor<2, dim>   &A);
} // namespace Morula

#endif
