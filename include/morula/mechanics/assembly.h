// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_assembly_h
#define morula_mechanics_assembly_h

#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/term.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <Epetra_CrsGraph.h>
#include <mpi.h>

#include <algorithm>
#include <functional>
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
   * written straight into the matrix's own arrays through a table of positions
   * that is made once a step: TrilinosWrappers' add() searches every entry
   * again, which costs more than all the particles at fine grids
   * (doc/theory.md, section 3). Rows of other ranks are summed up here in the
   * same way, and sent once.
   */
  template <int dim, int n_components = dim>
  class MatrixScatter
  {
  public:
    using Matrix = TrilinosWrappers::SparseMatrix;

    /** Initialises @p matrix; it must outlive this object. Collective.
     *  @param own_rows as FieldUnknowns::owned()
     *  @param links beside those of the grid cells, see PairTerm */
    MatrixScatter(const SplineSpace<dim>  &space,
                  const IndexSet          &own_rows,
                  Matrix                  &matrix,
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
      int    *offsets, *columns;
      double *values;
      matrix.trilinos_matrix().ExtractCrsDataPointers(offsets, columns, values);
      std::fill(values, values + matrix.trilinos_matrix().NumMyNonzeros(), 0.);
      for (auto &[rank, values] : sent)
        std::fill(values.begin(), values.end(), 0.);
    }

    /** Adds what was added to other ranks' rows to these. Neighbours exchange
     *  it. */
    void
    finish();

  private:
    /** The unknowns that a relevant unknown couples with on this rank, by
     *  relevant unknown. */
    using Couplings = std::vector<std::vector<unsigned int>>;

    Couplings
    couplings() const;

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

    /** The global unknowns in the rows of an owned unknown, by owned unknown.
     */
    using Unknowns = std::vector<std::vector<types::global_dof_index>>;

    /** Ranks, by relevant unknown. */
    std::vector<unsigned int>
    owners_of_relevant() const
    {
      // This rank's own unknowns need no question. Only the owners of the
      // others are asked for. Collective.
      const IndexSet &relevant = space.relevant();
      IndexSet        foreign  = relevant;
      foreign.subtract_set(space.owned());
      const std::vector<unsigned int> owners =
        Utilities::MPI::compute_index_owner(space.owned(), foreign, comm);
      std::vector<unsigned int> all(relevant.n_elements(),
                                    Utilities::MPI::this_mpi_process(comm));
      for (types::global_dof_index k = 0; k < owners.size(); ++k)
        all[relevant.index_within_set(foreign.nth_index_in_set(k))] = owners[k];
      return all;
    }

    /** Messages by rank: an unknown's number, that of its columns, the columns;
     *  then the next unknown's. */
    using Messages =
      std::map<unsigned int, std::vector<types::global_dof_index>>;

    /** Tells the owners of other ranks' rows what will be sent to them.
     *  @return what they tell */
    Messages
    announce(const Couplings &columns, const std::vector<unsigned int> &owners);

    /** Own rows, with the columns that any rank adds to. */
    void
    make_pattern(const Couplings &columns,
                 const Messages  &announced,
                 const IndexSet  &own_rows);

    /** What other ranks have added to own rows, by rank. deal.II's
     *  some_to_some() would ask anew who has something for whom, which takes
     *  barriers of all ranks. */
    std::map<unsigned int, std::vector<double>>
    exchange() const;

    /** Where the entries that other ranks send go. */
    void
    make_received(const Messages &announced);

    /** Where the entries of the grid cells' matrices go. */
    void
    make_positions(const Couplings                 &columns,
                   const std::vector<unsigned int> &owners);

    /**
     * The matrix's structure. Its columns stand in the order of the unknowns,
     * this rank's first, with the components of each side by side: deal.II's
     * SparsityPattern leaves the order to Epetra, which takes three times as
     * long on several ranks to find one, and may part the components.
     * @param unknowns those in the rows of each own unknown
     * @param others those of them that are not owned, sorted
     */
    Epetra_CrsGraph
    graph(const Unknowns                             &unknowns,
          const std::vector<types::global_dof_index> &others,
          const IndexSet                             &own_rows) const;

    /** Position in the matrix's columns of a global unknown's first
     *  component. */
    int
    column_id(const types::global_dof_index unknown) const
    {
      return matrix.trilinos_matrix().ColMap().LID(
        static_cast<TrilinosWrappers::types::int_type>(unknown * n_components));
    }

    /** An unknown's rows that another rank adds to: the number of the owned
     *  unknown, and the positions of the columns' first components. */
    using Received = std::pair<unsigned int, std::vector<unsigned int>>;

    const SplineSpace<dim>                &space;
    const std::vector<UnknownLink>         links;
    Matrix                                &matrix;
    const MPI_Comm                         comm;
    std::vector<double *>                  rows;         // by relevant dof
    std::vector<int>                       owned_number; // by relevant unknown
    std::vector<std::vector<unsigned int>> positions; // by element, row by row

    /** The values of an owner's rows, one after the other, by owner. */
    std::map<unsigned int, std::vector<double>>   sent;
    std::map<unsigned int, std::vector<Received>> received; // by sender
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
