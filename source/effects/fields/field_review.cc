// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/fields/field_parameters.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <cmath>
#include <exception>
#include <optional>
#include <string>

namespace Morula
{
  namespace
  {
    /** By what part too much of a field may come in at fixed values, at the
     *  worst offset of the grid, if it falls off within @p reach grid spacings:
     *  measured on slabs, and held to by tests/programs/field_layers.py. */
    double
    excess_at_fixed_values(const double reach)
    {
      constexpr std::array<std::array<double, 2>, 7> excess = {{{{0.1, 0.28}},
                                                                {{0.15, 0.28}},
                                                                {{0.2, 0.225}},
                                                                {{0.25, 0.17}},
                                                                {{0.3, 0.125}},
                                                                {{0.4, 0.07}},
                                                                {{0.5, 0.04}}}};
      if (reach >= excess.back()[0])
        return 0.;
      if (reach <= excess.front()[0])
        return excess.front()[1];
      unsigned int i = 1;
      while (excess[i][0] < reach)
        ++i;
      const auto &[x0, y0] = excess[i - 1];
      const auto &[x1, y1] = excess[i];
      return y0 + (y1 - y0) * (reach - x0) / (x1 - x0);
    }

    /** How many boundary points of all ranks a field has, is fixed at, and has
     *  a flux at. */
    struct PointsOfField
    {
      double all = 0., fixed = 0., flux = 0.;
    };

    template <int dim>
    PointsOfField
    points_of(const FieldKeys &field, const Preview<dim> &scene)
    {
      const auto holds = [](const ExpressionKey &where, const Point<dim> &X) {
        return !where.empty() && where.expression(dim).value(X, 0.) > 0.;
      };
      PointsOfField points;
      for (const Point<dim> &X : scene.boundary_points)
        {
          const bool fixed = holds(field.fixed_where, X);
          points.all += 1.;
          points.fixed += fixed;
          points.flux += !fixed && holds(field.flux_where, X);
        }
      return {Utilities::MPI::sum(points.all, scene.comm),
              Utilities::MPI::sum(points.fixed, scene.comm),
              Utilities::MPI::sum(points.flux, scene.comm)};
    }

    bool
    is_zero(const ExpressionKey &key, const unsigned int dim)
    {
      return key.empty() ||
             (!key.differs_by_type() && key.expression(dim).is_always(0.));
    }

    /** Fields that nothing makes, and keys that nothing reads. */
    template <int dim>
    void
    review_sources(const FieldKeys     &field,
                   const PointsOfField &points,
                   Review              &review)
    {
      const bool steady = field.is_steady();
      if (steady)
        review.warn_of_idle(field.dilution,
                            "a steady field is not diluted",
                            "Set " + field.time.path() +
                              " = transient, or remove this key.");
      const bool reads_value = points.fixed > 0. || !field.transfer.empty();
      if (is_zero(field.production, dim) &&
          (!reads_value || is_zero(field.value, dim) ||
           (points.fixed == 0. && is_zero(field.transfer, dim))) &&
          (points.flux == 0. || is_zero(field.flux, dim)) &&
          (steady || is_zero(field.initial, dim)))
        review.warn("Fields/" + field.name,
                    steady ? "steady" : "transient",
                    "it is 0 everywhere: no cell makes it, and nothing comes "
                    "in through the surface" +
                      std::string(steady && !is_zero(field.initial, dim) ?
                                    "; Initial is only where the steady "
                                    "state is sought first." :
                                    "."),
                    "Set its Production, or its Value at the surface, or its "
                    "Flux.");
      if (points.all > 0. && points.fixed == points.all &&
          !field.transfer.empty())
        review.warn(field.transfer.path(),
                    field.transfer.text(),
                    "it does nothing, as Fixed where holds at all boundary "
                    "points.",
                    "Remove one of them.");
      // Few points carry a value or a flux: what they cover jumps by patches.
      for (const auto &[key, number] :
           {std::make_pair(&field.fixed_where, points.fixed),
            std::make_pair(&field.flux_where, points.flux)})
        if (number > 0. && number < 10.)
          review.warn(key->path(),
                      key->text(),
                      "it acts on " + as_text(number) +
                        " boundary points: with so few, what it covers jumps "
                        "by a whole patch.",
                      "Choose a larger place, or a smaller Tissue/Cell "
                      "spacing.");
    }

    /** The length on which a field falls off that comes in through the surface,
     *  µm: the root of Diffusion over Consumption; nothing where these are no
     *  plain numbers. */
    std::optional<double>
    reach_of(const FieldKeys &field, const unsigned int dim)
    {
      const auto D = field.diffusion.largest_number(dim);
      auto       k = field.consumption.largest_number(dim);
      // Uptake that depends on the field is taken for its value at the surface.
      if (!k && !field.value.empty())
        try
          {
            VariableValues values;
            values.fill(field.value.largest_number(dim).value_or(1.));
            k = field.consumption.expression(dim).value(values);
          }
        catch (const std::exception &)
          {}
      if (!D || !k || !(*k > 0.))
        return {};
      return std::sqrt(*D / *k);
    }

    /** Fields that hardly get into the tissue, beside a cell and beside the
     *  grid. */
    template <int dim>
    void
    review_reach(const FieldKeys     &field,
                 const PointsOfField &points,
                 const Preview<dim>  &scene,
                 Review              &review)
    {
      const std::optional<double> reach = reach_of(field, dim);
      if ((points.fixed == 0. && field.transfer.empty()) || !reach)
        return;
      const double      cell = std::pow(scene.mean_volume, 1. / dim);
      const double      h    = scene.keys.grid.spacing;
      const std::string what =
        "the field reaches only " + as_text(*reach) +
        " um into the tissue, the root of Diffusion over Consumption";
      if (*reach < 0.2 * cell)
        review.warn(field.diffusion.path(),
                    field.diffusion.text(),
                    what + ", and a cell is " + as_text(cell) +
                      " um long. Is Diffusion in um^2/day (1 um^2/s is 86400 "
                      "of it), Consumption in 1/day?",
                    "If it is meant so, all is well.");
      else if (const double wrong = excess_at_fixed_values(*reach / h);
               points.fixed > 0. && wrong > 0.)
        review.warn(field.diffusion.path(),
                    field.diffusion.text(),
                    what +
                      ", less than half a grid spacing: what comes in at "
                      "fixed values may be too much by " +
                      as_text(std::round(100. * wrong)) +
                      " %, as the grid lines lie.",
                    "Choose Grid/Spacing below " + as_text(2. * *reach) +
                      " um, or one that the accuracy allows.");
      else if (points.fixed == 0. && *reach < 0.2 * h)
        review.warn(field.diffusion.path(),
                    field.diffusion.text(),
                    what + ": less than a fifth of a grid spacing, what comes "
                           "in is wrong by a tenth and more.",
                    "Choose Grid/Spacing below " + as_text(5. * *reach) +
                      " um.");
    }
  } // namespace


  template <int dim>
  void
  review_fields(const FieldsParameters &parameters,
                const Preview<dim>     &scene,
                Review                 &review)
  {
    // The numbers of points are collective, so all ranks count for all fields.
    for (const FieldKeys &field : parameters.fields)
      {
        const PointsOfField points = points_of(field, scene);
        review_sources<dim>(field, points, review);
        review_reach(field, points, scene, review);
      }
  }


  MORULA_INSTANTIATE(review_fields);
} // namespace Morula
