// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/state/neighbour_columns.h>

#include <utility>

namespace Morula
{
  namespace
  {
    constexpr double reach_of_distance = 1.5;


    /** The names in a text. */
    std::vector<std::string>
    names_in(const std::string &text)
    {
      std::vector<std::string> names;
      std::string              word;
      const auto               end_word = [&] {
        if (!word.empty() && !std::isdigit(static_cast<unsigned char>(word[0])))
          names.push_back(word);
        word.clear();
      };
      for (const char c : text)
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
          word += c;
        else
          end_word();
      end_word();
      return names;
    }


    bool
    is_in(const std::vector<std::string> &list, const std::string &name)
    {
      return std::find(list.begin(), list.end(), name) != list.end();
    }


    std::string
    joined(const std::vector<std::string> &names)
    {
      std::string text;
      for (const std::string &name : names)
        text += (text.empty() ? "" : ", ") + name;
      return text.empty() ? "none" : text;
    }


    /** A cell of this rank and what touches it. */
    template <int dim>
    class Around
    {
    public:
      /** @param free area of its free surface, µm^(dim-1) */
      Around(const NeighbourGraph<dim> &graph,
             const unsigned int         p,
             const double               free)
        : graph(graph)
        , p(p)
        , free(free)
      {
        graph.for_neighbours(p, [&](const auto &e) {
          touching += e.area;
          beside.push_back(
            {static_cast<unsigned int>(graph.points.row(e.other)[0]), e.area});
        });
      }

      /** @param place in the rows of the graph of that of which a mean is
       *  asked */
      double
      value(const NeighbourVariable &told, const unsigned int place) const
      {
        const auto   own     = graph.points.row(p);
        const double surface = touching + free;
        switch (told.kind)
          {
            case NeighbourVariable::count:
              return graph.offsets[p + 1] - graph.offsets[p];
            case NeighbourVariable::free:
              return surface > 0. ? free / surface : 0.;
            case NeighbourVariable::around:
              {
                // A cell without neighbours has its own value around it.
                if (!(touching > 0.))
                  return own[place];
                double total = 0.;
                graph.for_neighbours(p, [&](const auto &e) {
                  total += e.area * graph.points.row(e.other)[place];
                });
                return total / touching;
              }
            default:
              return *of_types(told,
                               static_cast<unsigned int>(own[0]),
                               beside,
                               surface);
          }
      }

    private:
      const NeighbourGraph<dim> &graph;
      const unsigned int         p;
      const double               free;
      double                     touching = 0.;
      std::vector<CellBeside>    beside;
    };
  } // namespace


  NeighbourSearch
  NeighbourParameters::search() const
  {
    const bool by_facets = found_by == "facets";
    return {by_facets,
            !by_facets && reach.is_default() ? reach_of_distance :
                                               reach.value()};
  }


  void
  NeighbourParameters::see(const SceneKeys                    &scene,
                           const std::vector<ExpressionKey *> &keys)
  {
    // The names are sorted, so that the numbers of variables, and with them the
    // columns, do not depend on the order of keys. They follow the fields, as
    // keys know variables of a scene's own by their numbers alone.
    const std::vector<std::string> types = scene.type_names(),
                                   own   = scene.own_variables();
    const unsigned int n_fields          = scene.field_names().size();
    variables.clear();
    std::map<std::string, NeighbourVariable> found;
    for (const ExpressionKey *key : keys)
      for (const std::string &name : names_in(key->text()))
        {
          const auto told = neighbour_variable(name, types, own, n_fields);
          if (told && key->evaluated() == Evaluated::property)
            key->refuse("an expression without '" + name + "'",
                        "The stress may not depend on the neighbours, which "
                        "depend on the stress: let cells change their type by "
                        "it, and set this key for the type.");
          if (told)
            found.emplace(name, *told);
          else if (tells_of_neighbours(name) && !is_in(types, name) &&
                   !is_in(own, name))
            key->refuse("a variable that there is",
                        "'" + name +
                          "' ends with no name that it can be of. Types: " +
                          joined(types) +
                          "; fields and numbers of cells: " + joined(own) +
                          "; around_ is followed by one of these or a "
                          "variable of cells, slope_ by a field.");
        }
    if (found.empty())
      return;
    std::vector<std::string> names = own;
    for (const auto &[name, told] : found)
      {
        variables.push_back(told);
        names.push_back(name);
      }
    if (names.size() > most_fields)
      throw InputError("Neighbours",
                       joined(names),
                       "at most " + std::to_string(most_fields) +
                         " fields, numbers of cells and variables of "
                         "neighbours",
                       "Use fewer of them in expressions.");
    for (ExpressionKey *key : keys)
      key->set_fields(names, n_fields);
  }


  namespace
  {
    /** Tells cells of their neighbours: writes the columns of the variables, at
     *  t = 0 and at the end of each step. doc/theory.md, section 12.1. */
    template <int dim>
    class NeighbourColumns : public StepEffect<dim>
    {
    public:
      using Parameters = NeighbourParameters;

      explicit NeighbourColumns(const Parameters &parameters)
        : search(parameters.search())
        , variables(parameters.variables)
      {}

