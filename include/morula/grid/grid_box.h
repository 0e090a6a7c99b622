// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_box_h
#define morula_grid_grid_box_h

#include <deal.II/base/exceptions.h>
#include <deal.II/base/point.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Coordinates (i, j, k) of a grid cell. Along x it spans
   *  offset + [i, i+1] h. */
  template <int dim>
  struct GridIndex : public std::array<int, dim>
  {};

  /**
   * A box of grid cells of the infinite Cartesian background grid. It converts
   * between positions (µm), coordinates (i, j, k), and the number of a grid
   * cell in the box (x fastest).
   */
  template <int dim>
  class GridBox
  {
  public:
    GridBox() = default;

    /**
     * @param first  coordinates of the first grid cell
     * @param n      number of grid cells per direction
     * @param h      grid spacing, µm
     * @param offset position of grid line 0, µm
     */
    GridBox(const GridIndex<dim> &first,
            const GridIndex<dim> &n,
            const double          h,
            const Point<dim>     &offset)
      : first_(first)
      , n_(n)
      , h_(h)
      , offset_(offset)
    {}

    unsigned int
    size() const
    {
      unsigned int product = 1;
      for (const int n : n_)
        product *= n;
      return product;
    }

    const GridIndex<dim> &
    first() const
    {
      return first_;
    }

    const GridIndex<dim> &
    n() const
    {
      return n_;
    }

    double
    spacing() const
    {
      return h_;
    }

    /** Coordinates of the grid cell that holds @p x, in the box or not. */
    GridIndex<dim>
    locate(const Point<dim> &x) const
    {
      GridIndex<dim> index;
      for (unsigned int d = 0; d < dim; ++d)
        index[d] = floor((x[d] - offset_[d]) / h_);
      return index;
    }

    /** Whether a grid cell belongs to the box. */
    bool
    contains(const GridIndex<dim> &index) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (index[d] < first_[d] || index[d] >= first_[d] + n_[d])
          return false;
      return true;
    }

    /** Number of a grid cell of the box. */
    unsigned int
    number(const GridIndex<dim> &index) const
    {
      Assert(contains(index), ExcInternalError());
      unsigned int number = 0;
      for (int d = dim - 1; d >= 0; --d)
        number = number * n_[d] + (index[d] - first_[d]);
      return number;
    }

    /** The coordinates of a grid cell from its number; inverse of number(). */
    GridIndex<dim>
    index(unsigned int number) const
    {
      GridIndex<dim> index;
      for (unsigned int d = 0; d < dim; ++d)
        {
          index[d] = first_[d] + static_cast<int>(number % n_[d]);
          number /= n_[d];
        }
      return index;
    }

    /** The middle of a grid cell, µm. */
    Point<dim>
    center(const GridIndex<dim> &index) const
    {
      Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = offset_[d] + (index[d] + 0.5) * h_;
      return x;
    }

    /** The corner of a grid cell with the smallest coordinates, µm. */
    Point<dim>
    corner(const GridIndex<dim> &index) const
    {
      Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = offset_[d] + index[d] * h_;
      return x;
    }

    /** Position relative to the grid cell @p index, in units of h: inside it,
     *  each coordinate is in [0, 1]. */
    Point<dim>
    unit_position(const Point<dim> &x, const GridIndex<dim> &index) const
    {
      Point<dim> xi;
      for (unsigned int d = 0; d < dim; ++d)
        xi[d] = (x[d] - offset_[d]) / h_ - index[d];
      return xi;
    }

    /** Calls @p visit(number, index) for all grid cells of the box whose
     *  coordinates differ by at most @p radius from those of @p center, x
     *  fastest. */
    template <typename Visitor>
    void
    for_neighbors(const GridIndex<dim> &center,
                  const int             radius,
                  const Visitor        &visit) const
    {
      GridIndex<dim> lower, upper;
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] = center[d] - radius;
          upper[d] = center[d] + radius;
        }
      for_overlap(lower, upper, visit);
    }

    /** Calls @p visit(number, index) for all grid cells of the box with
     *  lower <= index <= upper, x fastest. */
    template <typename Visitor>
    void
    for_overlap(GridIndex<dim> lower,
                GridIndex<dim> upper,
                const Visitor &visit) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] = std::max(lower[d], first_[d]);
          upper[d] = std::min(upper[d], first_[d] + n_[d] - 1);
        }
      for_range(lower, upper, visit);
    }

    /** As for_overlap(), for a range that lies in the box. */
    template <typename Visitor>
    void
    for_range(const GridIndex<dim> &lower,
              const GridIndex<dim> &upper,
              const Visitor        &visit) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (lower[d] > upper[d])
          return;
      GridIndex<dim> index = lower;
      while (true)
        {
          const unsigned int row = number(index);
          for (; index[0] <= upper[0]; ++index[0])
            visit(row + (index[0] - lower[0]), index);
          index[0]       = lower[0];
          unsigned int d = 1;
          while (d < dim && ++index[d] > upper[d])
            {
              index[d] = lower[d];
              ++d;
            }
          if (d == dim)
            return;
        }
    }

  private:
    /** The largest integer that is at most @p x. Every processor that the
     *  library is compiled for has no instruction for std::floor(), and all
     *  passes over points locate them. */
    static int
    floor(const double x)
    {
      const int truncated = static_cast<int>(x);
      return truncated - (x < truncated);
    }

    GridIndex<dim> first_{};
    GridIndex<dim> n_{};
    double         h_ = 1.;
    Point<dim>     offset_;
  };

  /**
   * Points sorted by their grid cells, to visit those near a place: it looks at
   * all points of the grid cells around.
   *
   * CGAL, Boost and deal.II offer trees instead. Made anew for the divisions of
   * each step, CGAL's tree took 1.8 s of the 61 s of Fig. 4b; this takes 0.4 s,
   * since the cells are sorted by grid cell already.
   */
  template <int dim>
  class PointBins
  {
  public:
    /** @param box       holds all points
     *  @param positions µm; must outlive this */
    PointBins(const GridBox<dim> &box, const std::vector<Point<dim>> &positions)
      : box(box)
      , positions(positions)
    {
      std::vector<unsigned int> numbers; // of the points' grid cells
      numbers.reserve(positions.size());
      for (const Point<dim> &x : positions)
        numbers.push_back(box.number(box.locate(x)));
      indices.resize(positions.size());
      std::iota(indices.begin(), indices.end(), 0u);
      if (!std::is_sorted(numbers.begin(), numbers.end()))
        std::stable_sort(indices.begin(),
                         indices.end(),
                         [&](const unsigned int i, const unsigned int j) {
                           return numbers[i] < numbers[j];
                         });
      // Where there are not many more grid cells than points a table of all of
      // them says where their points begin, without a search.
      bins.reserve(positions.size());
      for (const unsigned int i : indices)
        bins.push_back(numbers[i]);
      if (box.size() / 32 < positions.size())
        for (unsigned int number = 0, k = 0; number <= box.size(); ++number)
          {
            while (k < bins.size() && bins[k] < number)
              ++k;
            begins.push_back(k);
          }
    }

    /** Calls @p visit(i) for the points within @p radius (µm) of @p center, in
     *  no particular order. */
    template <typename Visitor>
    void
    visit_within(const Point<dim> &center,
                 const double      radius,
                 const Visitor    &visit) const
    {
      Tensor<1, dim> corner;
      for (unsigned int d = 0; d < dim; ++d)
        corner[d] = radius;
      GridIndex<dim> lower = box.locate(center - corner);
      GridIndex<dim> upper = box.locate(center + corner);
      lower[0]             = std::max(lower[0], box.first()[0]);
      upper[0] = std::min(upper[0], box.first()[0] + box.n()[0] - 1);
      if (lower[0] > upper[0])
        return;
      // The numbers of a row of grid cells along x follow one another.
      const unsigned int more = upper[0] - lower[0];
      upper[0]                = lower[0];
      box.for_overlap(lower,
                      upper,
                      [&](const unsigned int first, const auto &) {
                        const unsigned int end = begin_of(first + more + 1);
                        for (unsigned int k = begin_of(first); k < end; ++k)
                          if (positions[indices[k]].distance_square(center) <=
                              radius * radius)
                            visit(indices[k]);
                      });
    }

  private:
    /** How many points lie in grid cells before this one. */
    unsigned int
    begin_of(const unsigned int number) const
    {
      return begins.empty() ?
               std::lower_bound(bins.begin(), bins.end(), number) -
                 bins.begin() :
               begins[number];
    }

    const GridBox<dim>            &box;
    const std::vector<Point<dim>> &positions;
    std::vector<unsigned int>      indices; // of the points, by grid cell
    std::vector<unsigned int>      bins;    // their grid cells, in this order
    std::vector<unsigned int>      begins;  // of grid cells, or none
  };
} // namespace Morula

#endif
