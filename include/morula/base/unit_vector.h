// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_unit_vector_h
#define morula_base_unit_vector_h

#include <morula/base/key.h>

#include <deal.II/base/tensor.h>

#include <string>

namespace Morula
{
  using namespace dealii;

  /**
   * The unit vector along the direction that a key gives as text: two or three
   * numbers separated by ',' or ';'. In 2-D the first two count.
   * @param key full path of the key, for error messages
   * @throws InputError if the text is no vector or the vector is zero
   */
  template <int dim>
  Tensor<1, dim>
  unit_vector(const std::string &key, const std::string &text);

  /** A key that gives a direction, or none if it is empty. */
  class DirectionKey : public Key<std::string>
  {
  public:
    using Key<std::string>::Key;
    using Key<std::string>::operator=;

    /** Refuses what unit_vector() does. @throws InputError */
    void
    check(const unsigned int dim) const override;
  };
} // namespace Morula

#endif
