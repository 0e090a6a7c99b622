// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/rounded_sums.h>
#include <morula/effects/catalogue.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    struct ShapeParameters : public EffectKeys
    {
      Key<bool> numbers{
        {this, "Shape/Numbers"},
        false,
        "Whether statistics.csv has numbers of the tissue's shape: roundness, "
        "radii of gyration, spread of the radius, lobes, area, and with types "
        "the share of contacts between unlike ones."};

      EffectFacts
      facts() const override
      {
        EffectFacts facts{&numbers};
        facts.needs_surface = true;
        return facts;
      }
    };

    /** Highest mode that counts as lobes. */
    template <int dim>
    constexpr unsigned int most_lobes = dim == 2 ? 16 : 8;

    /** Number of the complex part @p m of mode @p l among all from l = 2 on. */
    template <int dim>
    unsigned int
    number_of_mode(const unsigned int l, const unsigned int m)
    {
      return dim == 2 ? l - 2 : l * (l + 1) / 2 - 3 + m;
    }

    /** Calls visit(number, value) for the complex parts of all modes in a
     *  direction, orthonormal but for the sign of m. */
    template <int dim, typename Visit>
    void
    for_modes(const Tensor<1, dim> &n, const Visit &visit)
    {
      const double phi = std::atan2(n[1], n[0]);
      for (unsigned int l = 2; l <= most_lobes<dim>; ++l)
        for (unsigned int m = dim == 2 ? l : 0; m <= l; ++m)
          {
            double size = 1. / std::sqrt(2. * numbers::PI);
            if constexpr (dim == 3)
              size =
                std::sph_legendre(l, m, std::acos(std::clamp(n[2], -1., 1.)));
            visit(number_of_mode<dim>(l, m), size * std::polar(1., m * phi));
          }
    }

    /** Says what shape the tissue has: doc/glossary.md. */
    template <int dim>
    class ShapeNumbers : public StepEffect<dim>
    {
    public:
      using Parameters = ShapeParameters;

      ShapeNumbers(const Parameters &, const EffectSetting<dim> &setting)
        : type(setting.columns.template find<unsigned int>("type"))
        , search(setting.neighbours)
      {}

      void
      declare(Tables<dim> &tables) const override
      {
        for (const std::string name : {"roundness",
                                       "gyration_radius",
                                       "gyration_axis_1",
                                       "gyration_axis_2"})
          tables.add_number(name);
        if (dim == 3)
          tables.add_number("gyration_axis_3");
        for (const std::string name :
             {"radius_spread", "lobes", "lobe_power", "free_area"})
          tables.add_number(name);
        if (type.exists())
          tables.add_number("unlike_contacts");
      }

      void
      describe(const Tissue<dim>      &tissue,
               const MomentOfRun<dim> &moment) const override
      {
        const double     h      = tissue.grid().box().spacing();
        const Point<dim> center = tell_of_cells(tissue, h, moment.of_step);
        tell_of_surface(tissue, center, h, moment.of_step);
        if (type.exists())
          tell_of_contacts(tissue, moment.of_step);
      }

    private:
      /** Adds the radii of gyration. @return the center of mass, µm */
      static Point<dim>
      tell_of_cells(const Tissue<dim> &tissue, const double h, NamedNumbers &to)
      {
        // Each cell counts as a cube of its volume, which has a moment of its
        // own. The unit of length is h, so that sums can be rounded.
        const Cells<dim> &cells = tissue.cells();
        const double      unit  = Utilities::fixed_power<dim>(h);
        RoundedSums       first(1 + dim, tissue.communicator());
        for (unsigned int p = 0; p < cells.size(); ++p)
          {
            const double V = cells.volume(p) / unit;
            first.add(0, V);
            for (unsigned int d = 0; d < dim; ++d)
              first.add(1 + d, V * cells.position(p)[d] / h);
          }
        const std::vector<double> sums = first.all();
        Point<dim>                center;
        for (unsigned int d = 0; d < dim; ++d)
          center[d] = h * sums[1 + d] / sums[0];
        constexpr unsigned int n =
          SymmetricTensor<2, dim>::n_independent_components;
        RoundedSums second(n, tissue.communicator());
        for (unsigned int p = 0; p < cells.size(); ++p)
          {
            const double         V = cells.volume(p) / unit;
            const Tensor<1, dim> y = (cells.position(p) - center) / h;
            const auto           moment =
              V * (symmetrize(outer_product(y, y)) +
                   std::pow(V, 2. / dim) / 12. * unit_symmetric_tensor<dim>());
            for (unsigned int k = 0; k < n; ++k)
              second.add(k, moment.access_raw_entry(k));
          }
        const std::vector<double> entries = second.all();
        SymmetricTensor<2, dim>   tensor;
        for (unsigned int k = 0; k < n; ++k)
          tensor.access_raw_entry(k) = h * h * entries[k] / sums[0];
        const auto squares    = eigenvalues(tensor);
        to["gyration_radius"] = std::sqrt(trace(tensor));
        for (unsigned int d = 0; d < dim; ++d)
          to["gyration_axis_" + std::to_string(d + 1)] =
            std::sqrt(std::max(0., squares[d]));
        return center;
      }

      /** Adds what the surface tells. @param center of the directions, µm */
      static void
      tell_of_surface(const Tissue<dim> &tissue,
                      const Point<dim>  &center,
                      const double       h,
                      NamedNumbers      &to)
      {
        // Integrals over all directions are sums over patches, each of which is
        // seen from the center at an angle dw, with a sign where it faces the
        // center: sums of area, volume, dw, r dw, r² dw, and r dw times the
        // modes.
        constexpr unsigned int n_modes =
          dim == 2 ? most_lobes<2> - 1 :
                     (most_lobes<3> + 1) * (most_lobes<3> + 2) / 2 - 3;
        const BoundaryPoints<dim> &points = tissue.boundary_points();
        RoundedSums                own(5 + 2 * n_modes, tissue.communicator());
        for (unsigned int p = 0; p < points.size(); ++p)
          {
            const Tensor<1, dim> y = (points.position(p) - center) / h;
            const Tensor<1, dim> A =
              points.area_vector(p) / Utilities::fixed_power<dim - 1>(h);
            const double r = y.norm();
            if (r == 0.)
              continue;
            const double dw = y * A / Utilities::fixed_power<dim>(r);
            own.add(0, A.norm());
            own.add(1, y * A / dim);
            own.add(2, dw);
            own.add(3, r * dw);
            own.add(4, r * r * dw);
            for_modes<dim>(y / r, [&](const unsigned int k, const auto &value) {
              own.add(5 + 2 * k, r * dw * value.real());
              own.add(6 + 2 * k, r * dw * value.imag());
            });
          }
        const std::vector<double> sums = own.all();
        if (!(sums[3] > 0.))
          return;
        const double radius = sums[3] / sums[2];
        // The power of a mode is the mean square of its part of r/r_mean.
        for (unsigned int l = 2; l <= most_lobes<dim>; ++l)
          {
            double power = 0.;
            for (unsigned int m = dim == 2 ? l : 0; m <= l; ++m)
              {
                const unsigned int k = 5 + 2 * number_of_mode<dim>(l, m);
                power += (m > 0 ? 2. : 1.) *
                         (sums[k] * sums[k] + sums[k + 1] * sums[k + 1]);
              }
            const double all = dim == 2 ? 2. * numbers::PI : 4. * numbers::PI;
            power *= all / (sums[3] * sums[3]);
            if (power > to["lobe_power"] || l == 2)
              {
                to["lobes"]      = l;
                to["lobe_power"] = power;
              }
          }
        to["free_area"] = sums[0] * Utilities::fixed_power<dim - 1>(h);
        to["radius_spread"] =
          std::sqrt(std::max(0., sums[4] / sums[2] / (radius * radius) - 1.));
        to["roundness"] =
          dim == 2 ? 4. * numbers::PI * sums[1] / (sums[0] * sums[0]) :
                     std::cbrt(36. * numbers::PI * sums[1] * sums[1]) / sums[0];
      }

      void
      tell_of_contacts(const Tissue<dim> &tissue, NamedNumbers &to) const
      {
        const Cells<dim> &cells = tissue.cells();
        const double      unit =
          Utilities::fixed_power<dim - 1>(tissue.grid().box().spacing());
        PointList<dim> told(1);
        for (unsigned int p = 0; p < cells.size(); ++p)
          told.add_value(cells.id(p), cells.position(p), cells[p].get(type));
        const NeighbourGraph<dim> graph = neighbours(tissue, told, search);
        RoundedSums               own(2, tissue.communicator());
        for (unsigned int p = 0; p < cells.size(); ++p)
          graph.for_neighbours(p, [&](const auto &e) {
            own.add(0, e.area / unit);
            if (graph.points.row(e.other)[0] != cells[p].get(type))
              own.add(1, e.area / unit);
          });
        const std::vector<double> sums = own.all();
        to["unlike_contacts"]          = sums[0] > 0. ? sums[1] / sums[0] : 0.;
      }

      const Column<unsigned int> type;
      const NeighbourSearch      search;
    };
  } // namespace


  void
  add_shape_numbers(Catalogue &catalogue)
  {
    catalogue.add_own<ShapeNumbers>("shape numbers", {"Shape/Numbers=true"});
  }
} // namespace Morula
