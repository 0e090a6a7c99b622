// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/name_list.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/tables.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    // All keys of a type stand in the section of its name below this one.
    const std::string section_of_types = "Cell types/";
  } // namespace


  CellTypeKeys::CellTypeKeys(const std::string                        &name,
                             const std::vector<std::string>           &others,
                             const std::vector<const ExpressionKey *> &of_cells,
                             const std::string &growth_laws,
                             const std::string &division_axes)
    : name(name)
    , where("Where",
            "",
            "Founders for which this is > 0 are of this type; of several types "
            "the last one counts, and the first type is that of all others. An "
            "expression of X, Y, Z (um).",
            Evaluated::founder)
    , daughters("Daughter types",
                "",
                "Types of the two daughters, the one at -n_s first; empty: the "
                "mother's. E.g. stem, transit.")
    , growth_law("Growth/Law",
                 "",
                 "none, or the law by which cells of this type grow; empty: "
                 "that of all.",
                 {"|none|" + growth_laws})
    , proliferation_law(
        "Proliferation/Law",
        "",
        "none, or how cells of this type proliferate; empty: as all. Cells "
        "that are past the onset of S divide, and then wait.",
        {"|none|cell cycle"})
    , division_axis("Proliferation/Cell cycle/Division axis",
                    "",
                    "What n_s of cells of this type is when they enter S; "
                    "empty: that of all.",
                    {"|" + division_axes})
  {
    // The names of types are the user's, so their keys are made while the file
    // is read. A type has some keys of its own, one rate for each other type,
    // and a copy of every key of cells in the scene, which is empty unless the
    // type differs from the others. Paths are completed at the end: place_in()
    // puts the section before them.
    for (const std::string &other : others)
      {
        transitions.emplace_back("Transitions/To " + other,
                                 "0",
                                 "Rate at which cells of this type become " +
                                   other +
                                   ", an expression of their state; not "
                                   "negative. Units: 1/day.",
                                 Evaluated::step,
                                 not_negative("1/day",
                                              "0 lets cells keep their type."));
      }
    place_in(list(), section_of_types + name);
    for (const ExpressionKey *key : of_cells)
      overrides.push_back(key->in_section_of_type(section_of_types + name));
  }


  std::string
  CellTypeKeys::path_of(const AnyKey &key) const
  {
    return section_of_types + name + "/" + key.path();
  }


  KeyList
  CellTypeKeys::list()
  {
    KeyList list{&where, &daughters};
    for (ExpressionKey &key : transitions)
      list.push_back(&key);
    list.push_back(&growth_law);
    list.push_back(&proliferation_law);
    list.push_back(&division_axis);
    for (ExpressionKey &key : overrides)
      list.push_back(&key);
    return list;
  }


  std::vector<std::string>
  CellTypesParameters::name_list() const
  {
    return names_of(types);
  }


  void
  CellTypesParameters::make_types(
    const std::string                        &text,
    const std::vector<const ExpressionKey *> &of_cells,
    const std::string                        &growth_laws,
    const std::string                        &division_axes,
    const std::vector<std::string>           &fields)
  {
    // The text is that of the key Names, which is read before all others. First
    // all names are checked, then each type gets its keys: it has to know the
    // others, since they are what it may become.
    const std::vector<std::string> list =
      declared_names(names, text, [&](const std::string &name) {
        return std::find(fields.begin(), fields.end(), name) != fields.end() ?
                 "A field has this name: choose another one." :
                 reason_against_variable(name);
      });
    for (const std::string &name : list)
      {
        std::vector<std::string> others;
        std::copy_if(list.begin(),
                     list.end(),
                     std::back_inserter(others),
                     [&](const std::string &other) { return other != name; });
        types.emplace_back(name, others, of_cells, growth_laws, division_axes);
      }
  }


  void
  CellTypesParameters::apply(const std::vector<ExpressionKey *> &of_cells)
  {
    // First every expression learns the names of types as numbers, as it may
    // compare `type` with them. Then what a type overrides is put into the key
    // of all cells, by the type's number; an empty key leaves the scene's
    // value. The overrides of a type are in the order of `of_cells`.
    std::map<std::string, double> numbers;
    for (unsigned int i = 0; i < types.size(); ++i)
      numbers[types[i].name] = i;
    for (ExpressionKey *key : of_cells)
      key->set_types(numbers);
    for (unsigned int i = 0; i < types.size(); ++i)
      {
        for (ExpressionKey &rate : types[i].transitions)
          rate.set_types(numbers);
        for (std::size_t k = 0; k < of_cells.size(); ++k)
          {
            ExpressionKey &own = types[i].overrides[k];
            own.set_types(numbers);
            if (!own.empty())
              of_cells[k]->set_for_type(i, own.path(), own.text());
          }
      }
  }


  std::pair<unsigned int, unsigned int>
  CellTypesParameters::daughters(const unsigned int type) const
  {
    // An empty key stands for two daughters of the mother's type. The result
    // has numbers of types, the daughter at -n_s first.
    const Key<std::string>        &key  = types[type].daughters;
    const std::vector<std::string> both = split_names(key);
    if (both.empty())
      return {type, type};
    const std::vector<std::string> all = name_list();
    std::vector<unsigned int>      numbers;
    for (const std::string &name : both)
      {
        const auto found = std::find(all.begin(), all.end(), name);
        if (found == all.end())
          key.refuse("two of " + names, "There is no type '" + name + "'.");
        numbers.push_back(found - all.begin());
      }
    if (numbers.size() != 2)
      key.refuse("two of " + names,
                 "Name the types of both daughters, the one at -n_s first.");
    return {numbers[0], numbers[1]};
  }


  std::vector<const ExpressionKey *>
  CellTypesParameters::own_values_of(const AnyKey &key) const
  {
    // A type has a copy of every key of cells; it is found by its path.
    std::vector<const ExpressionKey *> list;
    for (const CellTypeKeys &type : types)
      for (const ExpressionKey &own : type.overrides)
        if (!own.empty() && own.path() == type.path_of(key))
          list.push_back(&own);
    return list;
  }


  std::string
  CellTypesParameters::details_of(const unsigned int type) const
  {
    std::string       lines;
    const std::size_t section =
      types[type].path_of(names).size() - names.path().size();
    for (const AnyKey *key : types[type].list())
      if (!key->is_default())
        lines +=
          "    " + key->path().substr(section) + " = " + key->text() + '\n';
    return lines;
  }


  void
  CellTypesParameters::check_founders(
    const std::vector<dealii::types::particle_index> &n) const
  {
    // A type without a condition of its own may be reached by transitions only,
    // so it may have no founder.
    for (unsigned int i = 0; i < types.size(); ++i)
      if (const ExpressionKey &where = types[i].where;
          n[i] == 0 && !where.empty())
        where.refuse("a condition that holds at some founder",
                     "It is positive at none, or at founders of later types "
                     "only: correct it, or leave it empty. Founders sit at "
                     "centers of cells, inside of the tissue.");
  }


  void
  CellTypesParameters::check(const SceneKeys &scene, Review &) const
  {
    const auto &on_transition = scene.material.on_transition;
    if (!is_on() && on_transition == "forget stress")
      on_transition.refuse("keep strain or keep stress, as there are no types "
                           "of cells",
                           "Set " + names.path() + ", or remove this key.");
    if (on_transition == "keep stress" &&
        !TissueMaterial(scene.material).depends_on_state())
      on_transition.refuse("its default, as no cell's stiffness ever changes",
                           "Let " + scene.material.youngs_modulus.path() +
                             " depend on time, age, type or what you like.");
    for (unsigned int i = 0; i < types.size(); ++i)
      {
        const CellTypeKeys &type = types[i];
        type.check_each(scene.dimension);
        daughters(i);
        if (!type.growth_law->empty() && type.growth_law != "none" &&
            type.growth_law != scene.law_of_growth())
          type.growth_law.refuse("none or " + scene.law_of_growth(),
                                 "A scene has one law of growth: give its keys "
                                 "other values for this type.");
      }
  }


  KeyList
  CellTypesParameters::list()
  {
    return keys_of_all(names, types);
  }


  namespace
  {
    /**
     * The types of cells, and how cells change their type. Each way out of a
     * type is a hazard with a rate (1/day), an expression of the cell's state
     * at the beginning of the step, integrated since the cell got its type:
     * doc/theory.md, section 6.8. So events have exact times, and if the rates
     * do not depend on steps, neither do the events.
     */
    template <int dim>
    class CellTypes : public Fate<dim>
    {
    public:
      CellTypes(const CellTypesParameters &parameters,
                const EffectSetting<dim>  &setting)
        : names(parameters.name_list())
      {
        // First the ways out of each type are collected: only rates that the
        // scene sets, with the number of the type to which they lead. Then the
        // columns are declared. A cell has one type at a time, so ways are
        // numbered within its type and all types share the columns: as many as
        // the type with the most ways needs.
        const std::size_t n_types = parameters.types.size();
        std::size_t       most    = 0;
        this->hazards_of_types.resize(n_types);
        targets.resize(n_types);
        for (unsigned int type = 0; type < n_types; ++type)
          {
            const CellTypeKeys &keys = parameters.types[type];
            daughters.push_back(parameters.daughters(type));
            for (unsigned int k = 0; k < keys.transitions.size(); ++k)
              if (!keys.transitions[k].is_default())
                {
                  // The list of a type leaves the type itself out.
                  targets[type].push_back(k < type ? k : k + 1);
                  this->hazards_of_types[type].push_back(
                    {setting.state.use(keys.transitions[k], false), {}, {}});
                }
            most = std::max(most, targets[type].size());
          }
        if (most > 0)
          add_columns(setting, most);
      }

      LifeAfter
      happen(const PresentCell<dim>      &cell,
             const CellView<dim, double> &row,
             const Stretch               &stretch,
             const double                 s,
             std::vector<CellEvent>      &events) const override
      {
        // A new type has other ways out, so all integrals begin anew, and the
        // count of changes gives it new thresholds.
        const unsigned int to =
          targets[cell.type()][this->first_hazard(cell, stretch)];
        const StateColumns<dim> &columns = cell.reader().columns;
        events.push_back(
          {s, cell.id(), CellEvent::transition, cell.type(), to});
        row.set(columns.type, to);
        if (columns.type_since.exists())
          row.set(columns.type_since, s);
        row.set(n_changes, row.get(n_changes) + 1);
        for (const Column<double> &integral : integrals)
          row.set(integral, 0.);
        return LifeAfter::goes_on;
      }

      void
      inherit(const CellView<dim, double> &daughter,
              const StateColumns<dim>     &columns,
              const unsigned int           which,
              const double                 birth) const override
      {
        // A daughter of her mother's type keeps the time since when she has it;
        // one of another type gets it at birth.
        const unsigned int type = daughter.get(columns.type);
        const unsigned int own =
          which == 0 ? daughters[type].first : daughters[type].second;
        if (own == type)
          return;
        daughter.set(columns.type, own);
        if (columns.type_since.exists())
          daughter.set(columns.type_since, birth);
      }

      void
      declare(Tables<dim> &tables) const override
      {
        tables.record_events();
        for (unsigned int type = 0; type < names.size(); ++type)
          tables.add_sum("cells_" + names[type],
                         [type](const PresentCell<dim> &cell) {
                           return cell.type() == type ? 1. : 0.;
                         });
      }

    private:
      /** Declares the columns of the ways, and gives them to the hazards.
       *  @param most number of ways out of the type with the most */
      void
      add_columns(const EffectSetting<dim> &setting, const std::size_t most)
      {
        CellColumns<dim> &columns = setting.columns;
        const auto        add     = [&columns](const auto &...column) {
          return columns.template add<double>({column..., AtDivision::reset});
        };
        n_changes = columns.template add<unsigned int>(
          {"type_changes",
           "",
           "how often the cell has changed its type",
           0,
           AtDivision::reset});
        for (std::size_t k = 0; k < most; ++k)
          integrals.push_back(add("transition_hazard_" + std::to_string(k + 1),
                                  "",
                                  "rate of a way out of the type, integrated",
                                  0.));
        for (std::size_t k = 0; k < most; ++k)
          {
            Column<double> expected;
            if (std::any_of(this->hazards_of_types.begin(),
                            this->hazards_of_types.end(),
                            [k](const auto &ways) {
                              return k < ways.size() &&
                                     ways[k].rate.follows_state();
                            }))
              expected =
                add("transition_rate_" + std::to_string(k + 1),
                    "1/day",
                    "rate of a way out of the type that the last step saw; -1: "
                    "none",
                    not_expected);
            const auto threshold =
              [k,
               seed      = setting.random_seed,
               n_changes = n_changes](const PresentCell<dim>            &cell,
                                      const CellView<dim, const double> &row) {
                return Random::transition_threshold(seed,
                                                    cell.lineage_key(),
                                                    row.get(n_changes),
                                                    k);
              };
            for (auto &ways : this->hazards_of_types)
              if (k < ways.size())
                ways[k] = {ways[k].rate, integrals[k], expected, threshold};
          }
      }

      std::vector<std::string>                           names;
      std::vector<std::pair<unsigned int, unsigned int>> daughters;
      /** To which type the ways out of a type lead. */
      std::vector<std::vector<unsigned int>> targets;
      Column<unsigned int>                   n_changes;
      /** Of the rates, by the number of the way. */
      std::vector<Column<double>> integrals;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<Fate<dim>>
  make_cell_types(const CellTypesParameters &parameters,
                  const EffectSetting<dim>  &setting)
  {
    return std::make_unique<CellTypes<dim>>(parameters, setting);
  }


  template <int dim>
  unsigned int
  CellTypesParameters::founder_type(const Point<dim> &X) const
  {
    // The last type whose condition holds counts, so the search goes backwards.
    // Type 0 is that of all others and is not asked.
    for (unsigned int i = types.size(); i-- > 1;)
      if (!types[i].where.empty() &&
          types[i].where.expression(dim).value(X, 0.) > 0.)
        return i;
    return 0;
  }


  MORULA_INSTANTIATE(make_cell_types);
  template unsigned int
  CellTypesParameters::founder_type(const Point<2> &) const;
  template unsigned int
  CellTypesParameters::founder_type(const Point<3> &) const;
} // namespace Morula
