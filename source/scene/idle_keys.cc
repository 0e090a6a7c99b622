// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/division_by_size.h>
#include <morula/scene/checks.h>
#include <morula/scene/idle_founders.h>
#include <morula/scene/idle_keys.h>
#include <morula/scene/idle_rates.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Whether a key has another value than its default, for any type. */
    bool
    differs(const AnyKey &key)
    {
      const auto *const expression = dynamic_cast<const ExpressionKey *>(&key);
      return !key.is_default() ||
             (expression != nullptr && expression->differs_by_type());
    }

    /** Keys of which the first does nothing without any of the others. */
    const std::vector<std::vector<std::string>> needs = {
      {"Material/Yield stress", "Material/Relaxation time"},
      {"Material/Relaxation passes", "Material/Yield stress"},
      {"Growth/Rate/Homeostatic stress", "Growth/Rate/Homeostasis"},
      {"Growth/Rate/Share along", "Growth/Rate/Direction"},
      {"Growth/Rate/Direction", "Growth/Rate/Share along"},
      {"Boundary conditions/Surface tension where",
       "Boundary conditions/Surface tension"},
      {"Boundary conditions/Nitsche penalty",
       "Boundary conditions/Fixed where",
       "Boundary conditions/Slip where"},
      {"Boundary conditions/Nitsche form",
       "Boundary conditions/Fixed where",
       "Boundary conditions/Slip where"},
      {"Contact/Bodies", "Contact/Between"},
      {"Contact/Stiffness", "Contact/Between"},
      {"Contact/Friction", "Contact/Between"},
      {"Contact/Fusion time", "Contact/Between"},
      {"Contact/Fields pass", "Contact/Between"}};

    void
    review_needs(const Scene &scene, Review &review)
    {
      const auto list = scene.list();
      const auto find = [&](const std::string &path) -> const AnyKey * {
        for (const AnyKey *key : list)
          if (key->path() == path)
            return key;
        return nullptr;
      };
      for (const auto &paths : needs)
        {
          const AnyKey *const key = find(paths[0]);
          if (key == nullptr || !differs(*key))
            continue;
          // Where all have the default, a type has a value of its own.
          const AnyKey *said = key;
          for (const CellTypeKeys &type : scene.cell_types.types)
            for (const ExpressionKey &own : type.overrides)
              if (key->is_default() && !own.empty() &&
                  own.path() == type.path_of(*key))
                said = &own;
          if (said == key && !review.has_set(*key))
            continue;
          std::string missing;
          for (std::size_t i = 1; i < paths.size(); ++i)
            if (const AnyKey *const other = find(paths[i]);
                other == nullptr || differs(*other))
              missing = "none";
            else if (missing != "none")
              missing += (missing.empty() ? "" : " and ") + paths[i];
          if (missing != "none")
            review.warn(said->path(),
                        said->text(),
                        "it does nothing without " + missing + '.',
                        "Set this key as well, or remove the other.");
        }
    }

    /** Numbers of Time that leave nothing to do. */
    void
    review_time(const Scene                &scene,
                const types::particle_index n_founders,
                Review                     &review)
    {
      const double end = scene.time.end_time;
      if (scene.time.step > (1. + 1e-9) * end)
        review.warn(scene.time.step.path(),
                    as_text(scene.time.step) + " day",
                    "it is longer than the run, which ends at " + as_text(end) +
                      " day: there is one step of that length.",
                    "Shorten the step, or raise Time/End time.");
      if (review.has_set(scene.output.interval) &&
          scene.output.interval > (1. + 1e-9) * end)
        review.warn(scene.output.interval.path(),
                    as_text(scene.output.interval) + " day",
                    "it is longer than the run, which ends at " + as_text(end) +
                      " day: only its begin and its end are written.",
                    "Lower it, or set it to 0 if that is meant.");
      if (end > 365.)
        review.warn(scene.time.end_time.path(),
                    as_text(end) + " day",
                    "that is more than a year. Is it in hours or seconds?",
                    "If it is meant so, all is well.");
      if (scene.time.stop_at_cells > 0 &&
          n_founders >= scene.time.stop_at_cells)
        review.warn(scene.time.stop_at_cells.path(),
                    scene.time.stop_at_cells.text(),
                    "the tissue begins with " + std::to_string(n_founders) +
                      " cells: the run ends at its first step.",
                    "Raise it, or set it to 0 for a run to the end.");
    }

    /** Types that no cell has, and none can get. */
    void
    review_types(const Scene                              &scene,
                 const std::vector<types::particle_index> &n_founders,
                 Review                                   &review)
    {
      // A type is reached by transitions from a type that is reached, and by
      // divisions. Whether its cells divide is not asked.
      const auto            &types = scene.cell_types.types;
      std::set<unsigned int> reached, open;
      for (unsigned int i = 0; i < types.size(); ++i)
        if (n_founders[i] > 0)
          open.insert(i);
      while (!open.empty())
        {
          const unsigned int i = *open.begin();
          open.erase(open.begin());
          reached.insert(i);
          std::set<std::string> names;
          for (const ExpressionKey &to : types[i].transitions)
            if (differs(to))
              names.insert(to.path().substr(to.path().rfind(" ") + 1));
          if (scene.has_proliferation() || scene.divides_by_fate())
            {
              const auto [one, other] = scene.cell_types.daughters(i);
              names.insert({types[one].name, types[other].name});
            }
          for (unsigned int j = 0; j < types.size(); ++j)
            if (names.count(types[j].name) > 0 && reached.count(j) == 0)
              open.insert(j);
        }
      for (unsigned int i = 0; i < types.size(); ++i)
        {
          if (reached.count(i) == 0)
            review.warn(scene.cell_types.names.path(),
                        types[i].name,
                        "no founder is of this type, and no transition or "
                        "division leads to it.",
                        "Say where it is by Where, or remove it.");
          if (!types[i].daughters.empty() && !scene.has_proliferation() &&
              !scene.divides_by_fate())
            review.warn(types[i].daughters.path(),
                        types[i].daughters.value(),
                        "no cell divides.",
                        "Set " + scene.proliferation_law.path() +
                          ", or remove this key.");
        }
    }

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

    /** Founders of the first type at which its own Where does not hold: those
     *  that no other type takes are of the first one. Collective. */
    template <int dim>
    void
    review_first_type(const Scene         &scene,
                      const Founders<dim> &founders,
                      const MPI_Comm       comm,
                      Review              &review)
    {
      const auto          &types = scene.cell_types.types;
      const ExpressionKey &where = types.front().where;
      if (where.empty() || !founders.types.empty())
        return;
      const auto holds = [](const ExpressionKey &key, const Point<dim> &X) {
        return !key.empty() && key.expression(dim).value(X, 0.) > 0.;
      };
      types::particle_index n = 0;
      for (const Point<dim> &X : founders.positions)
        n += std::none_of(types.begin(), types.end(), [&](const auto &type) {
          return holds(type.where, X);
        });
      if (n = Utilities::MPI::sum(n, comm); n > 0)
        review.warn(where.path(),
                    where.text(),
                    "it does not hold at " + std::to_string(n) +
                      " founders for which no other type's Where holds: they "
                      "are of this type all the same, as it is the first.",
                    "Name the type of the others first in " +
                      scene.cell_types.names.path() + ", or remove this key.");
    }

    /** Fields that stay zero, conditions that others leave nothing to, and
     *  fields that hardly reach into the tissue. */
    template <int dim>
    void
    review_field(const FieldKeys           &field,
                 const std::vector<double> &points,
                 const double               cell,
                 const double               h,
                 Review                    &review)
    {
      const double n = points[0], n_fixed = points[1], n_flux = points[2];
      const bool   steady  = field.time == "steady";
      const auto   is_zero = [](const ExpressionKey &key) {
        return key.empty() ||
               (!key.differs_by_type() && key.expression(dim).is_always(0.));
      };
      const bool reads_value = n_fixed > 0. || !field.transfer.empty();
      if (is_zero(field.production) &&
          (!reads_value || is_zero(field.value) ||
           (n_fixed == 0. && is_zero(field.transfer))) &&
          (n_flux == 0. || is_zero(field.flux)) &&
          (steady || is_zero(field.initial)))
        review.warn("Fields/" + field.name,
                    steady ? "steady" : "transient",
                    "it is 0 everywhere: no cell makes it, and nothing comes "
                    "in through the surface" +
                      std::string(steady && !is_zero(field.initial) ?
                                    "; Initial is only where the steady "
                                    "state is sought first." :
                                    "."),
                    "Set its Production, or its Value at the surface, or its "
                    "Flux.");
      if (n > 0. && n_fixed == n && !field.transfer.empty())
        review.warn(field.transfer.path(),
                    field.transfer.text(),
                    "it does nothing, as Fixed where holds at all boundary "
                    "points.",
                    "Remove one of them.");
      // Few points carry a value or a flux: what they cover jumps by patches.
      for (const auto &[key, number] :
           {std::make_pair(&field.fixed_where, n_fixed),
            std::make_pair(&field.flux_where, n_flux)})
        if (number > 0. && number < 10.)
          review.warn(key->path(),
                      key->text(),
                      "it acts on " + as_text(number) +
                        " boundary points: with so few, what it covers jumps "
                        "by a whole patch.",
                      "Choose a larger place, or a smaller Tissue/Cell "
                      "spacing.");
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
      if (!reads_value || !D || !k || !(*k > 0.))
        return;
      const double      reach = std::sqrt(*D / *k);
      const std::string what =
        "the field reaches only " + as_text(reach) +
        " um into the tissue, the root of Diffusion over Consumption";
      if (reach < 0.2 * cell)
        review.warn(field.diffusion.path(),
                    field.diffusion.text(),
                    what + ", and a cell is " + as_text(cell) +
                      " um long. Is Diffusion in um^2/day (1 um^2/s is 86400 "
                      "of it), Consumption in 1/day?",
                    "If it is meant so, all is well.");
      else if (const double wrong = excess_at_fixed_values(reach / h);
               n_fixed > 0. && wrong > 0.)
        review.warn(field.diffusion.path(),
                    field.diffusion.text(),
                    what +
                      ", less than half a grid spacing: what comes in at "
                      "fixed values may be too much by " +
                      as_text(std::round(100. * wrong)) +
                      " %, as the grid lines lie.",
                    "Choose Grid/Spacing below " + as_text(2. * reach) +
                      " um, or one that the accuracy allows.");
      else if (n_fixed == 0. && reach < 0.2 * h)
        review.warn(field.diffusion.path(),
                    field.diffusion.text(),
                    what + ": less than a fifth of a grid spacing, what comes "
                           "in is wrong by a tenth and more.",
                    "Choose Grid/Spacing below " + as_text(5. * reach) +
                      " um.");
    }
  } // namespace


  template <int dim>
  void
  review_idle_keys(const Scene               &scene,
                   const Founders<dim>       &founders,
                   const SurfacePatches<dim> &surface,
                   const MPI_Comm             comm,
                   Review                    &review)
  {
    // What keys alone tell comes first, then what founders and the surface of
    // all ranks tell. The sums are collective, and all ranks go through the
    // same lists.
    review_needs(scene, review);
    review_time(scene, founders.n_global, review);
    review_idle_rates(scene, founders, comm, review);
    review_idle_founders(scene, founders, comm, review);
    if (scene.cell_types.present())
      {
        review_types(scene,
                     founders_of_types<dim>(
                       scene, founders.positions, comm, founders.types),
                     review);
        review_first_type(scene, founders, comm, review);
      }
    double volume = 0., largest = 0.;
    for (const double V : founders.volumes)
      {
        volume += V;
        largest = std::max(largest, V);
      }
    volume  = Utilities::MPI::sum(volume, comm) / founders.n_global;
    largest = Utilities::MPI::max(largest, comm);

    for (std::size_t k = 0; k < scene.fields.fields.size(); ++k)
      {
        const FieldKeys    &field = scene.fields.fields[k];
        std::vector<double> points(3, 0.);
        const auto          holds = [&](const ExpressionKey &where,
                               const Point<dim>    &X) {
          return !where.empty() && where.expression(dim).value(X, 0.) > 0.;
        };
        for (const Point<dim> &X : surface.positions)
          {
            const bool fixed = holds(field.fixed_where, X);
            points[0] += 1.;
            points[1] += fixed;
            points[2] += !fixed && holds(field.flux_where, X);
          }
        Utilities::MPI::sum(points, comm, points);
        review_field<dim>(field,
                          points,
                          std::pow(volume, 1. / dim),
                          scene.grid.spacing,
                          review);
      }

    if (!scene.divides_by_fate())
      return;
    const auto &size = scene.keys<DivisionBySizeParameters>().volume;
    if (const auto at = size.largest_number(dim);
        at && *at > 0. && *at <= (1. + 1e-9) * largest)
      review.warn(size.path(),
                  size.text(),
                  "founders have up to " + as_text(largest) +
                    (dim == 3 ? " um^3" : " um^2") +
                    " and divide at once, until they are smaller.",
                  "Choose a volume above that of the founders, such as twice "
                  "as much.");
  }


#define INSTANTIATE(dim)                                      \
  template void review_idle_keys(const Scene &,               \
                                 const Founders<dim> &,       \
                                 const SurfacePatches<dim> &, \
                                 const MPI_Comm,              \
                                 Review &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
