// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/unit_vector.h>

#include <boost/algorithm/string.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>

#include <cmath>
#include <vector>

namespace Morula
{
  template <int dim>
  Tensor<1, dim>
  unit_vector(const std::string &key, const std::string &text)
  {
    std::vector<std::string> words;
    // Both separators are accepted, as lists of numbers have the one and
    // expressions the other.
    boost::split(words, text, boost::is_any_of(",;"));
    bool           valid = words.size() >= dim && words.size() <= 3;
    Tensor<1, dim> direction;
    for (unsigned int d = 0; valid && d < words.size(); ++d)
      {
        boost::trim(words[d]);
        double component;
        valid = boost::conversion::try_lexical_convert(words[d], component) &&
                std::isfinite(component);
        // In 2-D a third component may be there, and does not count.
        if (valid && d < dim)
          direction[d] = component;
      }
    if (!valid || direction.norm() == 0.)
      throw InputError(key,
                       text,
                       "a direction of " + std::to_string(dim) +
                         " numbers that are not all zero, separated by commas",
                       "Write for example 0, 1, 0; its length does not "
                       "matter.");
    return direction / direction.norm();
  }


  void
  DirectionKey::check(const unsigned int dim) const
  {
    if (value().empty())
      return;
    if (dim == 2)
      unit_vector<2>(path(), value());
    else
      unit_vector<3>(path(), value());
  }


  MORULA_INSTANTIATE(unit_vector);
} // namespace Morula
