// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/catalogue.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace Morula
{
  template <template <int> class Interface>
  std::string
  Choice<Interface>::section() const
  {
    std::string text = name_;
    text[0]          = std::toupper(static_cast<unsigned char>(text[0]));
    return text;
  }


  template <template <int> class Interface>
  Choice<Interface>
  Choice<Interface>::with_defaults() const
  {
    Choice copy(*this);
    copy.values = defaults();
    return copy;
  }


  template <template <int> class Interface>
  void
  Choice<Interface>::declare(ParameterHandler &prm)
  {
    prm.enter_subsection(section());
    declare_keys(values, prm);
    prm.leave_subsection();
  }


  template <template <int> class Interface>
  std::vector<ParameterKey>
  Choice<Interface>::keys() const
  {
    Choice           copy(*this);
    ParameterHandler prm;
    copy.declare_keys(copy.values, prm);
    const ParameterKeys declared(prm);
    return declared.list();
  }


  Catalogue
  Catalogue::with_defaults() const
  {
    Catalogue copy;
    for (const auto &law : growth_laws)
      copy.growth_laws.push_back(law.with_defaults());
    for (const auto &rule : division_rules)
      copy.division_rules.push_back(rule.with_defaults());
    return copy;
  }


  void
  Catalogue::check_name(const std::string &name) const
  {
    const bool plain =
      !name.empty() && std::all_of(name.begin(), name.end(), [](const char c) {
        return std::islower(static_cast<unsigned char>(c)) || c == ' ' ||
               c == '-';
      });
    if (!plain || name.front() == ' ' || name.back() == ' ')
      throw std::invalid_argument("'" + name +
                                  "' cannot name an effect: small letters, "
                                  "blanks and '-' may.");
    for (const char *own : {"none", "isotropic", "random", "fixed"})
      if (name == own)
        throw std::invalid_argument("'" + name + "' is Morula's own.");
    if (find_choice(growth_laws, name) != nullptr ||
        find_choice(division_rules, name) != nullptr)
      throw std::invalid_argument("There is an effect '" + name + "' already.");
  }


  template class Choice<GrowthLaw>;
  template class Choice<DivisionRule>;
} // namespace Morula
