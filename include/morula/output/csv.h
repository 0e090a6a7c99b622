// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_csv_h
#define morula_output_csv_h

#include <morula/output/point_fields.h>

#include <string>
#include <vector>

namespace Morula
{
  /**
   * The text of a CSV file of points: a header, then the rows of all parts in
   * the order of their ids, so that the file is the same for any number of
   * ranks.
   * @param parts of the ranks; at least one
   */
  template <int dim>
  std::string
  csv_text(const std::vector<PointFields<dim>> &parts);
} // namespace Morula

#endif
