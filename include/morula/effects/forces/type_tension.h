// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_type_tension_h
#define morula_effects_forces_type_tension_h

#include <morula/effects/effect.h>
#include <morula/grid/bspline.h>
#include <morula/grid/grid_box.h>

#include <algorithm>
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
      "Rearrangement uses them, as where the grid is too coarse for them."};
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
                "An interface has one tension: remove one of the two keys.");
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
                "; set it for one of the two types. Negative: only for "
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

  /** Keys "Cell types/NAME/Tension/With surface". */
  struct TypeSurfaceTensionParameters : public EffectKeys
  {
    /** γ_a0 by type, kPa µm. */
    std::deque<Key<double>>  tensions;
    std::vector<std::string> types;
    /** Whether the tensions pull: `Tension/Force`. */
    bool pulls = true;

    bool
    is_on() const override
    {
      return pulls && std::any_of(tensions.begin(),
                                  tensions.end(),
                                  [](const auto &key) { return key != 0.; });
    }
    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.topic = "surfaces of types";
      return facts;
    }
    void
    declare_sections(const std::string &,
                     const std::vector<std::string> &names) override
    {
      types = names;
      // A type may be called "surface"; the tension with it has this path
      // then.
      if (std::find(names.begin(), names.end(), "surface") == names.end())
        for (const std::string &name : names)
          tensions.emplace_back(
            "Cell types/" + name + "/Tension/With surface",
            0.,
            "Tension of the free surface where cells of this type are nearest. "
            "Units: kPa um.");
    }
    void
    see(const SceneKeys                    &scene,
        const std::vector<ExpressionKey *> &of_cells) override;
    using Keys::list;
    KeyList
    list() override
    {
      KeyList list;
      for (Key<double> &key : tensions)
        list.push_back(&key);
      return list;
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
    TypeFractions(const GridBox<dim> &box, const unsigned int n_types)
      : box(box)
      , n_types(n_types)
    {}

    /** Adds a cell of volume @p V (µm^dim). Cells of one grid cell that follow
     *  one another cost least. */
    void
    add(const Point<dim> &x, const double V, const unsigned int type)
    {
      const GridIndex<dim> index = box.locate(x);
      if (!is_somewhere || index != here_index)
        {
          // A map keeps its entries where they are when it grows.
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            {
              Sums &of_spline = sums[center_of_spline(index, a)];
              of_spline.resize(1 + n_types, 0.);
              here[a] = &of_spline;
            }
          here_index   = index;
          is_somewhere = true;
        }
      ++counts[index];
      const SplineValues<dim> splines(box.unit_position(x, index),
                                      box.spacing());
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          const double weight = V * splines.value[a];
          (*here[a])[0] += weight;
          (*here[a])[1 + type] += weight;
        }
    }

    /** Those at a place whose grid cell holds a cell. */
    Values
    at(const Point<dim> &x) const
    {
      const GridIndex<dim>    index = box.locate(x);
      const SplineValues<dim> splines(box.unit_position(x, index),
                                      box.spacing());
      Values                  values{std::vector<double>(n_types, 0.),
                    std::vector<Tensor<1, dim>>(n_types)};
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          const auto found = sums.find(center_of_spline(index, a));
          // A spline that vanishes at all cells has no fraction, and no value.
          if (found == sums.end() || found->second[0] <= 0.)
            continue;
          for (unsigned int type = 0; type < n_types; ++type)
            {
              const double fraction =
                found->second[1 + type] / found->second[0];
              values.fraction[type] += fraction * splines.value[a];
              for (unsigned int d = 0; d < dim; ++d)
                values.gradient[type][d] += fraction * splines.gradient[d][a];
            }
        }
      return values;
    }

    /** Whether all @p n cells of a grid cell were added and no grid cell around
     *  it is empty, so that the tissue fills it. */
    bool
    is_filled_by(const unsigned int n, const GridIndex<dim> &index) const
    {
      const auto own = counts.find(index);
      if (own == counts.end() || own->second != n)
        return false;
      // The splines of a grid cell are centred in it and around it.
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        if (counts.count(center_of_spline(index, a)) == 0)
          return false;
      return true;
    }

    /** The largest fraction of each type on any spline. */
    std::vector<double>
    largest() const
    {
      std::vector<double> found(n_types, 0.);
      for (const auto &[center, of_spline] : sums)
        if (of_spline[0] > 0.)
          for (unsigned int type = 0; type < n_types; ++type)
            found[type] =
              std::max(found[type], of_spline[1 + type] / of_spline[0]);
      return found;
    }

    /** Adds the sums of another part of the tissue. */
    void
    add(const std::map<std::array<int, dim>, std::vector<double>> &other)
    {
      for (const auto &[center, more] : other)
        {
          Sums &of_spline = sums[center];
          of_spline.resize(1 + n_types, 0.);
          for (unsigned int k = 0; k <= n_types; ++k)
            of_spline[k] += more[k];
        }
    }

    /** Sums of a spline: of all cells, then of each type, µm^dim. */
    using Sums = std::vector<double>;
    /** Sums by the grid cell in which a spline is centred. */
    std::map<std::array<int, dim>, Sums> sums;
    /** How many cells a grid cell has. */
    std::map<std::array<int, dim>, unsigned int> counts;

  private:
    /** The grid cell in which spline @p a of a grid cell is centred. */
    static std::array<int, dim>
    center_of_spline(const GridIndex<dim> &index, const unsigned int a)
    {
      std::array<int, dim> center = index;
      for (unsigned int d = 0; d < dim; ++d)
        center[d] += BSpline<dim>::offset(a, d);
      return center;
    }

    GridBox<dim> box;
    unsigned int n_types;
    /** Where the sums of the splines of the last grid cell are. */
    std::array<Sums *, BSpline<dim>::n> here;
    GridIndex<dim>                      here_index;
    bool                                is_somewhere = false;
  };
} // namespace Morula

#endif
