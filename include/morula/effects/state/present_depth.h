// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_present_depth_h
#define morula_effects_state_present_depth_h

#include <morula/effects/step_effect.h>

#include <string>
#include <vector>

namespace Morula
{
  /** What expressions of cells say of `present_depth`; there are no keys. */
  struct PresentDepthParameters : public EffectKeys
  {
    bool is_used = false;

    bool
    is_on() const override
    {
      return is_used;
    }

    void
    see(const SceneKeys                    &scene,
        const std::vector<ExpressionKey *> &keys) override;

    using Keys::list;
    KeyList
    list() override
    {
      return {};
    }
  };

  /** Sets the variable `present_depth` of all cells: their distance from the
   *  surface as it is now. */
  template <int dim>
  class PresentDepth : public StepEffect<dim>
  {
  public:
    using Parameters = PresentDepthParameters;

    explicit PresentDepth(const Parameters &) {}

    void
    surfaced(Tissue<dim>            &tissue,
             const MomentOfRun<dim> &moment) const override;
  };
} // namespace Morula

#endif
