// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_cells_h
#define morula_particles_cells_h

#include <morula/particles/cell_state.h>
#include <morula/particles/point_store.h>

namespace Morula
{
  /**
   * This rank's cells by their position p in the canonical order: `cells.F(p)`,
   * `cells.growth(p)`, `cells.get(column, p)`. A whole cell is `cells[p]`. The
   * ParticleHandler stores them.
   */
  template <int dim>
  class Cells : public PointStore<dim>
  {
  public:
    /** No cells yet, with these columns. */
    explicit Cells(const CellColumns<dim> &columns)
      : PointStore<dim>(columns.n_numbers(), columns.body, columns.part)
      , columns_(columns)
    {}

    /** The columns of a cell. */
    const CellColumns<dim> &
    columns() const
    {
      return columns_;
    }

    /** One cell. */
    CellView<dim, const double>
    operator[](const unsigned int p) const
    {
      return {this->row(p), columns_};
    }

    /** One cell, for writing. */
    CellView<dim, double>
    operator[](const unsigned int p)
    {
      return {this->row(p), columns_};
    }

    /** Initial position of the founder, µm. */
    Point<dim>
    founder_position(const unsigned int p) const
    {
      return (*this)[p].founder_position();
    }

    /** V⁰, µm^dim. */
    double
    initial_volume(const unsigned int p) const
    {
      return (*this)[p].initial_volume();
    }

    /** F, the deformation gradient since t = 0. */
    Tensor<2, dim>
    F(const unsigned int p) const
    {
      return (*this)[p].F();
    }

    /** F_g; the identity if no effect lets cells grow. */
    Tensor<2, dim>
    growth(const unsigned int p) const
    {
      return (*this)[p].growth();
    }

    /** V = V⁰ det F, µm^dim. */
    double
    volume(const unsigned int p) const
    {
      return (*this)[p].volume();
    }

  private:
    const CellColumns<dim> columns_;
  };
} // namespace Morula

#endif
