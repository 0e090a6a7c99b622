// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/type_tension.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** The grid cell in which spline @p a of a grid cell is centred. */
    template <int dim>
    std::array<int, dim>
    center_of_spline(const GridIndex<dim> &index, const unsigned int a)
    {
      std::array<int, dim> center = index;
      for (unsigned int d = 0; d < dim; ++d)
        center[d] += BSpline<dim>::offset(a, d);
      return center;
    }
  } // namespace


  template <int dim>
  TypeFractions<dim>::TypeFractions(const GridBox<dim> &box,
                                    const unsigned int  n_types)
    : box(box)
    , n_types(n_types)
  {}


  template <int dim>
  void
  TypeFractions<dim>::add(const Point<dim>  &x,
                          const double       V,
                          const unsigned int type)
  {
    const GridIndex<dim> index = box.locate(x);
    if (!is_somewhere || index != here_index)
      {
        // A map keeps its entries where they are when it grows.
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          {
            Sums &of_spline = sums[center_of_spline<dim>(index, a)];
            of_spline.resize(1 + n_types, 0.);
            here[a] = &of_spline;
          }
        here_index   = index;
        is_somewhere = true;
      }
    ++counts[index];
    const SplineValues<dim> splines(box.unit_position(x, index), box.spacing());
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      {
        const double weight = V * splines.value[a];
        (*here[a])[0] += weight;
        (*here[a])[1 + type] += weight;
      }
  }


  template <int dim>
  void
  TypeFractions<dim>::add(const TypeFractions &other)
  {
    for (const auto &[center, more] : other.sums)
      {
        Sums &of_spline = sums[center];
        of_spline.resize(1 + n_types, 0.);
        for (unsigned int k = 0; k <= n_types; ++k)
          of_spline[k] += more[k];
      }
    for (const auto &[index, more] : other.counts)
      counts[index] += more;
  }


  template <int dim>
  bool
  TypeFractions<dim>::is_filled_by(const unsigned int    n,
                                   const GridIndex<dim> &index) const
  {
    const auto own = counts.find(index);
    if (own == counts.end() || own->second != n)
      return false;
    // The splines of a grid cell are centred in it and around it.
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      if (counts.count(center_of_spline<dim>(index, a)) == 0)
        return false;
    return true;
  }


  template <int dim>
  typename TypeFractions<dim>::Values
  TypeFractions<dim>::at(const Point<dim> &x) const
  {
    const GridIndex<dim>    index = box.locate(x);
    const SplineValues<dim> splines(box.unit_position(x, index), box.spacing());
    Values                  values{std::vector<double>(n_types, 0.),
                  std::vector<Tensor<1, dim>>(n_types)};
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      {
        const auto found = sums.find(center_of_spline<dim>(index, a));
        // A spline that vanishes at all cells has no fraction, and no value.
        if (found == sums.end() || found->second[0] <= 0.)
          continue;
        for (unsigned int type = 0; type < n_types; ++type)
          {
            const double fraction = found->second[1 + type] / found->second[0];
            values.fraction[type] += fraction * splines.value[a];
            for (unsigned int d = 0; d < dim; ++d)
              values.gradient[type][d] += fraction * splines.gradient[d][a];
          }
      }
    return values;
  }


  template <int dim>
  std::vector<double>
  TypeFractions<dim>::largest() const
  {
    std::vector<double> found(n_types, 0.);
    for (const auto &[center, of_spline] : sums)
      if (of_spline[0] > 0.)
        for (unsigned int type = 0; type < n_types; ++type)
          found[type] =
            std::max(found[type], of_spline[1 + type] / of_spline[0]);
    return found;
  }


  template class TypeFractions<2>;
  template class TypeFractions<3>;
} // namespace Morula
