// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// See kernels.h. The tangent of a grid cell as products of small matrices,
// whose sums stay in registers: in double or, twice as fast, in single
// precision.

namespace Morula
{
  namespace MORULA_KERNELS
  {
    /** Sizes of the rows and blocks of a grid cell. */
    template <int dim, typename Real>
    struct Sizes
    {
      static constexpr unsigned int n         = Register<Real>::n;
      static constexpr unsigned int n_splines = dim == 2 ? 9 : 27;
      static constexpr unsigned int n_columns = (n_splines + n - 1) / n;

      /** Numbers of a row in memory: the splines, and zeros up to a whole
       *  register. */
      static constexpr unsigned int width = n_columns * n;
      static_assert(width > n_splines, "a Quad must fit behind the last three");

      /** Rows of the registers' tile: all sums and a row of factors fit. */
      static constexpr unsigned int tile_rows = lanes < 8      ? 3 :
                                                n_columns <= 2 ? 9 :
                                                                 4;
      static constexpr unsigned int tile_columns =
        n_columns < 4 ? n_columns : 4;
    };

    /** What the updates of one point take, by direction, for each spline. */
    template <int dimension, typename Number>
    struct PointRows
    {
      using Real                            = Number;
      static constexpr bool         coupled = false;
      static constexpr int          dim     = dimension;
      static constexpr unsigned int width   = Sizes<dim, Real>::width;
      using Rows                            = Real[dim][width];

      alignas(64) Rows g;
      Rows m;
      Rows g_A, g_c, g_both; // times A, c = α - γ and A + c

      /** Fills the rows that are multiples of g. */
      MORULA_INLINE void
      scale(const Real A, const Real c)
      {
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < width; ++a)
            {
              g_A[i][a]    = A * g[i][a];
              g_c[i][a]    = c * g[i][a];
              g_both[i][a] = (A + c) * g[i][a];
            }
      }
    };

    /** The rows of a point under a law with B and C. */
    template <int dim, typename Real>
    struct CoupledPointRows : public PointRows<dim, Real>
    {
      using Base                    = PointRows<dim, Real>;
      static constexpr bool coupled = true;
      typename Base::Rows   b_g;   // b_e g
      typename Base::Rows   b_g_C; // B g + C b_e g

