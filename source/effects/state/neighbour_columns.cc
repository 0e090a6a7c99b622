// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/effects/fate/types_around.h>
#include <morula/effects/state/neighbour_columns.h>

#include <algorithm>
#include <cctype>

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
  } // namespace


  NeighbourSearch
  NeighbourParameters::search() const
  {
    const bool by_facets = found_by == "facets";
    return {by_facets,
            !by_facets && reach.is_default() ? reach_of_distance :
                                               reach.value()};
  }


  bool
  NeighbourParameters::is_on() const
  {
    return std::any_of(variables.begin(),
                       variables.end(),
                       [](const NeighbourVariable &told) {
                         return told.kind != NeighbourVariable::slope;
                       });
  }


  std::string
  NeighbourParameters::details() const
  {
    std::string names;
    for (const NeighbourVariable &told : variables)
      names += (names.empty() ? "" : ", ") + told.name;
    return names + ", found by " + found_by.value() + ", reach " +
           as_text(search().reach);
  }


  void
  NeighbourParameters::see(const SceneKeys                    &scene,
                           const std::vector<ExpressionKey *> &keys)
  {
    // The names are sorted, so that the numbers of variables, and with them the
    // columns, do not depend on the order of keys. They follow the fields, as
    // keys know variables of a scene's own by their numbers alone.
    const std::vector<std::string> types  = scene.type_names(),
                                   fields = scene.field_names();
    variables.clear();
    std::map<std::string, NeighbourVariable> found;
    for (const ExpressionKey *key : keys)
      for (const std::string &name : names_in(key->text()))
        {
          const auto told = neighbour_variable(name, types, fields);
          if (told && key->evaluated() == Evaluated::property)
            key->refuse("an expression without '" + name + "'",
                        "The stress may not depend on the neighbours, which "
                        "depend on the stress: let cells change their type by "
                        "it, and set this key for the type.");
          if (told)
            found.emplace(name, *told);
          else if (tells_of_neighbours(name) && !is_in(types, name) &&
                   !is_in(fields, name))
            key->refuse("a variable that there is",
                        "'" + name +
                          "' ends with no name that it can be of. Types: " +
                          joined(types) + "; fields: " + joined(fields) +
                          "; around_ is followed by a variable of cells or a "
                          "field.");
        }
    if (found.empty())
      return;
    std::vector<std::string> names = fields;
    for (const auto &[name, told] : found)
      {
        variables.push_back(told);
        names.push_back(name);
      }
    if (names.size() > most_fields)
      throw InputError("Neighbours",
                       joined(names),
                       "at most " + std::to_string(most_fields) +
                         " fields and variables of neighbours",
                       "Use fewer of them in expressions.");
    for (ExpressionKey *key : keys)
      key->set_fields(names);
  }


  template <int dim>
  NeighbourColumns<dim>::NeighbourColumns(const Parameters &parameters)
    : search(parameters.search())
    , variables(parameters.variables)
  {}


  template <int dim>
  void
  NeighbourColumns<dim>::settle(Tissue<dim>            &tissue,
                                const MomentOfRun<dim> &moment) const
  {
    after(tissue, moment);
  }


  namespace
  {
    /** What each cell tells the others: its type, and the values that some mean
     *  over neighbours asks for. Collective. */
    template <int dim>
    PointList<dim>
    told_by_cells(const std::vector<NeighbourVariable> &variables,
                  const Tissue<dim>                    &tissue,
                  const MomentOfRun<dim>               &moment)
    {
      const Cells<dim>                      &cells = tissue.cells();
      std::vector<const NeighbourVariable *> means;
      for (const NeighbourVariable &told : variables)
        if (told.kind == NeighbourVariable::around)
          means.push_back(&told);
      PointList<dim> list(1 + means.size());
      everywhere(tissue.communicator(), [&]() {
        for (unsigned int p = 0; p < cells.size(); ++p)
          {
            const PresentCell<dim> cell =
              present_cell(tissue, p, moment.reader);
            std::vector<double> row = {double(cell.type())};
            for (const NeighbourVariable *const mean : means)
              row.push_back(cell.value(mean->variable, moment.t));
            list.add(cells.id(p), cells.position(p), make_array_view(row));
          }
      });
      return list;
    }


    /** The free surfaces of the cells. A share of the surface is one of all of
     *  it, so that the free part is needed for each of them; else 0. */
    template <int dim>
    std::vector<double>
    free_parts(const std::vector<NeighbourVariable> &variables,
               const Tissue<dim>                    &tissue)
    {
      const bool shares =
        std::any_of(variables.begin(), variables.end(), [](const auto &told) {
          return told.kind == NeighbourVariable::free ||
                 told.kind == NeighbourVariable::unlike ||
                 told.kind == NeighbourVariable::share_of_type;
        });
      return shares ? free_surfaces(tissue) :
                      std::vector<double>(tissue.cells().size(), 0.);
    }


    /** The mean of number @p k over the neighbours of cell @p p, by what they
     *  touch of it. A cell without neighbours has its own value around it. */
    template <int dim>
    double
    mean_around(const NeighbourGraph<dim> &graph,
                const unsigned int         p,
                const unsigned int         k,
                const double               touching)
    {
      if (!(touching > 0.))
        return graph.points.row(p)[k];
      double total = 0.;
      graph.for_neighbours(p, [&](const auto &e) {
        total += e.area * graph.points.row(e.other)[k];
      });
      return total / touching;
    }
  } // namespace


  template <int dim>
  void
  NeighbourColumns<dim>::after(Tissue<dim>            &tissue,
                               const MomentOfRun<dim> &moment) const
  {
    // All values of cells are read before any column is written, as a mean may
    // be one of a variable that is written here. Then the sums over the
    // neighbours are made in the order of their ids.
    const NeighbourGraph<dim> graph =
      neighbours(tissue, told_by_cells(variables, tissue, moment), search);
    const std::vector<double> free = free_parts(variables, tissue);
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        double                  touching = 0.;
        std::vector<CellBeside> beside;
        graph.for_neighbours(p, [&](const auto &e) {
          touching += e.area;
          beside.push_back(
            {static_cast<unsigned int>(graph.points.row(e.other)[0]), e.area});
        });
        const double surface = touching + free[p];
        unsigned int n_means = 0;
        for (std::size_t k = 0; k < variables.size(); ++k)
          {
            const NeighbourVariable &told  = variables[k];
            double                   value = 0.;
            switch (told.kind)
              {
                case NeighbourVariable::count:
                  value = graph.offsets[p + 1] - graph.offsets[p];
                  break;
                case NeighbourVariable::count_of_type:
                case NeighbourVariable::share_of_type:
                case NeighbourVariable::unlike:
                  value =
                    *of_types(told,
                              static_cast<unsigned int>(graph.points.row(p)[0]),
                              beside,
                              surface);
                  break;
                case NeighbourVariable::free:
                  value = surface > 0. ? free[p] / surface : 0.;
                  break;
                case NeighbourVariable::around:
                  value = mean_around(graph, p, ++n_means, touching);
                  break;
                case NeighbourVariable::slope:
                  continue;
              }
            tissue.cell(p).set(moment.reader.columns.neighbours[k], value);
          }
      }
  }


  template class NeighbourColumns<2>;
  template class NeighbourColumns<3>;
} // namespace Morula
