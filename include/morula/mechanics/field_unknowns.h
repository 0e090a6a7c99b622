// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_field_unknowns_h
#define morula_mechanics_field_unknowns_h

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
   * a number of components the field is the displacement. Keeps a reference to
   * the space.
   */
  template <int dim, int n_components = dim>
  class FieldUnknowns
  {
  public:
    using Vector = TrilinosWrappers::MPI::Vector;

    FieldUnknowns(const SplineSpace<dim> &space, const MPI_Comm comm);

    /** Those of the splines that this rank owns. */
    const IndexSet &
    owned() const;

    /** Those of the splines that this rank's active grid cells use. */
    const IndexSet &
    relevant() const;

    /** Those that extended splines in this rank's active grid cells depend on.
     *  A matrix couples these many times as much as others. */
    IndexSet
    of_extended_splines() const;

    /** The vector with these values at owned(), in order. Collective. */
    Vector
    vector(const std::vector<double> &values) const;

    /** Zero everywhere. Collective. */
    Vector
    zero() const;

    /** Adds up what all ranks have at relevant(), in order. Collective. */
    Vector
    sum(const std::vector<double> &values) const;

  private:
    const SplineSpace<dim> &space;
    const MPI_Comm          comm;
    const IndexSet          owned_, relevant_;
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
