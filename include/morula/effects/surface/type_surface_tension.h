// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_type_surface_tension_h
#define morula_effects_surface_type_surface_tension_h

#include <morula/effects/surface/boundary_condition.h>

#include <deque>
#include <string>
#include <vector>

namespace Morula
{
  /** Keys "Cell types/NAME/Tension/With surface". */
  struct TypeSurfaceTensionParameters : public EffectKeys
  {
    /** γ_a0 by type, kPa µm. */
    std::deque<Key<double>>  tensions;
    std::vector<std::string> types;
    /** Whether the tensions pull: `Tension/Force`. */
    bool pulls = true;

    bool
    is_on() const override;
    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.topic = "surfaces of types";
      return facts;
    }
    std::string
    details() const override;
    void
    declare_sections(const std::string              &names,
                     const std::vector<std::string> &types) override;
    void
    see(const SceneKeys                    &scene,
        const std::vector<ExpressionKey *> &of_cells) override;
    using Keys::list;
    KeyList
    list() override;
  };

  /** Tension of the free surface by the type of the cell there, with the energy
   *  of doc/theory.md (4.8a): a boundary point has that of the nearest cell. */
  template <int dim>
  class TypeSurfaceTension : public BoundaryCondition<dim>
  {
  public:
    using Parameters = TypeSurfaceTensionParameters;

    /** @throws InputError for a negative tension */
    TypeSurfaceTension(const Parameters         &parameters,
                       const EffectSetting<dim> &setting);

    SurfaceCondition
    kind() const override
    {
      return SurfaceCondition::loaded;
    }
    bool
    is_tension() const override
    {
      return true;
    }
    bool
    acts_on(const Point<dim> &, const Tensor<1, dim> &) const override
    {
      return true;
    }
    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override;

  private:
    std::vector<double>  tensions; // by type
    Column<unsigned int> type;
  };
} // namespace Morula

#endif
