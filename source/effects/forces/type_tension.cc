// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/type_tension.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/loads.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>

#include <sstream>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** A fraction that a type reaches in the middle of a domain 2 h wide. */
    constexpr double of_a_domain = 0.9;

    /** The largest fraction of each type at the founders. Collective. */
    template <int dim>
    std::vector<double>
    largest_fractions(const Preview<dim> &scene, const unsigned int n_types)
    {
      // The founders of a rank may stand anywhere, so the sums of all ranks'
      // splines are joined; there are far fewer splines than cells.
      const std::vector<double> &offset = scene.keys.grid.offset.value();
      Point<dim>                 lines;
      for (unsigned int d = 0; d < dim; ++d)
        lines[d] = offset[d];
      const GridBox<dim> box({}, {}, scene.keys.grid.spacing, lines);
      TypeFractions<dim> mine(box, n_types), all(box, n_types);
      for (std::size_t i = 0; i < scene.founders.size(); ++i)
        mine.add(scene.founders[i], scene.volumes[i], scene.types[i]);
      for (const auto &sums : Utilities::MPI::all_gather(scene.comm, mine.sums))
        all.add(sums);
      return all.largest();
    }

    /** The volume and type of a cell, which ranks tell each other. */
    using VolumeAndType = std::tuple<double, unsigned int>;

    /** The fractions around this rank's cells, added up in an order that does
     *  not depend on the ranks. Collective. */
    template <int dim>
    TypeFractions<dim>
    fractions(const Tissue<dim>          &tissue,
              const Column<unsigned int> &type,
              const unsigned int          n_types)
    {
      // A spline reaches one grid cell to each side of its own, so that the
      // splines of a cell need the cells two grid cells away.
      const Cells<dim>   &cells = tissue.cells();
      const GridBox<dim> &box   = tissue.grid().box();
      PointList<dim>      list(Flat<VolumeAndType>::n);
      for (unsigned int p = 0; p < cells.size(); ++p)
        list.add_value(cells.id(p),
                       cells.position(p),
                       VolumeAndType(cells.volume(p), cells.get(type, p)));
      list.append(halo(list, tissue.grid(), 2. * box.spacing()));
      std::vector<std::pair<unsigned int, std::size_t>> order;
      for (std::size_t i = 0; i < list.size(); ++i)
        order.emplace_back(box.number(box.locate(list.positions[i])), i);
      std::sort(order.begin(), order.end(), [&](const auto &a, const auto &b) {
        return std::make_pair(a.first, list.ids[a.second]) <
               std::make_pair(b.first, list.ids[b.second]);
      });
      TypeFractions<dim> found(box, n_types);
      for (const auto &[number, i] : order)
        {
          const auto [V, of_cell] = list.template value<VolumeAndType>(i);
          found.add(list.positions[i], V, of_cell);
        }
      return found;
    }

    /** A place with the volume that it stands for. */
    template <int dim>
    struct WeightedPlace
    {
      Point<dim> x;  // µm
      Point<dim> xi; // in its grid cell
      double     V;  // µm^dim
    };

    /**
     * The places where the tension of the cells [begin, end) of one grid cell
     * and body is summed. Inside of the tissue they are Gauss points: cells are
     * no even quadrature, so that interfaces would pull more where cells are
     * many, and would drive them away from there. A grid cell that the surface
     * may cut, or that bodies share, has its cells, which lie in the tissue.
     */
    template <int dim>
    std::vector<WeightedPlace<dim>>
    quadrature(const Tissue<dim>                           &tissue,
               const TypeFractions<dim>                    &field,
               const GroupedPoints<dim>                    &positions,
               const std::pair<unsigned int, unsigned int> &range)
    {
      const auto [begin, end] = range;
      if (begin == end)
        return {};
      std::vector<WeightedPlace<dim>> places;
      const Cells<dim>               &cells = tissue.cells();
      const GridBox<dim>             &box   = tissue.grid().box();
      const GridIndex<dim>            index = box.locate(cells.position(begin));
      if (!field.is_filled_by(end - begin, index))
        {
          for (unsigned int p = begin; p < end; ++p)
            places.push_back(
              {cells.position(p), positions.xi[p], cells.volume(p)});
          return places;
        }
      static const QGauss<dim> gauss(3);
      const double size = Utilities::fixed_power<dim>(box.spacing());
      for (unsigned int k = 0; k < gauss.size(); ++k)
        {
          const Point<dim> xi = gauss.point(k);
          places.push_back(
            {box.corner(index) + box.spacing() * Tensor<1, dim>(xi),
             xi,
             size * gauss.weight(k)});
        }
      return places;
    }


    /** Tension of the interfaces between types of cells, from the gradients of
     *  the types' fractions: doc/theory.md (12.1)-(12.3). */
    template <int dim>
    class TypeTension : public Force<dim>
    {
    public:
      using Parameters = TypeTensionParameters;

      /** @throws InputError for a negative tension */
      TypeTension(const Parameters &parameters, const EffectSetting<dim> &)
        : tensions(parameters.matrix())
        , types(parameters.types)
      {
        for (const Key<double> &key : parameters.between)
          if (key < 0.)
            key.refuse(
              "a value >= 0 kPa um",
              "An interface with a negative tension would crumple: set " +
                parameters.force.path() +
                " = false, so that only Rearrangement uses it.");
      }

      std::unique_ptr<Term<dim>>
      term(const Tissue<dim>        &tissue,
           const CellReader<dim>    &reader,
           const GroupedPoints<dim> &positions,
           const double,
           const double) const override
      {
        // Each point of quadrature with a gradient has V |cof f g| of each
        // interface that it is in, doc/theory.md (12.2): the term of a surface
        // whose area is V g. In the middle of a domain there is none, which
        // costs nothing in the iterations. The smoothing ε is one number per
        // length, and the volume stands in the tension, with what ε takes from
        // flat interfaces.
        const TypeFractions<dim> field =
          fractions(tissue, reader.columns.type, tensions.size());
        GroupedPoints<dim> points;
        points.h       = positions.h;
        points.offsets = {0};
        std::vector<AreaLoad<dim>> loads;
        for (unsigned int c = 0; c + 1 < positions.offsets.size(); ++c)
          {
            for (const auto &[x, xi, V] :
                 quadrature(tissue,
                            field,
                            positions,
                            {positions.offsets[c], positions.offsets[c + 1]}))
              {
                const auto at = field.at(x);
                for (unsigned int a = 0; a < tensions.size(); ++a)
                  for (unsigned int b = a + 1; b < tensions.size(); ++b)
                    {
                      const Tensor<1, dim> g = at.fraction[a] * at.gradient[b] -
                                               at.fraction[b] * at.gradient[a];
                      if (tensions[a][b] == 0. || g.norm() * points.h < 1e-10)
                        continue;
                      points.xi.push_back(xi);
                      loads.push_back(
                        {tensions[a][b] * V / Parameters::left_by_smoothing,
                         g});
                    }
              }
            points.offsets.push_back(points.xi.size());
          }
        return surface_energy<dim>(std::move(points),
                                   std::move(loads),
                                   Parameters::smoothing / positions.h);
      }

      /** Warns of types whose domains are too narrow for their tension to be
       *  felt, as the founders stand. */
      void
      review(const Preview<dim> &scene, Review &review) const override
      {
        // Exchanges of places make domains of a mixture, so that the founders
        // tell nothing there. A type without founders may come later.
        if (find_choice(scene.keys.catalogue.step_effects, "rearrangement")
              ->keys()
              .is_on())
          return;
        const auto largest = largest_fractions(scene, tensions.size());
        for (unsigned int a = 0; a < tensions.size(); ++a)
          for (unsigned int b = 0; b < tensions.size(); ++b)
            if (tensions[a][b] > 0. && largest[a] > 0. &&
                largest[a] < of_a_domain)
              {
                std::ostringstream why, value;
                value << tensions[a][b] << " kPa um";
                why
                  << "cells of type " << types[a] << " are at most "
                  << static_cast<int>(100. * largest[a])
                  << " % of the cells around a place at t = 0: their domains are "
                     "narrower than 2 grid spacings, and the tension hardly acts "
                     "on these (doc/theory.md, section 12.2).";
                review.warn(
                  "Cell types/" + types[a] + "/Tension/With " + types[b],
                  value.str(),
                  why.str(),
                  "Take a smaller " + scene.keys.grid.spacing.path() +
                    ", at least 2.5 cells, or let cells change places "
                    "(Rearrangement/Diffusion).");
                break;
              }
      }

    private:
      const std::vector<std::vector<double>> tensions;
      const std::vector<std::string>         types;
    };
  } // namespace


  void
  add_type_tension(Catalogue &catalogue)
  {
    catalogue.add_own<TypeTension>("type tension",
                                   {"Cell types/Names=a, b",
                                    "Cell types/b/Where=X*Y > 0",
                                    "Cell types/a/Tension/With b=0.1"});
  }
} // namespace Morula
