// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_assembly_h
#define morula_mechanics_assembly_h

#include <morula/mechanics/condensation.h>
#include <morula/mechanics/field_unknowns.h>
#include <morula/mechanics/matrix_scatter.h>
#include <morula/mechanics/spline_field.h>

#include <functional>
#include <optional>
#include <vector>

namespace Morula
{
  /**
   * Adds up the equations of a field of n components over the active grid
   * cells, condensed to the unknown splines inside each grid cell:
   * doc/theory.md (3.5). Without a number of components the field is the
   * displacement. Keeps a reference to the space.
   *
   * add(grid_cell, field, local) adds the equations of one grid cell to
   * `local`, a LocalEquations<dim, n_components> or a class derived from it;
   * `field` holds the field's coefficients there.
   */
  template <int dim, int n_components = dim>
  class Assembly
  {
  public:
    using Vector = TrilinosWrappers::MPI::Vector;
    using Matrix = TrilinosWrappers::SparseMatrix;

    /** Adds to the sums of residual(), at the same field: given are its values
     *  at the relevant degrees of freedom, the sums and, if wanted, those of
     *  the magnitudes. */
    using AddMore = std::function<void(const std::vector<double> &,
                                       std::vector<double> &,
                                       std::vector<double> *)>;

    Assembly(const SplineSpace<dim> &space, const MPI_Comm comm)
      : space(space)
      , comm(comm)
      , unknowns_(space, comm)
    {}

    const FieldUnknowns<dim, n_components> &
    unknowns() const
    {
      return unknowns_;
    }

    /**
     * Adds up the residuals. FieldUnknowns::sum() adds up those of all ranks.
     * Stops where add() returns false. Collective.
     * @param magnitudes if not null, the magnitudes' sums; with local.wanted ==
     *        rounding
     * @return this rank's sums, in the order of FieldUnknowns::relevant()
     */
    template <typename Local, typename Add>
    std::vector<double>
    residual(const Vector        &u,
             Local               &local,
             const Add           &add,
             std::vector<double> *magnitudes = nullptr,
             const AddMore       &add_more   = {}) const;

    /** Whether make_pattern() has been called. */
    bool
    has_pattern() const
    {
      return scatter.has_value();
    }

    /** Makes the sparse matrix, before the first matrix() and where other
     *  unknowns are linked than before. Collective.
     *  @param links see MatrixScatter */
    void
    make_pattern(const std::vector<UnknownLink> &links = {})
    {
      scatter.emplace(space, unknowns_.owned(), matrix_, comm, links);
    }

    /** Adds to the matrix, given the values at the relevant degrees of freedom
     *  and where to add the matrix of a link. */
    using AddLinks = std::function<void(
      const std::vector<double> &,
      const std::function<void(unsigned int, const std::vector<double> &)> &)>;

    /** Adds up the tangents; the matrix of the last call is overwritten.
     *  Collective. */
    template <typename Local, typename Add>
    const Matrix &
    matrix(const Vector   &u,
           Local          &local,
           const Add      &add,
           const AddLinks &add_links = {});

    /** What the last call of matrix() has made. */
    const Matrix &
    last_matrix() const
    {
      return matrix_;
    }

  private:
    /** Adds the forces of grid cell @p c, or their magnitudes, to the sums over
     *  grid cells. */
    template <typename Forces>
    void
    add_condensed(const unsigned int   c,
                  const Forces        &forces,
                  const bool           magnitudes,
                  std::vector<double> &sums) const;

    const SplineSpace<dim>                         &space;
    const MPI_Comm                                  comm;
    const FieldUnknowns<dim, n_components>          unknowns_;
    Matrix                                          matrix_;
    std::optional<MatrixScatter<dim, n_components>> scatter;
  };

  template <int dim, int n_components>
  template <typename Local, typename Add>
  std::vector<double>
  Assembly<dim, n_components>::residual(const Vector        &u,
                                        Local               &local,
                                        const Add           &add,
                                        std::vector<double> *magnitudes,
                                        const AddMore       &add_more) const
  {
    const SplineField<dim, n_components> field(space, unknowns_, u);
    std::vector<double> sums(unknowns_.relevant().n_elements(), 0.);
    if (magnitudes != nullptr)
      magnitudes->assign(sums.size(), 0.);
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        local.clear();
        if (!add(c, field.on_grid_cell(c), local))
          break;
        add_condensed(c, local.residual, false, sums);
        if (magnitudes != nullptr)
          add_condensed(c, local.magnitude, true, *magnitudes);
      }
    if (add_more)
      add_more(field.relevant_values(), sums, magnitudes);
    return sums;
  }

  template <int dim, int n_components>
  template <typename Forces>
  void
  Assembly<dim, n_components>::add_condensed(const unsigned int   c,
                                             const Forces        &forces,
                                             const bool           magnitudes,
                                             std::vector<double> &sums) const
  {
    const auto &grid_cell = space.grid_cells()[c];
    const auto &splines   = grid_cell.unknowns;
    const auto  add       = [&](const auto &condensed) {
      for (unsigned int s = 0; s < splines.size(); ++s)
        for (unsigned int i = 0; i < n_components; ++i)
          sums[splines[s] * n_components + i] +=
            condensed[i * splines.size() + s];
    };
    if (grid_cell.weights.empty()) // the unknowns are the splines
      add(forces);
    else
      add(Condensation<dim, n_components>(grid_cell).condense(forces,
                                                              magnitudes));
  }

  template <int dim, int n_components>
  template <typename Local, typename Add>
  const TrilinosWrappers::SparseMatrix &
  Assembly<dim, n_components>::matrix(const Vector   &u,
                                      Local          &local,
                                      const Add      &add,
                                      const AddLinks &add_links)
  {
    scatter->clear();
    const SplineField<dim, n_components>           field(space, unknowns_, u);
    typename Condensation<dim, n_components>::Work work;
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        local.clear();
        add(c, field.on_grid_cell(c), local);
        scatter->add(c,
                     Condensation<dim, n_components>(space.grid_cells()[c])
                       .condense(local.matrix, work));
      }
    if (add_links)
      add_links(field.relevant_values(),
                [&](const unsigned int link, const std::vector<double> &part) {
                  scatter->add(space.grid_cells().size() + link, part);
                });
    scatter->finish();
    return matrix_;
  }
} // namespace Morula

#endif
