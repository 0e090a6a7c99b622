// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/fields/keep_positive.h>
#include <morula/mechanics/spline_field.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** What the cells of one grid cell have: weights times values. */
    struct Content
    {
      /** The content of its positive values. */
      double positive = 0.;
      /** What its negative values lack and others must give. */
      double missing = 0.;

      /** Takes as much of the positive ones as there is. */
      void
      take(const double amount)
      {
        missing  = std::max(0., amount - positive);
        positive = std::max(0., positive - amount);
      }
    };

    /** The contents by grid cell, after each has made up for its own negative
     *  values. */
    template <int dim>
    std::vector<Content>
    contents(const std::vector<double> &values,
             const std::vector<double> &weights,
             const GroupedPoints<dim>  &places,
             std::uint64_t             &n_negative)
    {
      std::vector<Content> result(places.offsets.size() - 1);
      for (unsigned int c = 0; c < result.size(); ++c)
        {
          // Negative values are made up for from the positive ones of the same
          // grid cell first: that is what keeps the correction local.
          double negative = 0.;
          for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1];
               ++p)
            {
              const double amount = weights[p] * values[p];
              if (values[p] < 0.)
                {
                  negative -= amount;
                  ++n_negative;
                }
              else
                result[c].positive += amount;
            }
          result[c].take(negative);
        }
      return result;
    }

    /** Lets grid cells give to those with the same splines, in equal shares to
     *  each spline. @return what is still missing on all ranks */
    template <int dim>
    double
    give_to_neighbors(std::vector<Content>   &contents,
                      const SplineSpace<dim> &space,
                      const MPI_Comm          comm)
    {
      // Each grid cell asks its splines for what it lacks, and offers what it
      // has, in equal shares. A spline adds up both over all grid cells that
      // use it, on all ranks, and takes that part of what is there. Every grid
      // cell then gives the mean of its splines' parts.
      const FieldUnknowns<dim, 1> unknowns(space, comm);
      const unsigned int          n = unknowns.relevant().n_elements();
      std::vector<double>         wanted(n, 0.), there(n, 0.);
      for (unsigned int c = 0; c < contents.size(); ++c)
        for (const auto s : space.grid_cells()[c].unknowns)
          {
            const double n_splines = space.grid_cells()[c].unknowns.size();
            wanted[s] += contents[c].missing / n_splines;
            there[s] += contents[c].positive / n_splines;
          }
      // First what is wanted by each spline, then the part of what is there
      // that is taken.
      auto       taken     = unknowns.sum(wanted);
      const auto of_spline = unknowns.sum(there);
      double     missing   = 0.;
      for (const auto s : unknowns.owned())
        {
          // A spline with too little gives all of it, and the rest is missing.
          const double wants = taken[s], has = of_spline[s];
          missing += std::max(0., wants - has);
          taken[s] = wants >= has ? (has > 0. ? 1. : 0.) : wants / has;
        }
      taken.compress(VectorOperation::insert);
      const std::vector<double> parts = unknowns.fetch(taken);
      for (unsigned int c = 0; c < contents.size(); ++c)
        {
          double part = 0.;
          for (const auto s : space.grid_cells()[c].unknowns)
            part += parts[s];
          contents[c].positive *=
            std::max(0., 1. - part / space.grid_cells()[c].unknowns.size());
        }
      return Utilities::MPI::sum(missing, comm);
    }

    /** Lets all grid cells give. */
    void
    give_to_all(std::vector<Content> &contents,
                const double          missing,
                const MPI_Comm        comm)
    {
      // What is still missing after that is shared by all grid cells in
      // proportion to what they have.
      double positive = 0.;
      for (const Content &content : contents)
        positive += content.positive;
      positive = Utilities::MPI::sum(positive, comm);
      const double factor =
        missing >= positive ? 0. : (positive - missing) / positive;
      for (Content &content : contents)
        content.positive *= factor;
    }
  } // namespace


  template <int dim>
  std::uint64_t
  keep_positive(std::vector<double>       &values,
                const std::vector<double> &weights,
                const GroupedPoints<dim>  &places,
                const SplineSpace<dim>    &space,
                const MPI_Comm             comm)
  {
    // The balance goes grid cell by grid cell, then by splines, then over all
    // of the tissue: doc/theory.md, section 11.3. `after` holds what each grid
    // cell is to have; only in the end values change, by one factor in each
    // grid cell, which keeps their proportions. In most steps nothing is
    // negative, and one reduction shows it.
    std::uint64_t        n_negative = 0;
    std::vector<Content> after = contents(values, weights, places, n_negative);
    n_negative                 = Utilities::MPI::sum(n_negative, comm);
    if (n_negative == 0)
      return 0;
    double missing = 0.;
    for (const Content &content : after)
      missing += content.missing;
    if (Utilities::MPI::sum(missing, comm) > 0.)
      {
        missing = give_to_neighbors(after, space, comm);
        if (missing > 0.)
          give_to_all(after, missing, comm);
      }
    for (unsigned int c = 0; c < after.size(); ++c)
      {
        double before = 0.;
        for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1]; ++p)
          {
            // Cells with a weight of 0, as in a field that still iterates, are
            // only set to zero.
            values[p] = std::max(0., values[p]);
            before += weights[p] * values[p];
          }
        if (after[c].positive < before)
          for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1];
               ++p)
            if (weights[p] > 0.)
              values[p] *= after[c].positive / before;
      }
    return n_negative;
  }


  MORULA_INSTANTIATE(keep_positive);
} // namespace Morula