      /** Fills the rows that are multiples of g and b_e g: B b_e g goes with A
       *  g. */
      MORULA_INLINE void
      scale(const Real A, const Real c, const Real B, const Real C)
      {
        Base::scale(A, c);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < Base::width; ++a)
            {
              this->g_A[i][a] += B * b_g[i][a];
              this->g_both[i][a] += B * b_g[i][a];
              b_g_C[i][a] = B * this->g[i][a] + C * b_g[i][a];
            }
      }
    };

    /** A factor of an update: rows of a PointRows. */
    template <typename Point>
    struct Factor
    {
      typename Point::Rows Point::*rows;
      unsigned int                 direction;

      /** This factor's row of a point. */
      MORULA_INLINE const typename Point::Real *
      of(const Point &point) const
      {
        return (point.*rows)[direction];
      }
    };

    /** Adds the sum over points and products of left[a] right[c]. */
    template <typename Point>
    struct Update
    {
      Factor<Point> left, right;
    };

    template <int dim, typename Real>
    using Block = Real[Sizes<dim, Real>::n_splines][Sizes<dim, Real>::width];

    /** That of the rows of a point. */
    template <typename Point>
    using BlockOf = Block<Point::dim, typename Point::Real>;

    /** Adds the updates to R rows and C lanes-wide columns of a block. */
    template <unsigned int R, unsigned int C, typename Point, unsigned int K>
    MORULA_INLINE void
    update_tile(const Point       *points,
                const unsigned int n,
                const Update<Point> (&updates)[K],
                const unsigned int row,
                const unsigned int column,
                BlockOf<Point>    &block)
    {
      using Real                = typename Point::Real;
      using Lanes               = typename Register<Real>::Type;
      using InMemory            = typename Register<Real>::InMemory;
      constexpr unsigned int n_ = Register<Real>::n;
      Lanes                  sums[R][C];
      for (unsigned int r = 0; r < R; ++r)
        for (unsigned int c = 0; c < C; ++c)
          sums[r][c] = *reinterpret_cast<const InMemory *>(
            &block[row + r][column + c * n_]);
      for (unsigned int p = 0; p < n; ++p)
        for (unsigned int k = 0; k < K; ++k)
          {
            const Real *const left  = updates[k].left.of(points[p]) + row;
            const Real *const right = updates[k].right.of(points[p]) + column;
            Lanes             factors[C];
            for (unsigned int c = 0; c < C; ++c)
              factors[c] = *reinterpret_cast<const InMemory *>(right + c * n_);
            for (unsigned int r = 0; r < R; ++r)
              {
                const Lanes factor = all(left[r]);
                for (unsigned int c = 0; c < C; ++c)
                  sums[r][c] += factor * factors[c];
              }
          }
      for (unsigned int r = 0; r < R; ++r)
        for (unsigned int c = 0; c < C; ++c)
          *reinterpret_cast<InMemory *>(&block[row + r][column + c * n_]) =
            sums[r][c];
    }

    /** A row of tiles, from a column on. */
    template <unsigned int R, typename Point, unsigned int K>
    MORULA_INLINE void
    update_rows(const Point       *points,
                const unsigned int n,
                const Update<Point> (&updates)[K],
                const unsigned int row,
                unsigned int       column,
                BlockOf<Point>    &block)
    {
      using S                      = Sizes<Point::dim, typename Point::Real>;
      constexpr unsigned int width = S::width;
      constexpr unsigned int tile_columns = S::tile_columns;
      constexpr unsigned int step         = tile_columns * S::n;
      for (; column + step <= width; column += step)
        update_tile<R, tile_columns>(points, n, updates, row, column, block);
      switch ((width - column) / S::n)
        {
          case 3:
            update_tile<R, 3>(points, n, updates, row, column, block);
            break;
          case 2:
            update_tile<R, 2>(points, n, updates, row, column, block);
            break;
          case 1:
            update_tile<R, 1>(points, n, updates, row, column, block);
            break;
          default:;
        }
    }

    /** @param symmetric only the entries from the diagonal on are needed */
    template <typename Point, unsigned int K>
    MORULA_INLINE void
    update(const Point       *points,
           const unsigned int n,
           const Update<Point> (&updates)[K],
           const bool      symmetric,
           BlockOf<Point> &block)
    {
      using S = Sizes<Point::dim, typename Point::Real>;
      constexpr unsigned int n_splines = S::n_splines;
      constexpr unsigned int tile_rows = S::tile_rows;
      const auto first_column          = [symmetric](const unsigned int row) {
        return symmetric ? row / S::n * S::n : 0;
      };
      unsigned int row = 0;
      for (; row + tile_rows <= n_splines; row += tile_rows)
        update_rows<tile_rows>(
          points, n, updates, row, first_column(row), block);
      constexpr unsigned int rest = n_splines % tile_rows;
      if constexpr (rest != 0)
        update_rows<rest>(points, n, updates, row, first_column(row), block);
    }

    /** The blocks (i, j), i <= j, of the tangent of a grid cell. */
    template <int dim, typename Real>
    struct Blocks
    {
      alignas(64) Block<dim, Real> geometric     = {}; // of all (i, i)
      alignas(64) Block<dim, Real> diagonal[dim] = {};
      // (0, 1), and in 3-D (0, 2), (1, 2)
      alignas(64) Block<dim, Real> other[dim == 2 ? 1 : 3] = {};

      /** Adds the products of the rows of @p n points. */
      MORULA_INLINE void
      update(const PointRows<dim, Real> *points, const unsigned int n)
      {
        using P = PointRows<dim, Real>;
        update_geometric(points, n);
        for (unsigned int i = 0, k = 0; i < dim; ++i)
          {
            const Update<P> ii[] = {{{&P::g_both, i}, {&P::g, i}}};
            MORULA_KERNELS::update(points, n, ii, true, diagonal[i]);
            for (unsigned int j = i + 1; j < dim; ++j, ++k)
              {
                const Update<P> ij[] = {{{&P::g_A, i}, {&P::g, j}},
                                        {{&P::g_c, j}, {&P::g, i}}};
                MORULA_KERNELS::update(points, n, ij, false, other[k]);
              }
          }
      }

      /** Adds the updates of points under a law with B and C. */
      MORULA_INLINE void
      update(const CoupledPointRows<dim, Real> *points, const unsigned int n)
      {
        using P = CoupledPointRows<dim, Real>;
        update_geometric(points, n);
        for (unsigned int i = 0, k = 0; i < dim; ++i)
          {
            const Update<P> ii[] = {{{&P::g_both, i}, {&P::g, i}},
                                    {{&P::b_g_C, i}, {&P::b_g, i}}};
            MORULA_KERNELS::update(points, n, ii, true, diagonal[i]);
            for (unsigned int j = i + 1; j < dim; ++j, ++k)
              {
                const Update<P> ij[] = {{{&P::g_A, i}, {&P::g, j}},
                                        {{&P::b_g_C, i}, {&P::b_g, j}},
                                        {{&P::g_c, j}, {&P::g, i}}};
                MORULA_KERNELS::update(points, n, ij, false, other[k]);
              }
          }
      }

      /** Adds the products m_a · m_b. */
      template <typename Point>
      MORULA_INLINE void
      update_geometric(const Point *points, const unsigned int n)
      {
        Update<Point> mm[dim];
        for (unsigned int i = 0; i < dim; ++i)
          mm[i] = {{&Point::m, i}, {&Point::m, i}};
        MORULA_KERNELS::update(points, n, mm, true, geometric);
      }

      /** Adds all blocks. */
      MORULA_INLINE void
      add_to(double *matrix) const
      {
        constexpr unsigned int n_splines = Sizes<dim, Real>::n_splines;
        constexpr unsigned int n_dofs    = dim * n_splines;
        for (unsigned int i = 0, k = 0; i < dim; ++i)
          {
            for (unsigned int a = 0; a < n_splines; ++a)
              for (unsigned int c = a; c < n_splines; ++c)
                {
                  const double entry     = diagonal[i][a][c] + geometric[a][c];
                  const unsigned int row = i * n_splines + a,
                                     column = i * n_splines + c;
                  matrix[row * n_dofs + column] += entry;
                  if (c > a)
                    matrix[column * n_dofs + row] += entry;
                }
            for (unsigned int j = i + 1; j < dim; ++j, ++k)
              for (unsigned int a = 0; a < n_splines; ++a)
                for (unsigned int c = 0; c < n_splines; ++c)
                  {
                    const unsigned int row    = i * n_splines + a,
                                       column = j * n_splines + c;
                    matrix[row * n_dofs + column] += other[k][a][c];
                    matrix[column * n_dofs + row] += other[k][a][c];
                  }
          }
      }
    };

    /** See AddProducts. */
    template <int dim>
    inline void
    add_products(const SplineProduct<dim> *products,
                 const unsigned int        n,
                 double                   *target,
                 const unsigned int        stride)
    {
      using P                              = SplineProduct<dim>;
      alignas(64) Block<dim, double> block = {};
      const Update<P> both[] = {{{&P::factors, 0}, {&P::factors, 1}}};
      update(products, n, both, false, block);
      constexpr unsigned int n_splines = Sizes<dim, double>::n_splines;
      for (unsigned int a = 0; a < n_splines; ++a)
        for (unsigned int c = 0; c < n_splines; ++c)
          target[a * stride + c] += block[a][c];
    }
  } // namespace MORULA_KERNELS
} // namespace Morula
