// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/name_list.h>
#include <morula/base/parameter_keys.h>
#include <morula/scene/scene.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

namespace Morula
{
  namespace
  {
    template <typename List>
    void
    append(List &list, const List &more)
    {
      list.insert(list.end(), more.begin(), more.end());
    }

    /** The keys of a list whose expressions speak of cells: a type may have its
     *  own value of them. */
    std::vector<ExpressionKey *>
    keys_of_cells(const KeyList &list)
    {
      std::vector<ExpressionKey *> keys;
      for (AnyKey *key : list)
        if (auto *expression = dynamic_cast<ExpressionKey *>(key))
          if (expression->is_of_cells())
            keys.push_back(expression);
      return keys;
    }

    /**
     * Whether a key that two statements set at these places ("file:line: ") is
     * set twice by mistake. A file that includes another may set its keys anew,
     * and the command line those of all files.
     * @param scene the file that is read first
     */
    bool
    is_set_twice(const std::string &before,
                 const std::string &now,
                 const std::string &scene)
    {
      // A place ends with ": " behind the line number. The colon before the
      // number is the last one that is found from the number's last digit on.
      const auto file_of = [](const std::string &place) {
        const auto line = place.rfind(':', place.size() - 3);
        return place.substr(0, line);
      };
      return now.rfind("-s: ", 0) != 0 &&
             (file_of(before) == file_of(now) || file_of(before) == scene);
    }

    /** A file that is not where its key says, seen from the working directory,
     *  but is there seen from the scene's, is that one. */
    void
    find_files(Scene &scene)
    {
      // A path that exists in the working directory keeps its meaning; only one
      // that does not is tried in the scene's folder.
      namespace files   = std::filesystem;
      const auto folder = files::path(scene.file).parent_path();
      for (AnyKey *key : scene.list())
        {
          const files::path name = key->text();
          std::error_code   error; // a text too long for a name, for instance
          if (key->names_file() && !name.empty() && name.is_relative() &&
              !files::exists(name, error) &&
              files::is_regular_file(folder / name, error))
            key->assign((folder / name).lexically_normal().string());
        }
    }

    /** Refuses numbers of cells with a name that means something else already.
     *  @throws InputError */
    void
    check_numbers(const Scene &scene)
    {
      const std::vector<std::string> fields = scene.field_names(),
                                     types  = scene.type_names();
      std::set<std::string> taken(types.begin(), types.end());
      taken.insert(fields.begin(), fields.end());
      for (const EffectKeys *const keys : scene.catalogue.all_keys())
        if (const EffectFacts facts = keys->facts();
            !facts.numbers.empty() && keys->is_on())
          for (const std::string &name : facts.numbers)
            {
              std::string reason = reason_against_variable(name);
              if (reason.empty() && !taken.insert(name).second)
                reason = "A field, a type or another number of cells has "
                         "this name: choose another one.";
              if (!reason.empty())
                throw InputError(facts.names_key ? facts.names_key->path() :
                                                   "A number of cells",
                                 name,
                                 "a name that is free",
                                 reason);
            }
      if (fields.size() + scene.catalogue.number_names().size() > most_fields)
        throw InputError("Cell numbers/Names",
                         "",
                         "at most " + std::to_string(most_fields) +
                           " fields and numbers of cells",
                         "Use fewer of them.");
    }

    /** Admits the names of all effects of a kind. */
    template <template <int> class Interface>
    void
    add_words(Key<std::string> &key, const Choices<Interface> &choices)
    {
      for (const auto &choice : choices)
        key.add_word(choice.name());
    }
  } // namespace


