// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/name_list.h>
#include <morula/effects/fields/field_parameters.h>
#include <morula/effects/scene_keys.h>

#include <algorithm>
#include <cctype>
#include <iomanip>
#include <sstream>

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
        "a rate > 0 1/day for a steady field that nothing holds at the surface",
        "Without a sink any constant could be added to the field: set this "
        "key, or " +
          fixed_where.path() + ", or " + transfer.path() + ", or " +
          time.path() + " = transient.");
  }


  std::string
  FieldKeys::details() const
  {
    std::string text = time + ", D = " + diffusion.text() +
                       " um^2/day, s = " + production.text() +
                       ", k = " + consumption.text() + " /day";
    if (!fixed_where.empty())
      text +=
        ", " + value.text() + " at boundary points where " + fixed_where.text();
    if (!transfer.empty())
      text += ", transfer " + transfer.text() + " um/day to " + value.text();
    if (!flux_where.empty())
      text += ", flux " + flux.text() + " um/day in at boundary points where " +
              flux_where.text();
    return text;
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


  std::string
  FieldsParameters::details() const
  {
    std::ostringstream out;
    out << names.value();
    for (const FieldKeys &field : fields)
      out << "\n    " << std::left << std::setw(22) << field.name
          << field.details();
    return out.str();
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
} // namespace Morula
