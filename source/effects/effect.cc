// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/effect.h>

// This file has the defaults of an effect and of its keys. An effect that says
// nothing else acts always, keeps nothing, checks nothing and warns of nothing,
// so a new effect overrides only what concerns it.
namespace Morula
{
  std::string
  EffectKeys::details() const
  {
    // The list begins with a comma since the name of the effect stands before
    // it.
    std::string text;
    for (const AnyKey *key : list())
      text += ", " + key->short_name() + " = " + key->text();
    return text;
  }


  template class Effect<2>;
  template class Effect<3>;
} // namespace Morula