  Scene::Scene(const Catalogue &catalogue)
    : SceneKeys(catalogue)
    , method(
        "Method",
        "consistent",
        "Defaults of the keys that say 'With Method'; those that the scene "
        "sets keep their values. consistent: the most accurate for tissue "
        "that grows, divides and is fixed somewhere. paper: those of the "
        "paper. --explain lists them.",
        {"paper|consistent"})
    , output_directory(
        "Output directory",
        "",
        "Where all files go; empty: output/NAME for a scene "
        "NAME.prm. A new run replaces a finished one of the same "
        "scene file, and others with --replace only.")
    , random_seed("Random seed", 1, "Equal seeds give equal runs.")
  {
    // The words that name effects are those of the catalogue, which a program
    // may have extended. So they are added here, and not where the keys are
    // declared.
    solver.largest_gap.needs(NitscheParameters::held_by());
    add_words(growth_law, catalogue.growth_laws);
    add_words(division.axis, catalogue.division_rules);
    if (std::any_of(catalogue.division_rules.begin(),
                    catalogue.division_rules.end(),
                    [](const auto &rule) { return rule.has_section(); }))
      division.axis.add_documentation(" Others: by a rule of this program.");
  }


  void
  Scene::declare_sections(const std::map<std::string, std::string> &names)
  {
    // Some keys exist only because others name them: fields, numbers of cells,
    // types and bodies have a section each. The order follows who needs whom.
    // Fields come first, as axes may be their gradients, and numbers; then
    // types, which have a copy of each key of cells, those of fields and
    // numbers included; bodies at last.
    const auto names_in = [&names](const AnyKey &key) {
      const auto found = names.find(key.path());
      return found == names.end() ? "" : found->second;
    };
    const auto declare = [&](EffectKeys &keys) {
      const AnyKey *const key = keys.facts().names_key;
      keys.declare_sections(key == nullptr ? "" : names_in(*key),
                            cell_types.name_list());
    };
    std::set<const EffectKeys *> done;
    const auto                   declare_all = [&](auto &choices) {
      for (auto &choice : choices)
        {
          declare(choice.keys());
          done.insert(&choice.keys());
        }
    };
    declare_all(catalogue.equations);
    declare_all(catalogue.traits);
    const std::vector<std::string> fields = field_names();
    for (const std::string &field : fields)
      division.axis.add_word("gradient of " + field);
    std::string growth_laws;
    for (const auto &law : catalogue.growth_laws)
      growth_laws += (growth_laws.empty() ? "" : "|") + law.name();
    const std::vector<ExpressionKey *> of_cells = keys_of_cells(list());
    cell_types.make_types(names_in(cell_types.names),
                          {of_cells.begin(), of_cells.end()},
                          growth_laws,
                          boost::join(division.axis.choices(), "|"),
                          fields);
    for (EffectKeys *const keys : catalogue.all_keys())
      if (done.count(keys) == 0)
        declare(*keys);
  }


  void
  Scene::apply_types()
  {
    // Expressions learn the names of fields and numbers of cells in any case.
    // With types, values that a type overrides go into the keys of all cells.
    // Effects see the keys last, as they may change what types have.
    check_numbers(*this);
    const std::vector<std::string> own = own_variables();
    for (ExpressionKey *key : keys_of_cells(list()))
      key->set_fields(own, field_names().size());
    if (cell_types.is_on())
      cell_types.apply(keys_of_cells(list_without_types()));
    for (EffectKeys *const keys : catalogue.all_keys())
      keys->see(*this, keys_of_cells(list()));
  }


  KeyList
  Scene::list()
  {
    KeyList list = list_without_types();
    append(list, cell_types.list());
    return list;
  }


