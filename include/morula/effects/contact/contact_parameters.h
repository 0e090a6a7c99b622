// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_parameters_h
#define morula_effects_contact_contact_parameters_h

#include <morula/effects/effect.h>

#include <string>

namespace Morula
{
  /** Section "Contact": bodies that meet. */
  struct ContactParameters : public EffectKeys
  {
    ContactParameters();

    Key<std::string> between;
    Key<std::string> bodies;
    Key<double>      stiffness;   // κ h / E
    Key<double>      friction;    // ζ, kPa day/µm
    Key<double>      fusion_time; // day
    Key<bool>        fields_pass;

    /** Whether bodies have contact with each other. */
    bool
    is_on() const override;

    /** Whether a body can touch itself, too. */
    bool
    is_of_all() const;

    /** Bodies touch by their surfaces. */
    bool
    needs_surface() const override
    {
      return true;
    }

    void
    check_with(const RestOfScene &scene) const override;

    using Keys::list;
    KeyList
    list() override;
  };
} // namespace Morula

#endif
