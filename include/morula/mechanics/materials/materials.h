// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_materials_h
#define morula_mechanics_materials_materials_h

#include <morula/mechanics/materials/material.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** The materials that a scene can choose from, by the name of their law.
   *  Copies share the materials, which nobody can change. */
  class Materials
  {
  public:
    /** The library's own. */
    Materials();

    /**
     * Adds one. The header own_material.h makes it from a law, with kernels:
     * materials.add("soft", own_material(Soft())).
     * @param name value of Material/Law
     * @throws std::invalid_argument for a name that is in use
     */
    void
    add(const std::string                     &name,
        const std::shared_ptr<const Material> &material);

    /** The material of this name, or null. */
    std::shared_ptr<const Material>
    find(const std::string &name) const;

    /** All names, in the order of the list. */
    std::vector<std::string>
    names() const;

  private:
    std::vector<std::pair<std::string, std::shared_ptr<const Material>>> list;
  };
} // namespace Morula

#endif