  KeyList
  Scene::list_without_types()
  {
    // The order is that of the printed parameters. Types are left out because
    // their keys are copies of those in this list.
    KeyList    list = {&method, &dimension, &output_directory, &random_seed};
    const auto append_all = [&list](auto &choices) {
      for (auto &choice : choices)
        append(list, choice.keys().list());
    };
    for (Keys *section : std::vector<Keys *>{&time, &tissue, &grid, &material})
      append(list, section->list());
    append_all(catalogue.flows);
    list.push_back(&growth_law);
    append_all(catalogue.growth_laws);
    // A fate by which cells grow, too, comes before the keys about division.
    const auto append_fates = [&](const bool that_grow) {
      for (auto &choice : catalogue.fates)
        if (choice.keys().facts().grows_cells == that_grow)
          append(list, choice.keys().list());
    };
    append_fates(true);
    append(list, division.list());
    append_all(catalogue.division_rules);
    append_all(catalogue.growth_factors);
    append_fates(false);
    append_all(catalogue.equations);
    append_all(catalogue.traits);
    append_all(catalogue.step_effects);
    // Nitsche's keys follow the library's own conditions, to which they belong;
    // conditions of a user's program come after both.
    for (auto &condition : catalogue.boundary_conditions)
      if (!condition.has_section())
        append(list, condition.keys().list());
    append(list, nitsche.list());
    for (auto &condition : catalogue.boundary_conditions)
      if (condition.has_section())
        append(list, condition.keys().list());
    append_all(catalogue.forces);
    append_all(catalogue.interactions);
    append(list, solver.list());
    append(list, output.list());
    return list;
  }


  Scene
  Scene::read(const std::string              &file,
              const std::vector<std::string> &overrides,
              const Catalogue                &catalogue)
  {
    // There are four passes. All statements are read, with those of the command
    // line last, so that they count. Keys that are names are looked up first,
    // as they say which sections there are. Then each statement sets its key,
    // and where it was set is kept for messages. At last come values that
    // follow from others: defaults of the method, values of types, files beside
    // the scene, the output directory.
    Scene                  scene(catalogue);
    std::vector<Statement> statements = read_statements(file);
    for (const std::string &text : overrides)
      statements.push_back(read_override(text));
    // The names are taken from the last statement of each path, as the values
    // are later.
    std::map<std::string, std::string> names;
    for (const Statement &statement : statements)
      if (!statement.is_section)
        names[statement.path] = statement.value;
    scene.declare_sections(names);
    const ParameterKeys keys(scene.list());

    for (const Statement &statement : statements)
      {
        keys.apply(statement);
        if (!statement.is_section)
          {
            const std::string path = keys.current_name(statement.path);
            if (scene.as_written.count(path) > 0 &&
                is_set_twice(scene.places.at(path), statement.place, file))
              scene.renamed.push_back(
                statement.place + "the key '" + path + "' is set to '" +
                statement.value + "', which counts; " + scene.places.at(path) +
                "it was set to '" + scene.as_written.at(path) +
                "': remove one of the lines");
            scene.as_written[path] = statement.value;
            scene.places[path]     = statement.place;
            if (path != statement.path)
              scene.renamed.push_back(statement.place + "the key '" +
                                      statement.path + "' is called '" + path +
                                      "' today; it is read as that");
          }
      }
    for (AnyKey *key : scene.list())
      key->take_default_of(scene.method, scene.has_set(*key));
    scene.apply_types();
    scene.file = file;
    find_files(scene);
    if (scene.output_directory->empty())
      scene.output_directory =
        (std::filesystem::path("output") / std::filesystem::path(file).stem())
          .string();
    return scene;
  }


  std::string
  Scene::located(const std::string &message) const
  {
    // A message begins with the path of its key, as in "SECTION/KEY = '...'" or
    // "SECTION/KEY (cells.csv, line 3) = '...'"; the place of the key is put
    // before it. A default is not the user's, who has to know that another key
    // asks for another value.
    const std::string path =
      message.substr(0, std::min(message.find(" = '"), message.find(" (")));
    if (const auto place = places.find(path); place != places.end())
      return place->second + message;
    for (const AnyKey *key : list())
      if (key->path() == path && as_written.count(path) == 0)
        return message + " The scene does not set this key.";
    return message;
  }


  std::string
  Scene::parameters() const
  {
    // deal.II's ParameterHandler prints the keys in the order of their
    // declaration.
    ParameterHandler prm;
    for (const AnyKey *key : list())
      key->declare(prm);
    std::ostringstream out;
    prm.print_parameters(out,
                         ParameterHandler::ShortPRM |
                           ParameterHandler::KeepDeclarationOrder);
    return out.str();
  }
} // namespace Morula
