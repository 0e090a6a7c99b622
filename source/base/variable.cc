// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/variable.h>

namespace Morula
{
  const char *
  name_of(const Variable variable)
  {
    // The order is that of the enumeration.
    constexpr std::array<const char *, n_variables> names = {
      {"X",        "Y",           "Z",
       "t",        "x",           "y",
       "z",        "generation",  "age",
       "type_age", "cycle_phase", "type",
       "volume",   "growth",      "J_e",
       "pressure", "tension",     "shear",
       "energy",   "depth",       "present_depth",
       "noise"}};
    return names[static_cast<unsigned int>(variable)];
  }


  std::string
  Vocabulary::name_of(const Variable variable) const
  {
    return is_field(variable) ? fields[field_number(variable)] :
                                Morula::name_of(variable);
  }


  std::vector<Variable>
  Vocabulary::all_variables() const
  {
    // Fields are variables with numbers behind all others.
    std::vector<Variable> all = variables;
    for (unsigned int k = 0; k < fields.size(); ++k)
      all.push_back(field_variable(k));
    return all;
  }


  std::string
  Vocabulary::names() const
  {
    std::string text;
    for (const Variable variable : all_variables())
      text += (text.empty() ? "" : ", ") + name_of(variable);
    for (const auto &[name, value] : constants)
      text += ", " + name;
    return text;
  }


  const Vocabulary &
  place_and_time()
  {
    static const Vocabulary vocabulary{
      {Variable::X, Variable::Y, Variable::Z, Variable::t}};
    return vocabulary;
  }
} // namespace Morula
