// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/instantiate.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/state/state_columns.h>

#include <deal.II/base/mpi.h>
#include <deal.II/boost_adaptors/point.h>

#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

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
    // places of this rank. Only the surface of t = 0 is asked, so this is no
    // cost of a step.
    namespace bgi = boost::geometry::index;
    using Patches =
      std::pair<std::vector<Point<dim>>, std::vector<Tensor<1, dim>>>;
    using Entry = std::pair<Point<dim>, std::size_t>;

    Patches all;
    for (const Patches &part :
         Utilities::MPI::all_gather(comm, Patches(points, normals)))
      {
        all.first.insert(all.first.end(), part.first.begin(), part.first.end());
        all.second.insert(all.second.end(),
                          part.second.begin(),
                          part.second.end());
      }
    // The parts are in the order of the ranks. An entry keeps the number of its
    // patch, by which its normal is found.
    std::vector<Entry> entries;
    for (std::size_t i = 0; i < all.first.size(); ++i)
      entries.emplace_back(all.first[i], i);
    const bgi::rtree<Entry, bgi::linear<16>> tree(entries);

    std::vector<NearSurface<dim>> result(places.size());
    for (std::size_t k = 0; k < places.size(); ++k)
      {
        std::vector<Entry> nearest;
        tree.query(bgi::nearest(places[k], 1), std::back_inserter(nearest));
        // Without any surface all is infinitely deep, and the normal stays
        // zero.
        if (nearest.empty())
          {
            result[k].depth = std::numeric_limits<double>::infinity();
            continue;
          }
        result[k].normal = all.second[nearest[0].second];
        result[k].depth =
          // The depth is measured along the normal to the plane of the patch,
          // so that it does not jump with the spacing of patches. A cell just
          // outside that plane has depth 0.
          std::max(0., (nearest[0].first - places[k]) * result[k].normal);
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
