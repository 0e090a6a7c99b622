// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_assembly_h
#define morula_mechanics_assembly_h

#include <morula/base/block_matrix.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/term.h>

#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * Makes the sparse matrix of a field of n components on a spline space and
   * adds the condensed matrices of grid cells to it. Without a number of
   * components the field is the displacement. Rows that this rank owns are
   * written straight into the matrix through a table of positions that is made
   * once a step: to search every entry again costs more than all the particles
   * at fine grids (doc/theory.md, section 3). Rows of other ranks are summed up
   * here in the same way, and sent once.
   */
  template <int dim, int n_components = dim>
  class MatrixScatter
  {
  public:
    /** Initialises @p matrix; it must outlive this object. Collective.
     *  @param symmetric whether the sum of all that is added is
     *  @param links beside those of the grid cells, see PairTerm */
    MatrixScatter(const SplineSpace<dim>  &space,
                  BlockMatrix             &matrix,
                  const bool               symmetric,
                  const MPI_Comm           comm,
                  std::vector<UnknownLink> links = {});

    /**
     * Adds a grid cell's matrix; its row and column i m + s is component i of
     * the grid cell's s-th unknown, m their number. Links have the numbers that
     * follow those of the grid cells, and matrices as in PairTerm.
     */
    void
    add(const unsigned int grid_cell, const std::vector<double> &local_matrix);

    /** Makes all entries zero. */
    void
    clear()
    {
      matrix.clear();
      for (auto &[rank, values] : sent)
        std::fill(values.begin(), values.end(), 0.);
    }

    /** Adds what was added to other ranks' rows to these. Collective. */
    void
    finish();

  private:
    /** Numbers of relevant unknowns, by relevant unknown. */
    using Numbers = std::vector<std::vector<unsigned int>>;

    /** Messages by rank: an unknown's number, that of its columns, the columns;
     *  then the next unknown's. */
    using Messages =
      std::map<unsigned int, std::vector<types::global_dof_index>>;

    /** Place of a block in its row of blocks. */
    using Position = std::uint16_t;

    /** Of a block that a symmetric matrix does not keep. */
    static constexpr Position not_kept = std::numeric_limits<Position>::max();

    static constexpr unsigned int block_size = n_components * n_components;

    /** Number of grid cells and links. */
    unsigned int
    n_elements() const
    {
      return space.grid_cells().size() + links.size();
    }

    /** The unknowns of a grid cell, or of a link's rows. */
    const std::vector<unsigned int> &
    rows_of(const unsigned int element) const
    {
      return element < space.grid_cells().size() ?
               space.grid_cells()[element].unknowns :
               links[element - space.grid_cells().size()].rows;
    }

    /** The unknowns of a grid cell, or of a link's columns. */
    const std::vector<unsigned int> &
    columns_of(const unsigned int element) const
    {
      return element < space.grid_cells().size() ?
               space.grid_cells()[element].unknowns :
               links[element - space.grid_cells().size()].columns;
    }

    /** The ranks of all relevant unknowns. Collective. */
    std::vector<unsigned int>
    owners_of_relevant() const;

    /** Whether the matrix keeps the block of two relevant unknowns. */
    bool
    keeps(const unsigned int row, const unsigned int column) const
    {
      return !symmetric || owners[row] != owners[column] || row <= column;
    }

    /** The unknowns whose blocks are kept in the rows of each. */
    Numbers
    couplings() const;

    /** Tells the owners of other ranks' rows what will be sent to them.
     *  Collective. @return what they tell */
    Messages
    announce(const Numbers &columns);

    /** Own rows, with the columns that any rank adds to. Collective. */
    void
    make_pattern(const Numbers &columns, const Messages &announced);

    /** Where the blocks that other ranks send go. */
    void
    make_received(const Messages &announced);

    /** Where the blocks of the grid cells' matrices go. */
    void
    make_positions(const Numbers &columns);

    const SplineSpace<dim>         &space;
    const std::vector<UnknownLink>  links;
    BlockMatrix                    &matrix;
    const bool                      symmetric;
    const MPI_Comm                  comm;
    const std::vector<unsigned int> owners; // by relevant unknown

    std::vector<double *>              rows;      // by relevant unknown
    std::vector<std::vector<Position>> positions; // by element, row by row

    /** The blocks of other ranks' rows, one row after the other, by owner. */
    std::map<unsigned int, std::vector<double>> sent;

    /** Where what each rank sends is added, block by block. */
    std::map<unsigned int, std::vector<double *>> received;
  };

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
    using Vector = BlockMatrix::Vector;
    using Matrix = BlockMatrix;

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
     *  @param symmetric, links see MatrixScatter */
    void
    make_pattern(const bool                      symmetric,
                 const std::vector<UnknownLink> &links = {})
    {
      scatter.emplace(space, matrix_, symmetric, comm, links);
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
  const BlockMatrix &
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
