// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_cell_types_h
#define morula_effects_fate_cell_types_h

#include <morula/base/expression_key.h>
#include <morula/effects/fate/fate.h>

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** Section "Cell types/NAME". */
  struct CellTypeKeys : public Keys
  {
    /**
     * @param name   of the type
     * @param others names of the other types
     * @param of_cells keys of cells, for which the type may have values of its
     *        own
     * @param growth_laws, division_axes from which types may choose,
     *        separated by '|'
     */
    CellTypeKeys(const std::string                        &name,
                 const std::vector<std::string>           &others,
                 const std::vector<const ExpressionKey *> &of_cells,
                 const std::string                        &growth_laws,
                 const std::string                        &division_axes);

    std::string      name;
    ExpressionKey    where;
    Key<std::string> daughters;
    Key<std::string> growth_law;
    Key<std::string> proliferation_law;
    Key<std::string> division_axis;
    /** Rates of becoming one of the other types, in their order. */
    std::deque<ExpressionKey> transitions;
    /** Values of keys for this type; empty: the values of all types. */
    std::deque<ExpressionKey> overrides;

    /** The path of a key of cells in the section of this type. */
    std::string
    path_of(const AnyKey &key) const;

    using Keys::list;
    KeyList
    list() override;
  };

  /** Section "Cell types": names first, then a section for each of them. */
  struct CellTypesParameters : public EffectKeys
  {
    Key<std::string> names{
      "Cell types/Names",
      "",
      "Types of cells, separated by commas; the first is that of founders "
      "for which no other one's Where holds. Each has a section of this "
      "name, and expressions of cells may compare `type` with it. Empty: "
      "all cells are alike."};
    std::deque<CellTypeKeys> types;

    bool
    is_on() const override
    {
      return !types.empty();
    }

    /** The values of a key of cells that types have of their own. */
    std::vector<const ExpressionKey *>
    own_values_of(const AnyKey &key) const;

    /** What the type number @p type has of its own: a line a key. */
    std::string
    details_of(const unsigned int type) const;

    /** Refuses types whose Where holds at no founder. @param n numbers of
     *  founders, over all ranks, by type. @throws InputError */
    void
    check_founders(const std::vector<dealii::types::particle_index> &n) const;

    /** Refuses laws that differ from type to type, and daughters of types that
     *  there are not. */
    void
    check(const SceneKeys &scene, Review &review) const override;

    /** The names in the order of the types' numbers. */
    std::vector<std::string>
    name_list() const;

    /**
     * Makes the sections of the types.
     * @param names as `Names` has them
     * @param of_cells keys of cells, for which types may have values of their
     *        own
     * @param growth_laws, division_axes from which types may choose,
     *        separated by '|'
     * @param fields names that are taken
     * @throws InputError for names that expressions cannot have, or that are
     *         given twice
     */
    void
    make_types(const std::string                        &names,
               const std::vector<const ExpressionKey *> &of_cells,
               const std::string                        &growth_laws,
               const std::string                        &division_axes,
               const std::vector<std::string>           &fields);

    /** Tells the keys of cells the types and their own values. */
    void
    apply(const std::vector<ExpressionKey *> &of_cells);

    /** The type of a founder at @p X: the last one whose `Where` holds, or the
     *  first. */
    template <int dim>
    unsigned int
    founder_type(const Point<dim> &X) const;

    /** Numbers of the daughters' types of a type. @throws InputError */
    std::pair<unsigned int, unsigned int>
    daughters(const unsigned int type) const;

    using Keys::list;
    KeyList
    list() override;
  };

  /** The fate by which cells change their types. The scene must have at least
   *  one. @throws InputError */
  template <int dim>
  std::unique_ptr<Fate<dim>>
  make_cell_types(const CellTypesParameters &parameters,
                  const EffectSetting<dim>  &setting);
} // namespace Morula

#endif
