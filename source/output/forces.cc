// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/forces.h>

namespace Morula
{
  std::vector<std::string>
  force_columns()
  {
    return {"time",
            "kind",
            "name",
            "points",
            "area",
            "force_x",
            "force_y",
            "force_z",
            "moment_x",
            "moment_y",
            "moment_z",
            "force_inward"};
  }

  std::string
  force_rows(const double time, const std::vector<ForceRow> &rows)
  {
    std::string text;
    for (const ForceRow &row : rows)
      {
        append_number(text, time);
        text += ',' + row.kind + ',' + row.name + ',' +
                std::to_string(row.points) + ',';
        append_number(text, row.area);
        for (const Tensor<1, 3> &vector : {row.force, row.moment})
          for (unsigned int d = 0; d < 3; ++d)
            {
              text += ',';
              append_number(text, vector[d]);
            }
        text += ',';
        append_number(text, row.inward);
        text += '\n';
      }
    return text;
  }
} // namespace Morula
