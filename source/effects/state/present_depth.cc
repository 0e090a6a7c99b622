// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/base/send_records.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/state/state_columns.h>

#include <algorithm>
#include <limits>

namespace Morula
{
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
