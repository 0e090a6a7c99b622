// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/base/send_records.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/fate/proliferation.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The von Mises stress. It has all components in plane strain, too: σ_zz
     * is not zero there. */
    double
    von_mises(const SymmetricTensor<2, 3> &sigma)
    {
      return std::sqrt(1.5) * deviator(sigma).norm();
    }
  } // namespace


  template <int dim>
  unsigned int
  CellReader<dim>::phase(const CellView<dim, const double> &cell) const
  {
    // This is the number that the outputs have for cells outside any cycle.
    constexpr unsigned int does_not_proliferate = 9;
    return cycle == nullptr ?
             does_not_proliferate :
             cycle->cycle().phase_number(cycle->clock(cell),
                                         cell.founder_position(),
                                         time);
  }


  template <int dim>
  const CellQuantities &
  PresentCell<dim>::quantities() const
  {
    // Stress and energy are computed at most once for a cell, as several
    // expressions may ask for them. A PresentCell is made anew for each cell
    // and step, so they cannot become stale.
    if (!quantities_)
      quantities_ = cell_quantities(cell_,
                                    reader_.material.material(),
                                    lame(),
                                    reader_.material.per_grown_volume());
    return *quantities_;
  }


  template <int dim>
  void
  PresentCell<dim>::provide(const std::vector<Variable> &variables,
                            const double                 t) const
  {
    // Variables are computed when an expression asks for them and kept in
    // `values`, with one bit in `known` for each. X and t are cheap and are
    // always set; ages and t follow the time and are set anew.
    if (variables.empty())
      return;
    // Messages of errors name X in any case, whether the expression uses it or
    // not.
    const Point<dim> X = cell_.founder_position();
    for (unsigned int d = 0; d < 3; ++d)
      values[d] = d < dim ? X[d] : 0.;
    values[static_cast<unsigned int>(Variable::t)] = t;
    for (const Variable variable : variables)
      {
        static_assert(n_variables + most_fields <= 64, "Bits of `known`.");
        const auto bit = std::uint64_t(1)
                         << static_cast<unsigned int>(variable);
        if (variable <= Variable::t)
          continue;
        // Ages depend on the time of this call, so what is known of them may be
        // of another time.
        if ((known & bit) != 0 && variable != Variable::age &&
            variable != Variable::type_age)
          continue;
        values[static_cast<unsigned int>(variable)] = compute(variable, t);
        known |= bit;
      }
  }


  template <int dim>
  double
  PresentCell<dim>::compute(const Variable variable, const double t) const
  {
    // Positions are present ones, while X is the founder's. Stresses are Cauchy
    // stresses per present area; pressure is positive where tissue is squeezed.
    // Columns that are read exist, because the expression announced its
    // variables to StateColumns.
    const StateColumns<dim> &columns = reader_.columns;
    if (is_field(variable))
      {
        const unsigned int k        = field_number(variable);
        const unsigned int n_fields = columns.field_names().size();
        const unsigned int n        = columns.n_before_neighbours();
        if (k < n)
          return cell_.get(k < n_fields ? columns.fields[k] :
                                          columns.numbers[k - n_fields]);
        const NeighbourVariable &told = columns.neighbour_variables()[k - n];
        return told.kind == NeighbourVariable::slope ?
                 gradient(told.number).norm() :
                 cell_.get(columns.neighbours[k - n]);
      }
    switch (variable)
      {
        case Variable::x:
          return position_[0];
        case Variable::y:
          return position_[1];
        case Variable::z:
          // The index is valid in 2-D as well, where this branch is compiled
          // but not taken.
          return dim == 3 ? position_[dim - 1] : 0.;
        case Variable::generation:
          return cell_.generation();
        case Variable::age:
          return t - cell_.get(columns.birth_time);
        case Variable::type_age:
          return t - cell_.get(columns.type_since);
        case Variable::cycle_phase:
          return reader_.phase(cell_);
        case Variable::type:
          return type();
        case Variable::volume:
          return cell_.volume();
        case Variable::growth:
          return determinant(cell_.growth());
        case Variable::J_e:
          return cell_.elastic_volume_ratio();
        case Variable::pressure:
          return -trace(quantities().stress) / 3.;
        case Variable::tension:
          // deal.II sorts eigenvalues in descending order: the first is the
          // most tensile.
          return eigenvalues(quantities().stress)[0];
        case Variable::shear:
          return von_mises(quantities().stress);
        case Variable::energy:
          return quantities().energy_density;
        case Variable::depth:
          return cell_.get(columns.depth);
        case Variable::present_depth:
          return cell_.get(columns.present_depth);
        case Variable::noise:
          return Random::noise(reader_.random_seed, lineage_key());
        default:
          Assert(false, ExcInternalError());
          return 0.;
      }
  }


  template <int dim>
  PresentCell<dim>
  present_cell(const Tissue<dim>     &tissue,
               const unsigned int     p,
               const CellReader<dim> &reader)
  {
    // The number p is that of the store of this rank; the id is global.
    const Cells<dim> &cells = tissue.cells();
    return {cells[p], cells.id(p), cells.position(p), reader};
  }


  template struct CellReader<2>;
  template struct CellReader<3>;
  template class PresentCell<2>;
  template class PresentCell<3>;
  MORULA_INSTANTIATE(present_cell);


  template <int dim>
  std::vector<NearSurface<dim>>
  near_surface(const std::vector<Point<dim>>     &places,
               const std::vector<Point<dim>>     &points,
               const std::vector<Tensor<1, dim>> &normals,
               const MPI_Comm                     comm)
  {
    // Each rank has some patches of the surface and some places, and the patch
    // nearest to a place may be on any rank. So all patches are gathered on
    // every rank, which is collective, and a tree of them answers for the
    // places of this rank.
    const auto of_all_ranks = [comm](const auto &mine) {
      std::decay_t<decltype(mine)> all;
      for (const auto &part : gather_everywhere(mine, comm))
        all.insert(all.end(), part.begin(), part.end());
      return all;
    };
    const auto                    positions   = of_all_ranks(points);
    const auto                    all_normals = of_all_ranks(normals);
    const NearTree<dim>           tree(positions);
    std::vector<NearSurface<dim>> result(places.size());
    for (std::size_t k = 0; k < places.size(); ++k)
      {
        // Without any surface all is infinitely deep, and the normal stays
        // zero. Else the depth is measured along the normal to the plane of the
        // patch, so that it does not jump with the spacing of patches. A cell
        // just outside that plane has depth 0.
        if (positions.empty())
          {
            result[k].depth = std::numeric_limits<double>::infinity();
            continue;
          }
        const unsigned int i = tree.nearest(places[k]);
        result[k].normal     = all_normals[i];
        result[k].depth =
          std::max(0., (positions[i] - places[k]) * result[k].normal);
      }
    return result;
  }

  MORULA_INSTANTIATE(near_surface);


  namespace
  {
    /** What expressions of cells say of `present_depth`; there are no keys. */
    struct PresentDepthParameters : public EffectKeys
    {
      bool is_used = false;

      bool
      is_on() const override
      {
        return is_used;
      }

      void
      see(const SceneKeys &, const std::vector<ExpressionKey *> &keys) override
      {
        // Whether the variable is really read is known when the expressions are
        // parsed: then the column is there. The word may stand in a key of an
        // effect that is off.
        for (const ExpressionKey *key : keys)
          is_used =
            is_used || key->text().find("present_depth") != std::string::npos;
      }
    };

    /** Sets the variable `present_depth` of all cells: their distance from the
     *  surface as it is now. */
    template <int dim>
    class PresentDepth : public StepEffect<dim>
    {
    public:
      using Parameters = PresentDepthParameters;

      explicit PresentDepth(const Parameters &) {}

      void
      surfaced(Tissue<dim>            &tissue,
               const MomentOfRun<dim> &moment) const override
      {
        // All ranks have the column or none has, so that all come to the
        // search, which gathers the surface on every rank.
        const Column<double> column = moment.reader.columns.present_depth;
        if (!column.exists())
          return;
        const Cells<dim>           &cells  = tissue.cells();
        const BoundaryPoints<dim>  &points = tissue.boundary_points();
        std::vector<Point<dim>>     places, at;
        std::vector<Tensor<1, dim>> normals;
        for (unsigned int p = 0; p < cells.size(); ++p)
          places.push_back(cells.position(p));
        for (unsigned int p = 0; p < points.size(); ++p)
          {
            const Tensor<1, dim> area = points[p].area_vector();
            at.push_back(points.position(p));
            normals.push_back(area / area.norm());
          }
        const auto near =
          near_surface(places, at, normals, tissue.communicator());
        for (unsigned int p = 0; p < cells.size(); ++p)
          tissue.cell(p).set(column, near[p].depth);
      }
    };
  } // namespace


  void
  add_present_depth(Catalogue &catalogue)
  {
    catalogue.add_own<PresentDepth>("present depth",
                                    {"Growth/Law=rate",
                                     "Growth/Rate/Rate=0.2*present_depth"});
  }
} // namespace Morula
