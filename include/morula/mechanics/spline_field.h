// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_spline_field_h
#define morula_mechanics_spline_field_h

#include <morula/base/block_matrix.h>
#include <morula/grid/spline_space.h>
#include <morula/mechanics/term.h>
#include <morula/particles/point_store.h>

#include <deal.II/base/index_set.h>

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
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
    using Vector = BlockMatrix::Vector;

    /** Collective. */
    FieldUnknowns(const SplineSpace<dim> &space, const MPI_Comm comm)
      : owned_(unknowns_of(space.owned(), n_components))
      , relevant_(unknowns_of(space.relevant(), n_components))
      , zero_(owned_, comm)
      , with_others(owned_, relevant_, comm)
    {
      for (const auto unknown : relevant_)
        places.push_back(
          with_others.get_partitioner()->global_to_local(unknown));
    }

    /** The degrees of freedom of the splines that this rank owns. */
    const IndexSet &
    owned() const
    {
      return owned_;
    }

    /** The degrees of freedom of the splines that this rank's active grid cells
     *  use. */
    const IndexSet &
    relevant() const
    {
      return relevant_;
    }

    /** The vector with these values at owned(), in order. */
    Vector
    vector(const std::vector<double> &values) const
    {
      Vector result = zero();
      std::copy(values.begin(), values.end(), result.begin());
      return result;
    }

    /** Zero everywhere. */
    Vector
    zero() const
    {
      return zero_;
    }

    /** The values of @p u at relevant(), in order. Neighbours exchange them. */
    std::vector<double>
    fetch(const Vector &u) const
    {
      Vector ghosted(with_others);
      ghosted.copy_locally_owned_data_from(u);
      ghosted.update_ghost_values();
      std::vector<double> values;
      values.reserve(places.size());
      for (const unsigned int place : places)
        values.push_back(ghosted.local_element(place));
      return values;
    }

    /** Adds up what all ranks have at relevant(), in order. Neighbours exchange
     *  it. */
    Vector
    sum(const std::vector<double> &values) const
    {
      // The reverse of fetch(): what this rank has for others is sent to them
      // and added there.
      Vector ghosted(with_others), sum(zero_);
      for (std::size_t k = 0; k < places.size(); ++k)
        ghosted.local_element(places[k]) = values[k];
      ghosted.compress(VectorOperation::add);
      sum.copy_locally_owned_data_from(ghosted);
      return sum;
    }

  private:
    const IndexSet            owned_, relevant_;
    const Vector              zero_;       // copies share its map
    const Vector              with_others; // zero; with relevant() of others
    std::vector<unsigned int> places;      // of relevant() in that
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

  /**
   * Converts between the 3^dim splines of a grid cell and its m unknowns:
   * u = C ũ, r̃ = Cᵀ r, K̃ = Cᵀ K C. Doing this per grid cell with
   * small dense products is several times cheaper than a global sparse triple
   * product or entrywise constraint resolution: doc/theory.md (3.5).
   *
   * Component i of unknown s is entry i m + s. Without a number of components
   * the field is the displacement.
   */
  template <int dim, int n_components = dim>
  class Condensation
  {
  public:
    /** Rows of a grid cell's equations. */
    static constexpr unsigned int n_dofs =
      LocalEquations<dim, n_components>::n_dofs;

    /** Keeps a reference to the grid cell. */
    explicit Condensation(const typename SplineSpace<dim>::GridCell &grid_cell)
      : grid_cell(grid_cell)
    {}

    /** Number m of unknowns. */
    unsigned int
    m() const
    {
      return grid_cell.unknowns.size();
    }

    /** @param coefficients n m values, n the number of components */
    LocalField<dim, n_components>
    expand(const std::vector<double> &coefficients) const
    {
      // This is u = C ũ of doc/theory.md (3.5), component by component.
      LocalField<dim, n_components> field = {};
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        for_each_weight(a, [&](const unsigned int s, const double weight) {
          for (unsigned int i = 0; i < n_components; ++i)
            field.coefficient[i][a] += weight * coefficients[i * m() + s];
        });
      return field;
    }

    /**
     * @param forces n 3^dim values
     * @param magnitudes whether to use |C|, for sums of magnitudes
     */
    std::vector<double>
    condense(const std::array<double, n_dofs> &forces,
             const bool                        magnitudes = false) const
    {
      // This is r̃ = Cᵀ r of doc/theory.md (3.5). Sums of magnitudes must not
      // cancel, so they take |C|.
      std::vector<double> result(n_components * m(), 0.);
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        for_each_weight(a, [&](const unsigned int s, const double weight) {
          for (unsigned int i = 0; i < n_components; ++i)
            result[i * m() + s] += (magnitudes ? std::abs(weight) : weight) *
                                   forces[i * BSpline<dim>::n + a];
        });
      return result;
    }

    /** Memory for condense(), to be used for one grid cell after the other. */
    using Work = std::array<std::vector<double>, 2>;

    /**
     * @param matrix (n 3^dim)² values, row by row
     * @return @p matrix itself if the unknowns are the splines, else a vector
     *         in @p work
     */
    const std::vector<double> &
    condense(const std::vector<double> &matrix, Work &work) const
    {
      if (grid_cell.weights.empty())
        return matrix;
      // K̃ = Cᵀ K C of doc/theory.md (3.5) is (Cᵀ (Cᵀ K)ᵀ)ᵀ: written so, both
      // products run over contiguous rows, and one function does both.
      auto &[product, transposed] = work;
      times_rows(matrix, n_dofs, product);
      transpose(product, n_components * m(), n_dofs, transposed);
      times_rows(transposed, n_components * m(), product);
      transpose(product, n_components * m(), n_components * m(), transposed);
      return transposed;
    }

  private:
    /** Calls visit(s, weight) for the unknowns that make up spline @p a. */
    template <typename Visit>
    void
    for_each_weight(const unsigned int a, const Visit &visit) const
    {
      // Most grid cells are inside the tissue, and have no weights: spline a is
      // unknown a. Else row a of C is mostly zeros.
      if (grid_cell.weights.empty())
        visit(a, 1.);
      else
        for (unsigned int s = 0; s < m(); ++s)
          if (grid_cell.weights[a * m() + s] != 0.)
            visit(s, grid_cell.weights[a * m() + s]);
    }

    /** Cᵀ X, C acting on each component; X has n 3^dim rows. */
    void
    times_rows(const std::vector<double> &X,
               const unsigned int         n_columns,
               std::vector<double>       &result) const
    {
      // Each row of X is added to the m rows of the result with its weight. The
      // innermost loop runs over the contiguous columns.
      result.assign(n_components * m() * n_columns, 0.);
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        for_each_weight(a, [&](const unsigned int s, const double weight) {
          for (unsigned int i = 0; i < n_components; ++i)
            {
              const double *const source =
                &X[(i * BSpline<dim>::n + a) * n_columns];
              double *const target = &result[(i * m() + s) * n_columns];
              for (unsigned int c = 0; c < n_columns; ++c)
                target[c] += weight * source[c];
            }
        });
    }

    static void
    transpose(const std::vector<double> &X,
              const unsigned int         n_rows,
              const unsigned int         n_columns,
              std::vector<double>       &result)
    {
      result.resize(X.size());
      for (unsigned int r = 0; r < n_rows; ++r)
        for (unsigned int c = 0; c < n_columns; ++c)
          result[c * n_rows + r] = X[r * n_columns + c];
    }

    const typename SplineSpace<dim>::GridCell &grid_cell;
  };

  /**
   * A field of n components on this rank's active grid cells, with the unknowns
   * of other ranks that these need. Keeps a reference to the space.
   */
  template <int dim, int n_components>
  class SplineField
  {
  public:
    using Vector = typename FieldUnknowns<dim, n_components>::Vector;

    /** @param u in the layout of FieldUnknowns::owned(). Neighbours exchange
     *  values. */
    SplineField(const SplineSpace<dim>                 &space,
                const FieldUnknowns<dim, n_components> &unknowns,
                const Vector                           &u)
      : space(space)
      , values(unknowns.fetch(u))
    {}

    /** Does as the one above, for a caller that has no FieldUnknowns.
     *  Collective. */
    SplineField(const SplineSpace<dim> &space,
                const Vector           &u,
                const MPI_Comm          comm)
      : SplineField(space, FieldUnknowns<dim, n_components>(space, comm), u)
    {}

    /** Coefficients of the splines of one active grid cell. */
    LocalField<dim, n_components>
    on_grid_cell(const unsigned int grid_cell) const
    {
      const auto &unknowns = space.grid_cells()[grid_cell].unknowns;
      if (space.grid_cells()[grid_cell].weights.empty())
        {
          // Inside of the tissue the unknowns are the splines, and their values
          // are copied.
          LocalField<dim, n_components> field;
          for (unsigned int s = 0; s < unknowns.size(); ++s)
            for (unsigned int i = 0; i < n_components; ++i)
              field.coefficient[i][s] = values[unknowns[s] * n_components + i];
          return field;
        }
      // At the surface the outer splines follow from the unknowns by C,
      // doc/theory.md (3.5), which wants the values component after component.
      std::vector<double> coefficients(n_components * unknowns.size());
      for (unsigned int s = 0; s < unknowns.size(); ++s)
        for (unsigned int i = 0; i < n_components; ++i)
          coefficients[i * unknowns.size() + s] =
            values[unknowns[s] * n_components + i];
      return Condensation<dim, n_components>(space.grid_cells()[grid_cell])
        .expand(coefficients);
    }

    /**
     * Calls action(p, field, splines) for each point of a store in order:
     * with its position p in the store, the field on its grid cell, and
     * the splines at its place.
     */
    template <typename Action>
    void
    at_points(const PointStore<dim> &store, const Action &action) const;

    /** The values at the points of a store, in order. */
    std::vector<Tensor<1, n_components>>
    values_at(const PointStore<dim> &store) const
    {
      std::vector<Tensor<1, n_components>> list(store.size());
      at_points(store,
                [&list](const unsigned int                   p,
                        const LocalField<dim, n_components> &field,
                        const SplineValues<dim>             &splines) {
                  list[p] = field.value(splines);
                });
      return list;
    }

    /** Calls action(grid_cell, field, index) for each grid cell of a store that
     *  holds points, in order. */
    template <typename Action>
    void
    on_grid_cells(const PointStore<dim> &store, const Action &action) const;

    /** The grid cells' numbers, coordinates and places. */
    const GridBox<dim> &
    box() const
    {
      return space.box();
    }

    /** The values at FieldUnknowns::relevant(). */
    const std::vector<double> &
    relevant_values() const
    {
      return values;
    }

  private:
    const SplineSpace<dim>   &space;
    const std::vector<double> values; // at FieldUnknowns::relevant()
  };

  /** The displacement. */
  template <int dim>
  using DisplacementField = SplineField<dim, dim>;

  template <int dim, int n_components>
  template <typename Action>
  void
  SplineField<dim, n_components>::at_points(const PointStore<dim> &store,
                                            const Action          &action) const
  {
    on_grid_cells(store,
                  [&](const auto                          &grid_cell,
                      const LocalField<dim, n_components> &field,
                      const GridIndex<dim>                &index) {
                    for (unsigned int p = grid_cell.begin; p < grid_cell.end;
                         ++p)
                      action(p,
                             field,
                             SplineValues<dim>(
                               box().unit_position(store.position(p), index),
                               box().spacing()));
                  });
  }

  template <int dim, int n_components>
  template <typename Action>
  void
  SplineField<dim, n_components>::on_grid_cells(const PointStore<dim> &store,
                                                const Action &action) const
  {
    unsigned int c = 0;
    for (const auto &grid_cell : store.grid_cells())
      {
        while (
          !space.is_at(space.grid_cells()[c], grid_cell.number, grid_cell.part))
          ++c;
        action(grid_cell, on_grid_cell(c), box().index(grid_cell.number));
      }
  }
} // namespace Morula

#endif
