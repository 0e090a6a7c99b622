// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_type_tension_h
#define morula_effects_forces_type_tension_h

#include <morula/effects/effect.h>
#include <morula/grid/bspline.h>
#include <morula/grid/grid_box.h>

#include <array>
#include <deque>
#include <map>
#include <string>
#include <vector>

namespace Morula
{
  /** Keys "Cell types/NAME/Tension/With OTHER", and what is done by them. */
  struct TypeTensionParameters : public EffectKeys
  {
    /** ε of doc/theory.md (12.2) times h. */
    static constexpr double smoothing = 0.05;
    /** What it leaves of the tension of a flat interface, ∫ |g|²/√(|g|² + ε²)
     *  across the splines' profile, mean over places in a grid cell. */
    static constexpr double left_by_smoothing = 0.9706;

    TypeTensionParameters()
    {
      force.needs({"Rearrangement/Diffusion"});
    }

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
    matrix() const
    {
      const std::size_t                n = types.size();
      std::vector<std::vector<double>> gamma(n, std::vector<double>(n, 0.));
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = a + 1; b < n; ++b)
          {
            const Key<double> &one = key(a, b), &other = key(b, a);
            if (!one.is_default() && !other.is_default() &&
                one.value() != other.value())
              other.refuse(
                "the value of " + one.path() + ", " + one.text() + " kPa um",
                "An interface has one tension: remove one of the two "
                "keys.");
            gamma[a][b] = gamma[b][a] =
              one.is_default() ? other.value() : one.value();
          }
      return gamma;
    }

    /** Whether some interface has a tension. */
    bool
    any() const
    {
      return std::any_of(between.begin(), between.end(), [](const auto &key) {
        return key != 0.;
      });
    }

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
    details() const override
    {
      std::string text;
      for (unsigned int a = 0; a < types.size(); ++a)
        for (unsigned int b = 0; b < types.size(); ++b)
          if (a != b && !key(a, b).is_default())
            text += (text.empty() ? "" : ", ") + types[a] + " with " +
                    types[b] + " " + key(a, b).text() + " kPa um";
      return text + "; domains count from 2 h on";
    }
    void
    declare_sections(const std::string &,
                     const std::vector<std::string> &names) override
    {
      types = names;
      for (const std::string &name : names)
        for (const std::string &other : names)
          if (other != name)
            between.emplace_back(
              "Cell types/" + name + "/Tension/With " + other,
              0.,
              "Tension of the interface with cells of type " + other +
                "; one of the two types may say it. Negative: only for "
                "Rearrangement. Units: kPa um.");
    }
    using Keys::list;
    KeyList
    list() override
    {
      KeyList list{&force};
      for (Key<double> &key : between)
        list.push_back(&key);
      return list;
    }

  private:
    /** The key of type @p a with another one. */
    const Key<double> &
    key(const unsigned int a, const unsigned int b) const
    {
      return between[a * (types.size() - 1) + (b < a ? b : b - 1)];
    }
  };

  /**
   * The fractions of the types of cells as fields on the splines of the grid,
   * lumped: φ_i = Σ V N_i [type] / Σ V N_i, doc/theory.md (12.1). At each place
   * they add up to 1, also beside the surface.
   */
  template <int dim>
  class TypeFractions
  {
  public:
    /** The fractions at a place, by type. */
    struct Values
    {
      std::vector<double>         fraction;
      std::vector<Tensor<1, dim>> gradient; // 1/µm
    };

    /** @param box its spacing and grid lines count; copied */
    TypeFractions(const GridBox<dim> &box, const unsigned int n_types);

    /** Adds a cell of volume @p V (µm^dim). Cells of one grid cell that follow
     *  one another cost least. */
    void
    add(const Point<dim> &x, const double V, const unsigned int type);

    /** Those at a place whose grid cell holds a cell. */
    Values
    at(const Point<dim> &x) const;

    /** Whether all @p n cells of a grid cell were added and no grid cell around
     *  it is empty, so that the tissue fills it. */
    bool
    is_filled_by(const unsigned int n, const GridIndex<dim> &index) const;

    /** The largest fraction of each type on any spline. */
    std::vector<double>
    largest() const;

    /** Adds the sums of another part of the tissue. */
    void
    add(const TypeFractions &other);

    /** Sums of a spline: of all cells, then of each type, µm^dim. */
    using Sums = std::vector<double>;
    /** Sums by the grid cell in which a spline is centred. */
    std::map<std::array<int, dim>, Sums> sums;
    /** How many cells a grid cell has. */
    std::map<std::array<int, dim>, unsigned int> counts;

  private:
    GridBox<dim> box;
    unsigned int n_types;
    /** Where the sums of the splines of the last grid cell are. */
    std::array<Sums *, BSpline<dim>::n> here;
    GridIndex<dim>                      here_index;
    bool                                is_somewhere = false;
  };
} // namespace Morula

#endif
