// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/name_list.h>
#include <morula/effects/fields/field.h>
#include <morula/effects/scene_keys.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <cmath>
#include <exception>
#include <optional>

namespace Morula
{
  namespace
  {
    /** Columns of tables have such names. */
    std::string
    reason_against_field(const std::string &name)
    {
      // Small letters are told from others here; what else a name may not be,
      // the variables know.
      const bool small =
        std::none_of(name.begin(), name.end(), [](const char c) {
          return std::isupper(static_cast<unsigned char>(c));
        });
      return small ? reason_against_variable(name) :
                     "Names of fields have small letters, digits and '_', and "
                     "begin with a letter.";
    }
  } // namespace


  FieldKeys::FieldKeys(const std::string &name)
    : name(name)
  {
    // The keys stand in the section of the field's name.
    place_in(list(), "Fields/" + name);
    dilution.needs({time.path() + "=transient"});
  }


  void
  FieldKeys::check(const unsigned int dim) const
  {
    // Diffusion has no default that would fit any field, so it must be said.
    if (diffusion.empty())
      diffusion.refuse("an expression > 0 um^2/day",
                       "Each field needs one; oxygen has about 1.7e8.");
    check_each(dim);
    // A flux and its place belong together.
    if (flux.empty() != flux_where.empty())
      {
        const ExpressionKey &lone = flux.empty() ? flux_where : flux;
        const ExpressionKey &none = flux.empty() ? flux : flux_where;
        lone.refuse("nothing, as " + none.path() + " is empty",
                    "Set both of them, or none.");
      }
    if (!value.is_default() && !has_value())
      value.refuse("its default, as neither " + fixed_where.path() + " nor " +
                     transfer.path() + " is set",
                   "Set one of them, or remove this key.");
    if (exchanged && is_steady())
      exchanged.refuse("false, as " + time.path() + " = steady",
                       "A steady field follows the places of the cells by "
                       "itself: remove this key, or set " +
                         time.path() + " = transient.");
    // A steady field needs a sink. Only a plain number can be judged here; of
    // other rates, the solver finds that out.
    if (is_steady() && !has_value() &&
        consumption.largest_number(dim).value_or(1.) == 0.)
      consumption.refuse(
        "a rate > 0 1/day for a steady field that is fixed nowhere at the surface",
        "Without a sink any constant could be added to the field: set this "
        "key, or " +
          fixed_where.path() + ", or " + transfer.path() + ", or " +
          time.path() + " = transient.");
  }


  EffectFacts
  FieldsParameters::facts() const
  {
    EffectFacts facts;
    facts.names_key = &names;
    for (const FieldKeys &field : fields)
      {
        facts.needs_surface = facts.needs_surface || field.has_surface();
        facts.fields.push_back({field.name, field.exchanged});
        for (const ExpressionKey *where :
             {&field.fixed_where, &field.flux_where})
          if (!where->empty())
            facts.places.push_back(where);
      }
    return facts;
  }


  void
  FieldsParameters::check(const SceneKeys &scene, Review &) const
  {
    for (const FieldKeys &field : fields)
      field.check(scene.dimension);
    if (facts().needs_surface && scene.tissue.has_no_surface())
      names.refuse("fields that nothing is done to at the surface, as " +
                     scene.tissue.points_surface.path() + " = none",
                   "Remove their Fixed where, Transfer and Flux where, or set "
                   "Points surface = automatic.");
  }


  void
  FieldsParameters::declare_sections(const std::string &text,
                                     const std::vector<std::string> &)
  {
    // Names become variables of expressions and columns of tables, so they must
    // be free for both.
    for (const std::string &name :
         declared_names(names, text, reason_against_field))
      fields.emplace_back(name);
    if (fields.size() > most_fields)
      throw InputError(names.path(),
                       text,
                       "at most " + std::to_string(most_fields) + " names",
                       "There are " + std::to_string(fields.size()) + ".");
  }


  KeyList
  FieldsParameters::list()
  {
    return keys_of_all(names, fields);
  }


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
      double fixed = 0., flux = 0.;
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
          points.fixed += fixed;
          points.flux += !fixed && holds(field.flux_where, X);
        }
      return {Utilities::MPI::sum(points.fixed, scene.comm),
              Utilities::MPI::sum(points.flux, scene.comm)};
    }

    /** Few points carry a value or a flux: what they cover jumps by patches. */
    void
    review_places(const FieldKeys     &field,
                  const PointsOfField &points,
                  Review              &review)
    {
      const auto review_place = [&](const AnyKey &key, const double number) {
        if (number > 0. && number < 10.)
          review.warn(key.path(),
                      key.text(),
                      "it acts on " + as_text(number) +
                        " boundary points: with so few, what it covers jumps "
                        "by a whole patch.",
                      "Choose a larger place, or a smaller Tissue/Cell "
                      "spacing.");
      };
      review_place(field.fixed_where, points.fixed);
      review_place(field.flux_where, points.flux);
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
                    "Correct the unit, or leave it if that is meant.");
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
        review_places(field, points, review);
        review_reach(field, points, scene, review);
      }
  }


  MORULA_INSTANTIATE(review_fields);
} // namespace Morula
