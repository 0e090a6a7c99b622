// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_cell_state_h
#define morula_particles_cell_state_h

#include <morula/particles/columns.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <cstdint>

namespace Morula
{
  using namespace dealii;

  /**
   * The columns of the cells. Every cell has the first three. Effects declare
   * the others that they need; a column that no effect needs takes no storage.
   */
  template <int dim>
  class CellColumns : public Columns
  {
  public:
    /** Declares the columns of every cell. */
    CellColumns()
    {
      founder_position = add<Point<dim>>(
        {"founder_position", "um", "initial position of the founder"});
      initial_volume = add<double>({"initial_volume",
                                    "um^" + std::to_string(dim),
                                    "volume at t = 0, halved at every division",
                                    0.,
                                    AtDivision::halved});
      deformation =
        add<Tensor<2, dim>>({"deformation",
                             "",
                             "deformation gradient F since t = 0",
                             Tensor<2, dim>(unit_symmetric_tensor<dim>())});
    }

    /** Declares growth, if not yet declared. Effects that let cells grow call
     *  it. */
    void
    need_growth()
    {
      if (!growth.exists())
        growth =
          add<Tensor<2, dim>>({"growth",
                               "",
                               "growth F_g",
                               Tensor<2, dim>(unit_symmetric_tensor<dim>())});
    }

    /** Declares parent and generation, if not yet declared. Effects that divide
     *  cells call it. */
    void
    need_lineage()
    {
      if (parent.exists())
        return;
      parent =
        add<int>({"parent", "", "id of the mother, -1 for founders", -1});
      generation =
        add<unsigned int>({"generation", "", "divisions since the founder"});
    }

    /** Declares the body and, if bodies can touch themselves, the part.
     *  Contact calls it. */
    void
    need_bodies(const bool with_parts = false)
    {
      if (!body.exists())
        body = add<unsigned int>({"body",
                                  "",
                                  "number of the body that the cell belongs to",
                                  0,
                                  AtDivision::copied,
                                  true});
      if (with_parts && !part.exists())
        part = add<unsigned int>(
          {"part", "", "number of the part of its grid cell"});
    }

    /** Declares the lineage key, if not yet declared. Effects that divide cells
     *  call it. */
    void
    need_lineage_key()
    {
      if (!lineage_key.exists())
        lineage_key =
          add<std::uint64_t>({"lineage_key", "", "key of the random numbers"});
    }

    /** Declares the shape, if not yet declared. Effects that follow the shape
     * of cells through divisions call it. */
    void
    need_shape()
    {
      if (!shape.exists())
        shape = add<Tensor<2, dim>>(
          {"shape",
           "",
           "H: F H is what divisions have left of the founder's cube",
           Tensor<2, dim>(unit_symmetric_tensor<dim>())});
    }

    /** Declares what cells whose volumes are pooled carry, if not yet declared.
     */
    void
    need_pools()
    {
      if (carried.exists())
        return;
      carried   = add<double>({"carried_volume",
                               "",
                               "volume that it brings into its pool, over V",
                               1.,
                               AtDivision::copied});
      smoothing = add<double>({"smoothing",
                               "",
                               "J_e as laws and files read it, over J_e",
                               1.,
                               AtDivision::copied});
    }

    /** Declares the strain of the step, if not yet declared. The laws of places
     *  call it. */
    void
    need_step_strain()
    {
      if (!step_strain.exists())
        step_strain = add<double>(
          {"step_strain", "", "strain of the last step that displaces cells"});
    }

    /** The row of a founder at @p X (µm) of this volume (µm^dim). */
    std::vector<double>
    founder(const Point<dim> &X, const double volume) const
    {
      std::vector<double> row = this->initial_row();
      founder_position.set(make_array_view(row), X);
      initial_volume.set(make_array_view(row), volume);
      return row;
    }

