// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A step effect: the first field of a scene turns into the second one, a
// reaction between two fields that is solved exactly, cell by cell.

#ifndef own_effects_conversion_h
#define own_effects_conversion_h

#include <morula/effects/step_effect.h>

#include <cmath>

namespace Own
{
  using namespace Morula;

  struct ConversionKeys : public EffectKeys
  {
    Key<double> rate{{this, "Rate"}, 0., "Of the first field. Units: 1/day."};

    bool
    is_on() const override
    {
      return rate > 0.;
    }
  };

  template <int dim>
  class Conversion : public StepEffect<dim>
  {
  public:
    using Parameters = ConversionKeys;

    explicit Conversion(const Parameters &parameters)
      : rate(parameters.rate)
    {}

    void
    after(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override
    {
      const auto &fields = moment.reader.columns.fields;
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        {
          const CellView<dim, double> cell = tissue.cell(p);
          const double                a    = cell.get(fields[0]);
          const double turned              = -std::expm1(-rate * moment.dt) * a;
          cell.set(fields[0], a - turned);
          cell.set(fields[1], cell.get(fields[1]) + turned);
        }
    }

  private:
    const double rate;
  };
} // namespace Own

#endif