      void
      settle(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override
      {
        after(tissue, moment);
      }

      void
      after(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override
      {
        // Each cell tells the others its type, and the values that some mean
        // over neighbours asks for. These are read before any column is
        // written, as a mean may be one of a variable that is written here.
        // Then the sums over the neighbours are made in the order of their ids.
        const StateColumns<dim>               &columns = moment.reader.columns;
        const Cells<dim>                      &cells   = tissue.cells();
        std::vector<const NeighbourVariable *> means;
        for (const NeighbourVariable &told : variables)
          if (told.kind == NeighbourVariable::around)
            means.push_back(&told);
        PointList<dim> told_by_cells(1 + means.size());
        everywhere(tissue.communicator(), [&]() {
          for (unsigned int p = 0; p < cells.size(); ++p)
            {
              const PresentCell<dim> cell =
                present_cell(tissue, p, moment.reader);
              std::vector<double> row = {double(cell.type())};
              for (const NeighbourVariable *const mean : means)
                row.push_back(cell.value(mean->variable, moment.t));
              told_by_cells.add(cells.id(p),
                                cells.position(p),
                                make_array_view(row));
            }
        });
        const NeighbourGraph<dim> graph =
          neighbours(tissue, told_by_cells, search);
        // A share of the surface is one of all of it, so that the free part is
        // needed for each of them.
        const bool                shares = std::any_of(variables.begin(),
                                        variables.end(),
                                        [](const NeighbourVariable &told) {
                                          using V = NeighbourVariable;
                                          return told.kind == V::free ||
                                                 told.kind == V::unlike ||
                                                 told.kind == V::share_of_type;
                                        });
        const std::vector<double> free =
          shares ? free_surfaces(tissue) :
                   std::vector<double>(cells.size(), 0.);

        for (unsigned int p = 0; p < cells.size(); ++p)
          {
            const Around<dim> around(graph, p, free[p]);
            unsigned int      n_means = 0;
            for (std::size_t k = 0; k < variables.size(); ++k)
              {
                n_means += variables[k].kind == NeighbourVariable::around;
                if (variables[k].kind != NeighbourVariable::slope)
                  tissue.cell(p).set(columns.neighbours[k],
                                     around.value(variables[k], n_means));
              }
          }
      }

    private:
      const NeighbourSearch                search;
      const std::vector<NeighbourVariable> variables;
    };
  } // namespace


  void
  add_neighbours(Catalogue &catalogue)
  {
    catalogue.add_own<NeighbourColumns>("neighbours",
                                        {"Growth/Law=rate",
                                         "Growth/Rate/Rate=0.1*neighbours"});
  }


  bool
  follows_types(const NeighbourVariable &told)
  {
    return told.kind == NeighbourVariable::count_of_type ||
           told.kind == NeighbourVariable::share_of_type ||
           told.kind == NeighbourVariable::unlike;
  }


  std::optional<double>
  of_types(const NeighbourVariable       &told,
           const unsigned int             own,
           const std::vector<CellBeside> &beside,
           const double                   surface)
  {
    if (!follows_types(told))
      return {};
    double sum = 0.;
    for (const CellBeside &cell : beside)
      {
        const bool counts = told.kind == NeighbourVariable::unlike ?
                              cell.type != own :
                              cell.type == told.number;
        if (counts)
          sum += told.kind == NeighbourVariable::count_of_type ? 1. : cell.area;
      }
    if (told.kind == NeighbourVariable::count_of_type)
      return sum;
    return surface > 0. ? sum / surface : 0.;
  }


  template <int dim>
  bool
  is_type_around(const Variable variable, const StateColumns<dim> &columns)
  {
    const unsigned int n = columns.n_before_neighbours();
    return is_field(variable) && field_number(variable) >= n &&
           follows_types(
             columns.neighbour_variables()[field_number(variable) - n]);
  }


  template <int dim>
  bool
  reads_types_around(const Expression        &expression,
                     const StateColumns<dim> &columns)
  {
    const auto &used = expression.used();
    return std::any_of(used.begin(), used.end(), [&](const Variable variable) {
      return is_type_around(variable, columns);
    });
  }


  template <int dim>
  TypesAround<dim>::TypesAround(const StateColumns<dim> &columns,
                                std::vector<CellBeside>  beside,
                                std::vector<Change>      changes,
                                const double             surface)
    : columns(columns)
    , beside(std::move(beside))
    , changes(std::move(changes))
    , surface(surface)
  {
    std::stable_sort(this->changes.begin(),
                     this->changes.end(),
                     [](const Change &a, const Change &b) {
                       return std::make_pair(a.time, !a.comes_first) <
                              std::make_pair(b.time, !b.comes_first);
                     });
  }


  template <int dim>
  void
  TypesAround<dim>::set(const CellView<dim, double> &row,
                        const std::size_t            k) const
  {
    std::vector<CellBeside> now = beside;
    for (std::size_t i = 0; i < k; ++i)
      now[changes[i].which].type = changes[i].type;
    const auto &told = columns.neighbour_variables();
    for (std::size_t v = 0; v < told.size(); ++v)
      if (const auto value =
            of_types(told[v], row.get(columns.type), now, surface))
        row.set(columns.neighbours[v], *value);
  }


  MORULA_INSTANTIATE(is_type_around);
  MORULA_INSTANTIATE(reads_types_around);
  template class TypesAround<2>;
  template class TypesAround<3>;
} // namespace Morula
