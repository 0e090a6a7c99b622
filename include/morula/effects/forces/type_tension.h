// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_type_tension_h
#define morula_effects_forces_type_tension_h

#include <morula/effects/forces/force.h>

#include <deque>
#include <string>
#include <vector>

namespace Morula
{
  /** Keys "Cell types/NAME/Tension/With OTHER", and what is done by them. */
  struct TypeTensionParameters : public EffectKeys
  {
    TypeTensionParameters();

    Key<bool> force{
      {this, "Tension/Force"},
      true,
      "Whether the tensions between types pull at the tissue. false: only "
      "Rearrangement knows them, as where the grid is too coarse for "
      "them."};
    /** γ_ab, by (a, b) in the order of the types, without a = b; kPa µm. */
    std::deque<Key<double>>  between;
    std::vector<std::string> types;

    /** The tensions between types. @throws InputError if the two keys of a pair
     *  contradict each other */
    std::vector<std::vector<double>>
    matrix() const;

    /** Whether some interface has a tension. */
    bool
    any() const;

    bool
    is_on() const override
    {
      return force && any();
    }
    void
    check(const SceneKeys &, Review &) const override
    {
      matrix();
    }
    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.topic = "tension between types";
      return facts;
    }
    std::string
    details() const override;
    void
    declare_sections(const std::string              &names,
                     const std::vector<std::string> &types) override;
    using Keys::list;
    KeyList
    list() override;

  private:
    /** The key of type @p a with another one. */
    const Key<double> &
    key(const unsigned int a, const unsigned int b) const
    {
      return between[a * (types.size() - 1) + (b < a ? b : b - 1)];
    }
  };

  /** Tension of the interfaces between types of cells, from the gradients of
   *  the types' fractions: doc/theory.md (12.1)-(12.3). */
  template <int dim>
  class TypeTension : public Force<dim>
  {
  public:
    using Parameters = TypeTensionParameters;

    /** @throws InputError for a negative tension */
    TypeTension(const Parameters         &parameters,
                const EffectSetting<dim> &setting);

    std::unique_ptr<Term<dim>>
    term(const Tissue<dim>        &tissue,
         const CellReader<dim>    &reader,
         const GroupedPoints<dim> &positions,
         const double              t0,
         const double              t1) const override;

    /** Warns of types whose domains are too narrow for their tension to be
     *  felt, as the founders stand. */
    void
    review(const Preview<dim> &scene, Review &review) const override;

    /** ε of doc/theory.md (12.2) times h. */
    static constexpr double smoothing = 0.05;
    /** What it leaves of the tension of a flat interface, ∫ |g|²/√(|g|² + ε²)
     *  across the splines' profile, mean over places in a grid cell. */
    static constexpr double left_by_smoothing = 0.9706;

  private:
    const std::vector<std::vector<double>> tensions;
    const std::vector<std::string>         types;
  };
} // namespace Morula

#endif