    /** Initial position of the founder, µm. */
    Column<Point<dim>> founder_position;
    /** V⁰, µm^dim: the founder's, halved at every division. */
    Column<double> initial_volume;
    /** F. */
    Column<Tensor<2, dim>> deformation;
    /** c / V, and what smooths J_e: only where volumes are pooled,
     *  doc/theory.md (2.9), (2.10). */
    Column<double> carried, smoothing;
    /** F_g at the time of the state. */
    Column<Tensor<2, dim>> growth;
    /** Id of the mother, -1 for founders. */
    Column<int> parent;
    /** Number of divisions since the founder. */
    Column<unsigned int> generation;
    /** Number of the body that the cell belongs to; only with contact. */
    Column<unsigned int> body;
    /** Number of the part of its grid cell that it belongs to, see Parting;
     *  only where bodies can touch themselves. */
    Column<unsigned int> part;

    /** Key of the cell's random numbers, which follows from the mother's. */
    Column<std::uint64_t> lineage_key;
    /** H: what divisions have left of the founder's cube; det H = 1. */
    Column<Tensor<2, dim>> shape;
    /** F_r, what has relaxed of F_g, where an effect keeps it apart. */
    Column<Tensor<2, dim>> relaxed;
    /** a: by how much the last step has changed the neighbourhood of the cell,
     *  doc/theory.md (6.11). */
    Column<double> step_strain;
  };

  /**
   * One cell: see RowView.
   */
  template <int dim, typename Number>
  class CellView : public RowView<CellColumns<dim>, Number>
  {
    using Base = RowView<CellColumns<dim>, Number>;
    using Base::columns_;

  public:
    using Base::Base;
    using Base::get;
    using Base::set;

    /** A view for reading from one for writing. */
    CellView(const CellView<dim, double> &other)
      : Base(other.row(), other.columns())
    {}

    /** Initial position of the founder, µm. */
    Point<dim>
    founder_position() const
    {
      return get(columns_.founder_position);
    }

    /** V⁰, µm^dim. */
    double
    initial_volume() const
    {
      return get(columns_.initial_volume);
    }

    /** F, the deformation gradient since t = 0. */
    Tensor<2, dim>
    F() const
    {
      return get(columns_.deformation);
    }

    /** F_g; the identity if no effect lets cells grow. */
    Tensor<2, dim>
    growth() const
    {
      return columns_.growth.exists() ?
               get(columns_.growth) :
               Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

    /** Id of the mother; -1 for founders. */
    int
    parent() const
    {
      return columns_.parent.exists() ? get(columns_.parent) : -1;
    }

    /** Number of divisions since the founder. */
    unsigned int
    generation() const
    {
      return columns_.generation.exists() ? get(columns_.generation) : 0;
    }

    /** V = V⁰ det F, µm^dim: doc/theory.md (1.2), equation (8) of the paper. */
    double
    volume() const
    {
      return initial_volume() * determinant(F());
    }

    /** c, µm^dim, the volume that it brings into its pool. */
    double
    carried_volume() const
    {
      return volume() *
             (columns_.carried.exists() ? get(columns_.carried) : 1.);
    }

    /** F_e = F F_g⁻¹, equation (1.3). */
    Tensor<2, dim>
    elastic_deformation() const
    {
      return F() * invert(growth());
    }

    /** F F_r⁻¹, the deformation without what has relaxed. */
    Tensor<2, dim>
    unrelaxed_deformation() const
    {
      return columns_.relaxed.exists() ? F() * invert(get(columns_.relaxed)) :
                                         F();
    }

    /** F F_r⁻¹ H, which makes a cube the shape of the cell: doc/theory.md
     *  (6.10b). Only where the shape is followed. */
    Tensor<2, dim>
    shape() const
    {
      return unrelaxed_deformation() * get(columns_.shape);
    }

    /** What makes J_e of this cell that of its surroundings: 1 if volumes are
     *  pointwise, doc/theory.md (2.10). */
    double
    smoothing() const
    {
      return columns_.smoothing.exists() ? get(columns_.smoothing) : 1.;
    }

    /** J_e as laws and files read it: det F / det F_g, smoothed where volumes
     *  are pooled. */
    double
    elastic_volume_ratio() const
    {
      return determinant(F()) / determinant(growth()) * smoothing();
    }
  };
} // namespace Morula

#endif
