// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_variable_h
#define morula_base_variable_h

#include <array>
#include <map>
#include <string>
#include <vector>

namespace Morula
{
  /** The variables of expressions. The names in scenes are those of the
   *  enumerators; doc/glossary.md lists their units. */
  enum class Variable : unsigned int
  {
    /** Initial position of a founder or boundary point, µm. */
    X,
    Y,
    Z,
    /** Time, day. */
    t,
    /** Present position of a cell, µm. */
    x,
    y,
    z,
    /** Number of divisions since the founder. */
    generation,
    /** Time since birth, day. */
    age,
    /** Time since the cell took its type, day. */
    type_age,
    /** The phase of the cell's cycle, as in the column `phase` of
     *  cells-NNNN.csv. */
    cycle_phase,
    /** Number of the cell's type, from 0. */
    type,
    /** V, µm^dim. */
    volume,
    /** det F_g. */
    growth,
    /** det F_e. */
    J_e,
    /** -tr σ / 3, kPa. */
    pressure,
    /** The largest principal stress, kPa. */
    tension,
    /** The von Mises stress, kPa. */
    shear,
    /** Ψ, kPa. */
    energy,
    /** Distance of the founder from the surface at t = 0, µm. */
    depth,
    /** Distance of the cell from the surface at the beginning of the step, µm.
     */
    present_depth,
    /** Uniform in (0, 1), the cell's own for its life. */
    noise
  };

  /** Number of variables. */
  constexpr unsigned int n_variables =
    static_cast<unsigned int>(Variable::noise) + 1;

  /** Largest number of fields in a scene. */
  constexpr unsigned int most_fields = 32;

  /** The variable that is the value of field number @p k of the scene at the
   *  cell. Its name is that of the field: Vocabulary::name_of(). */
  constexpr Variable
  field_variable(const unsigned int k)
  {
    return static_cast<Variable>(n_variables + k);
  }

  /** Whether the variable is the value of a field. */
  constexpr bool
  is_field(const Variable variable)
  {
    return static_cast<unsigned int>(variable) >= n_variables;
  }

  /** Number of the field whose value the variable is. */
  constexpr unsigned int
  field_number(const Variable variable)
  {
    return static_cast<unsigned int>(variable) - n_variables;
  }

  /** A value for each variable. An expression reads only those that it uses. */
  using VariableValues = std::array<double, n_variables + most_fields>;

  /** Name in scenes of a variable that is no field. */
  const char *
  name_of(const Variable variable);

  /** The variables and named numbers that an expression may use. */
  struct Vocabulary
  {
    std::vector<Variable> variables;
    /** Named numbers, e.g. the types of cells. */
    std::map<std::string, double> constants = {};
    /** Names of the fields, whose values are variables, too; by number. */
    std::vector<std::string> fields = {};

    /** Name of a variable. */
    std::string
    name_of(const Variable variable) const;

    /** All variables, the fields last. */
    std::vector<Variable>
    all_variables() const;

    /** The names, separated by blanks. */
    std::string
    names() const;
  };

  /** X, Y, Z and t: the variables that every place has at every time. */
  const Vocabulary &
  place_and_time();
} // namespace Morula

#endif
