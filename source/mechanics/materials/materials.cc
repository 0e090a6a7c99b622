// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/materials/laws.h>
#include <morula/mechanics/materials/own_material.h>

#include <stdexcept>

namespace Morula
{
  namespace
  {
    template <typename... Law>
    void
    add_all(const Laws<Law...> &, Materials &materials)
    {
      // A fold over the types of the list: the position in it is the law's
      // number. The kernels are chosen by that, since their files see only the
      // list of laws.
      unsigned int i = 0;
      ((materials.add(Law::name,
                      std::make_shared<const MaterialOf<Law>>(
                        Law(),
                        available_vector_kernels<2>(i),
                        available_vector_kernels<3>(i))),
        ++i),
       ...);
    }
  } // namespace


  Materials::Materials()
  {
    add_all(OwnLaws(), *this);
  }


  void
  Materials::add(const std::string                     &name,
                 const std::shared_ptr<const Material> &material)
  {
    // Scenes choose a law by its name, so two of one name would hide each
    // other.
    if (find(name) != nullptr)
      throw std::invalid_argument("There is a material '" + name +
                                  "' already.");
    list.emplace_back(name, material);
  }


  std::shared_ptr<const Material>
  Materials::find(const std::string &name) const
  {
    for (const auto &[other, material] : list)
      if (other == name)
        return material;
    return nullptr;
  }


  std::vector<std::string>
  Materials::names() const
  {
    std::vector<std::string> names;
    for (const auto &entry : list)
      names.push_back(entry.first);
    return names;
  }
} // namespace Morula
