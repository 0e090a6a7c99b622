// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_scene_h
#define morula_scene_scene_h

#include <morula/base/time_parameters.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/development.h>
#include <morula/effects/division/division_parameters.h>
#include <morula/effects/fate/cell_type_parameters.h>
#include <morula/effects/rest_of_scene.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/grid/grid_parameters.h>
#include <morula/mechanics/material.h>
#include <morula/output/output_parameters.h>
#include <morula/seeding/seeding.h>
#include <morula/solver/solver_parameters.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace Morula
{
  /**
   * Everything a .prm file says. Each section has a struct of keys in the room
   * it belongs to; the scene holds them all and checks them against each other.
   */
  struct Scene : public Keys
  {
    /** @param catalogue effects that the scene may have, with their defaults */
    explicit Scene(const Catalogue &catalogue = Catalogue());

    /**
     * One word that sets several keys: it changes their defaults
     * (AnyKey::texts_by_method()). A key that the scene sets itself keeps
     * the scene's value. doc/accuracy-and-cost.md says why it is these keys.
     */
    Key<std::string>  method;
    Key<unsigned int> dimension;
    Key<std::string>  output_directory; // read() fills in what is empty
    Key<unsigned int> random_seed;

    TimeParameters      time;
    TissueParameters    tissue;
    GridParameters      grid;
    MaterialParameters  material;
    Key<std::string>    growth_law;
    DivisionParameters  division;
    CellTypesParameters cell_types;
    NitscheParameters   nitsche;
    SolverParameters    solver;
    OutputParameters    output;

    /** The effects, with the values of their keys. */
    Catalogue catalogue;

    /**
     * The values of the keys as the file and the overrides wrote them, by full
     * path; what is missing has its default. It tells check() whether an effect
     * was switched off or forgotten.
     */
    std::map<std::string, std::string> as_written;

    /** The places where keys were written, "file:line: " or "-s: ", by full
     * path.
     */
    std::map<std::string, std::string> places;

    /** The file that read() has read; empty if there is none. */
    std::string file;

    /** Whether the run may delete any run that it finds in its directory. */
    bool replace = false;

    /** What to say about keys that were written by a former name, or set twice.
     */
    std::vector<std::string> renamed;

    /** The growth law of all types of cells that grow; "none" if there is none.
     */
    std::string
    law_of_growth() const;

    /** `Division axis` of types that have none of their own. */
    const std::string &
    division_axis() const;

    /** `Division axis` of the type of cells number @p type. */
    const std::string &
    division_axis(const unsigned int type) const;

    /** The division axes of all types. */
    std::set<std::string>
    division_axes() const;

    /** Whether there is a growth law. */
    bool
    has_growth() const
    {
      return law_of_growth() != "none";
    }

    /** Whether cells of the type number @p type grow by the law. */
    bool
    grows(const unsigned int type) const;

    /** Whether some effect of a kind is on, which its keys switch on. */
    template <template <int> class Interface>
    static bool
    has_any(const Choices<Interface> &choices)
    {
      return std::any_of(choices.begin(), choices.end(), [](const auto &c) {
        return c.keys().is_on();
      });
    }

    /** Whether anything lets the tissue grow, shrink or change its shape. */
    bool
    has_active_tissue() const
    {
      return has_growth() || has_any(catalogue.growth_factors) ||
             grows_by_fate();
    }

    /** Whether the shear of some cells relaxes. */
    bool
    flows() const
    {
      return has_any(catalogue.flows);
    }

    /** Whether cells divide, by one of the fates. */
    bool
    cells_divide() const;

    /** The keys of the first effect by which cells may divide, and which has a
     *  switch; or null. */
    const EffectKeys *
    first_way_to_divide() const;

    /** Whether cells grow by one of the fates. */
    bool
    grows_by_fate() const;

    /** What effects' keys may see of this, which must outlive it. */
    RestOfScene
    rest_of_scene() const;

    /** The names of the types of cells, by their numbers; empty: all cells are
     *  alike. */
    std::vector<std::string>
    type_names() const;

    /** The names of the fields of cells, by their numbers. */
    std::vector<std::string>
    field_names() const;

    /** The keys of all effects: first those that are no entry of the catalogue.
     */
    std::vector<const EffectKeys *>
    effect_keys() const;

    /** Those of the effects that the scene has. */
    std::vector<const EffectKeys *>
    keys_in_use() const;

    /** The keys of an effect, by their type: e.g. keys<FixedParameters>(). */
    template <typename Parameters>
    Parameters &
    keys()
    {
      return catalogue.keys<Parameters>();
    }

    /** The keys of an effect, by their type. */
    template <typename Parameters>
    const Parameters &
    keys() const
    {
      return catalogue.keys<Parameters>();
    }

    /** Whether the file or an override has set the key. */
    bool
    has_set(const AnyKey &key) const
    {
      return as_written.count(key.path()) > 0;
    }

    /** All keys but those of the types of cells. */
    KeyList
    list_without_types();

    using Keys::list;
    /** All keys, in the order of --parameters. */
    KeyList
    list() override;

    /**
     * Reads a .prm file and applies "Section/Key=value" overrides, without
     * checking more than each value by itself. Keys that neither of them sets
     * have the values that `Method` gives them. Without `Output directory` the
     * run goes to `output/NAME`, after the file's name.
     * @throws InputError with the key's full path, the file and the line
     */
    static Scene
    read(const std::string              &file,
         const std::vector<std::string> &overrides,
         const Catalogue                &catalogue = Catalogue());

    /** The scene of an empty file, with the same effects to choose from. */
    Scene
    with_defaults() const
    {
      return Scene(catalogue.with_defaults());
    }

    /** The message of an InputError about a value that was found wrong after
     *  the file had been read, with the place where the key stands. */
    std::string
    located(const std::string &message) const;

    /** All keys as used, as a .prm file that read() reads back exactly. */
    std::string
    parameters() const;

    /**
     * Makes the sections of the fields and of the types of cells.
     * @param names of them, by the paths of the keys that have them
     * @throws InputError
     */
    void
    declare_sections(const std::map<std::string, std::string> &names);

    /** Tells the keys of cells the fields and the values that types set
     *  differently. To be called when all keys have their values. */
    void
    apply_types();

    /**
     * Refuses what is wrong even without a look at the cells: numbers out of
     * range, expressions that do not parse, shapes that do not exist, values of
     * effects that were never switched on, ... See checks.h for the checks that
     * need the cells.
     * @throws InputError
     */
    void
    check() const;
  };

  /** An effect of a scene, and what it is called. @tparam Kind Force<3>, ... */
  template <typename Kind>
  struct NamedEffect
  {
    std::string                 name;
    std::unique_ptr<const Kind> effect;
  };

  /** Effects of a kind, in the order of the catalogue. */
  template <typename Kind>
  using NamedEffects = std::vector<NamedEffect<Kind>>;

  /** All effects of a scene. */
  template <int dim>
  struct SceneEffects
  {
    /** All of them but the conditions and equations. */
    std::vector<const Effect<dim> *>
    all() const;

    /** What they add to the tables of a run. Refers to them. */
    Tables<dim>
    tables() const;

    /** The columns that the effects need in a cell. */
    CellColumns<dim> columns;
    /** Which variables their expressions use. */
    StateColumns<dim> state;

    DevelopmentEffects<dim>                              development;
    NamedEffects<Equation<dim>>                          equations;
    std::vector<std::unique_ptr<const Trait<dim>>>       traits;
    NamedEffects<StepEffect<dim>>                        step_effects;
    NamedEffects<Force<dim>>                             forces;
    std::optional<NamedEffect<Interaction<dim>>>         interaction;
    std::vector<typename BoundaryConditions<dim>::Named> conditions;
  };

  /** An empty set of variables that cells have in a scene's expressions. */
  template <int dim>
  StateColumns<dim>
  state_columns_of(const Scene &scene);

  /** What a scene offers to its effects, which add to the columns.
   *  @throws InputError */
  template <int dim>
  EffectSetting<dim>
  effect_setting(const Scene       &scene,
                 CellColumns<dim>  &columns,
                 StateColumns<dim> &state);

  /** Makes all effects of a scene, for TissueModel. @throws InputError */
  template <int dim>
  SceneEffects<dim>
  effects_of(const Scene &scene);
} // namespace Morula

#endif
