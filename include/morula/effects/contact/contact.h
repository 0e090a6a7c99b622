// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_h
#define morula_effects_contact_contact_h

#include <morula/effects/contact/contact_parameters.h>
#include <morula/effects/interaction.h>

namespace Morula
{
  /** Bodies, or folds of a body, that touch, press on each other, slide and
   *  part again, or fuse in time: doc/theory.md, section 4.3a. */
  template <int dim>
  class Contact : public Interaction<dim>
  {
  public:
    using Parameters = ContactParameters;

    explicit Contact(const ContactParameters &keys)
      : keys(keys)
    {}

    bool
    takes_types_as_bodies() const override
    {
      return keys.bodies == "cell type";
    }

    bool
    acts_within_bodies() const override
    {
      return keys.is_of_all();
    }

    bool
    lets_equations_pass() const override
    {
      return keys.fields_pass;
    }

    void
    check_bodies(const std::vector<BodyMeasures> &bodies,
                 const SceneKeys                 &scene) const override;

    void
    review_bodies(const std::vector<BodyMeasures> &bodies,
                  std::vector<std::string>        &warnings) const override;

    std::string
    details_of_bodies(const std::vector<BodyMeasures> &bodies,
                      const double                     h) const override;

    std::unique_ptr<const Encounters<dim>>
    encounters(const Tissue<dim> &tissue,
               SplineSpace<dim>  &space) const override;

    bool
    fuses() const override
    {
      return keys.fusion_time > 0.;
    }

    Fusion
    fusion(Tissue<dim> &tissue, const double dt) const override;

  private:
    /** How far two points come nearer to each other in a step at most, µm: a
     *  fold that snaps shut moves farther, however short the step is. */
    double
    way(const double h) const
    {
      return keys.is_of_all() ? 2. * h : h;
    }

    const ContactParameters keys;
  };
} // namespace Morula

#endif
