// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_field_review_h
#define morula_effects_fields_field_review_h

#include <morula/effects/effect.h>
#include <morula/effects/fields/field_parameters.h>

namespace Morula
{
  /** Warns of fields that stay zero, of conditions that others leave nothing to
   *  or that act on few points, and of fields that hardly reach into the
   *  tissue. Collective. */
  template <int dim>
  void
  review_fields(const FieldsParameters &parameters,
                const Preview<dim>     &scene,
                Review                 &review);
} // namespace Morula

#endif
