// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_refusals_h
#define morula_scene_refusals_h

#include <morula/base/expression.h>
#include <morula/scene/scene.h>

#include <string>

/** Pieces that the checks of a scene are made of. */
namespace Morula::Refusals
{
  /** A number as a message shows it. */
  std::string
  as_text(const double value);

  /** @throws InputError unless @p valid */
  void
  refuse_unless(const bool         valid,
                const std::string &key,
                const double       value,
                const std::string &allowed,
                const std::string &remedy);

  /** Whether an expression must be positive, or may be zero. */
  enum class Sign
  {
    positive,
    not_negative
  };

  /**
   * Refuses an expression that is a plain number of the wrong sign; others
   * must be evaluated at the cells.
   * @param unit e.g. "kPa", for the message
   * @throws InputError
   */
  void
  refuse_constant_unless(const Sign         sign,
                         const std::string &unit,
                         const Expression  &expression,
                         const std::string &remedy);

  /**
   * An expression of the initial position alone.
   * @throws InputError if it depends on t, or on Z in two dimensions
   */
  Expression
  in_space_only(const std::string &key,
                const std::string &text,
                const unsigned int dim);

  /** Whether two values are equal, as text without blanks or as numbers. */
  bool
  same_value(const std::string &a, const std::string &b);

  /**
   * Refuses a value that does nothing because what it belongs to is off. If
   * the user wrote the switch, it was switched off on purpose.
   * @param is_needed whether the value does something, or is the default
   * @throws InputError
   */
  void
  refuse_forgotten(const Scene       &scene,
                   const std::string &switch_key,
                   const std::string &key,
                   const std::string &value,
                   const bool         is_needed,
                   const std::string &remedy);
} // namespace Morula::Refusals

#endif
