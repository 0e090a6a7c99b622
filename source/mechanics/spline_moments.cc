// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/mechanics/spline_moments.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Coefficients of polynomials of s = ξ - 1/2: by power, then by number of
     *  the polynomial. */
    template <unsigned int n_powers, unsigned int n_polynomials>
    using Polynomials = std::array<std::array<double, n_polynomials>, n_powers>;

    /** The splines in one direction: ½(½-s)², ¾-s², ½(½+s)². */
    constexpr double splines[3][3] = {{0.125, -0.5, 0.5},
                                      {0.75, 0., -1.},
                                      {0.125, 0.5, 0.5}};

    /** Numbers of the pairs of splines in one direction. */
    constexpr unsigned int n_pairs     = 6;
    constexpr unsigned int pairs[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

    /** The splines as polynomials of some degree. */
    template <unsigned int n_powers>
    constexpr Polynomials<n_powers, 3>
    single()
    {
      Polynomials<n_powers, 3> result{};
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          result[i][a] = splines[a][i];
      return result;
    }

    /** N_a N_b of the pairs, or with as many derivatives by s of each. */
    template <unsigned int n_powers>
    constexpr Polynomials<n_powers, n_pairs>
    products(const unsigned int n_derivatives)
    {
      Polynomials<n_powers, n_pairs> result{};
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b <= a; ++b)
          // The derivative by s of s^i is i s^(i-1): so the first power that
          // counts is that of the derivative, and the degree falls by one for
          // each factor.
          for (unsigned int i = n_derivatives; i < 3; ++i)
            for (unsigned int j = n_derivatives; j < 3; ++j)
              result[i + j - 2 * n_derivatives][pairs[a][b]] +=
                (n_derivatives == 0 ? 1. : i * j) * splines[a][i] *
                splines[b][j];
      return result;
    }

    /** Room for sums over all powers, pairs or splines of all directions. */
    template <int dim>
    using Sums = std::array<double, Utilities::pow(n_pairs, dim)>;

    /**
     * Adds the sums of polynomials of one direction from those of its powers.
     * This direction comes first in @p sums, and last in @p result.
     * @param n_others numbers of each power
     */
    template <std::size_t n_powers, std::size_t n_polynomials>
    void
    add_direction(const std::array<std::array<double, n_polynomials>, n_powers>
                                     &polynomials,
                  const double *const sums,
                  const unsigned int  n_others,
                  double *const       result)
    {
      // In `sums` the direction's powers are the slowest index, in `result` its
      // polynomials are the fastest. So the next direction is the slowest one
      // then, and after all directions have had their turn the order is the old
      // one again.
      for (unsigned int q = 0; q < n_others; ++q)
        {
          double *const row = &result[q * n_polynomials];
          for (unsigned int i = 0; i < n_powers; ++i)
            for (unsigned int r = 0; r < n_polynomials; ++r)
              row[r] += polynomials[i][r] * sums[i * n_others + q];
        }
    }

    /** Sums of products of polynomials of all directions from sums of powers.
     */
    template <int dim, std::size_t n_powers, std::size_t n_polynomials>
    Sums<dim>
    sums_of_products(const std::array<std::array<double, n_polynomials>,
                                      n_powers> &polynomials,
                     const double *const         powers)
    {
      // The powers of one direction after the other give way to polynomials;
      // what is left of the others does not change. Each step costs a small
      // product for all powers of the other directions: doc/theory.md, section
      // 11.6.
      Sums<dim> sums{};
      std::copy_n(powers, Utilities::pow<int>(n_powers, dim), sums.begin());
      for (unsigned int d = 0; d < dim; ++d)
        {
          Sums<dim> next{};
          add_direction(polynomials,
                        sums.data(),
                        Utilities::pow<int>(n_powers, dim - 1 - d) *
                          Utilities::pow<int>(n_polynomials, d),
                        next.data());
          sums = next;
        }
      return sums;
    }

    /** Σ_p w_p N_a from sums of powers. */
    template <int dim, std::size_t n_powers>
    std::array<double, BSpline<dim>::n>
    sums_of_splines(const double *const powers)
    {
      constexpr auto  polynomials = single<n_powers>();
      const Sums<dim> sums        = sums_of_products<dim>(polynomials, powers);
      // The last direction runs fastest there, whereas the first one does in
      // the numbering of splines.
      std::array<double, BSpline<dim>::n> result;
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          unsigned int number = 0;
          for (unsigned int d = 0; d < dim; ++d)
            number = 3 * number + BSpline<dim>::offset(a, d) + 1;
          result[a] = sums[number];
        }
      return result;
    }

    /** Σ_p (D V)_p ∇N_a·∇N_b + (k V)_p N_a N_b by pairs in each direction. */
    template <int dim>
    Sums<dim>
    sums_of_pairs(const MatrixMoments<dim> &moments,
                  const double              h,
                  const bool                with_values)
    {
      // A product of gradients is a sum over directions in which one direction
      // has derivatives and all others have values. `before` carries sums in
      // which no direction has had its derivatives yet, `after` those in which
      // one has, together with the products of values: a direction either
      // passes on `after`, or moves `before` there. So both parts of the
      // matrix, doc/theory.md (11.2), come from one pass over the directions.
      constexpr auto values = products<5>(0);
      auto           slopes = products<3>(1);
      for (auto &power : slopes)
        for (double &coefficient : power)
          coefficient /= h * h;
      // Sums before one direction had its derivatives, and after.
      Sums<dim> before{}, after{};
      std::copy(moments.sums[0].begin(), moments.sums[0].end(), before.begin());
      if (with_values)
        std::copy(moments.sums[1].begin(),
                  moments.sums[1].end(),
                  after.begin());
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int n_others =
            Utilities::pow(5, dim - 1 - d) * Utilities::pow(n_pairs, d);
          Sums<dim> next_before{}, next_after{};
          add_direction(values, after.data(), n_others, next_after.data());
          add_direction(slopes, before.data(), n_others, next_after.data());
          // In the last direction nothing can come later.
          if (d + 1 < dim)
            add_direction(values, before.data(), n_others, next_before.data());
          before = next_before;
          after  = next_after;
        }
      return after;
    }

    /** Places in sums_of_pairs() of the entries of a matrix. */
    template <int dim>
    std::array<unsigned int, BSpline<dim>::n * BSpline<dim>::n>
    places_of_pairs()
    {
      // The pair of each direction is a digit in base n_pairs, the first
      // direction's the most significant one.
      constexpr unsigned int          n = BSpline<dim>::n;
      std::array<unsigned int, n * n> places{};
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          for (unsigned int d = 0; d < dim; ++d)
            places[a * n + b] = n_pairs * places[a * n + b] +
                                pairs[BSpline<dim>::offset(a, d) + 1]
                                     [BSpline<dim>::offset(b, d) + 1];
      return places;
    }
  } // namespace


  template <int dim>
  void
  add_matrix(const MatrixMoments<dim> &moments,
             const double              h,
             const bool                lumped,
             std::vector<double>      &matrix)
  {
    constexpr unsigned int n = BSpline<dim>::n;
    // The table is the same for all grid cells; a static is made once.
    static const auto places = places_of_pairs<dim>();
    const Sums<dim>   sums   = sums_of_pairs(moments, h, !lumped);
    for (unsigned int k = 0; k < n * n; ++k)
      matrix[k] += sums[places[k]];
    // A lumped field has only gradients in the product; the values stand on the
    // diagonal as row sums.
    if (!lumped)
      return;
    const auto diagonal = sums_of_splines<dim, 5>(moments.sums[1].data());
    for (unsigned int a = 0; a < n; ++a)
      matrix[a * n + a] += diagonal[a];
  }


  template <int dim>
  std::vector<double>
  mass_matrix(const MassMoments<dim> &moments)
  {
    static const auto places = places_of_pairs<dim>();
    constexpr auto    values = products<5>(0);
    const Sums<dim>   sums =
      sums_of_products<dim>(values, moments.sums[0].data());
    std::vector<double> matrix;
    matrix.reserve(places.size());
    for (const unsigned int place : places)
      matrix.push_back(sums[place]);
    return matrix;
  }


  template <int dim>
  std::array<double, BSpline<dim>::n>
  spline_sums(const LoadMoments<dim> &moments)
  {
    return sums_of_splines<dim, 3>(moments.sums[0].data());
  }


  template <int dim>
  double
  value_at(const LocalField<dim, 1> &field, const Point<dim> &xi)
  {
    // These are the splines in each direction, doc/theory.md (2.3). Summing
    // direction by direction needs half the products of a sum over all splines.
    double N[dim][3];
    for (unsigned int d = 0; d < dim; ++d)
      {
        N[d][0] = 0.5 * (1. - xi[d]) * (1. - xi[d]);
        N[d][1] = 0.5 + xi[d] - xi[d] * xi[d];
        N[d][2] = 0.5 * xi[d] * xi[d];
      }
    const auto &u   = field.coefficient[0];
    double      sum = 0.;
    for (unsigned int k = 0, a = 0; k < (dim == 3 ? 3 : 1); ++k)
      {
        double in_plane = 0.;
        for (unsigned int j = 0; j < 3; ++j, a += 3)
          in_plane += N[1][j] * (N[0][0] * u[a] + N[0][1] * u[a + 1] +
                                 N[0][2] * u[a + 2]);
        sum += dim == 3 ? N[dim - 1][k] * in_plane : in_plane;
      }
    return sum;
  }


  MORULA_INSTANTIATE(add_matrix);
  MORULA_INSTANTIATE(mass_matrix);
  MORULA_INSTANTIATE(spline_sums);
  MORULA_INSTANTIATE(value_at);
} // namespace Morula
