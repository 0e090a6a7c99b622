// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// See kernels.h. The tangent of a grid cell as products of small matrices,
// whose sums stay in registers.

namespace Morula
{
  namespace MORULA_KERNELS
  {
    /** Sizes of the rows and blocks of a grid cell. */
    template <int dim>
    struct Sizes
    {
      static constexpr unsigned int n_splines = dim == 2 ? 9 : 27;
      static constexpr unsigned int n_columns = (n_splines + lanes - 1) / lanes;

      /** Of a row in memory: the splines and zeros. */
      static constexpr unsigned int width = n_columns * lanes;
      static_assert(width > n_splines, "a Quad must fit behind the last three");

      /** Rows of the registers' tile: all sums and a row of factors fit. */
      static constexpr unsigned int tile_rows = lanes == 8 ? 4 : 3;
      static constexpr unsigned int tile_columns =
        n_columns < 4 ? n_columns : 4;
    };

    /** By direction, for each spline: what the updates of one point take. */
    template <int dimension>
    struct PointRows
    {
      static constexpr int          dim   = dimension;
      static constexpr unsigned int width = Sizes<dim>::width;
      using Rows                          = double[dim][width];

      alignas(64) Rows g;
      Rows m;
      Rows g_A, g_c, g_both; // times A, c = α - γ and A + c

      /** Fills the rows that are multiples of g. */
      MORULA_INLINE void
      scale(const double A, const double c)
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

    /** The same of a law with B and C. */
    template <int dim>
    struct CoupledPointRows : public PointRows<dim>
    {
      typename PointRows<dim>::Rows b_g;   // b_e g
      typename PointRows<dim>::Rows b_g_C; // B g + C b_e g

      /** Fills the rows that are multiples of g and b_e g: B b_e g goes with A
       *  g. */
      MORULA_INLINE void
      scale(const double A, const double c, const double B, const double C)
      {
        PointRows<dim>::scale(A, c);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < PointRows<dim>::width; ++a)
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
      MORULA_INLINE const double *
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

    template <int dim>
    using Block = double[Sizes<dim>::n_splines][Sizes<dim>::width];

    /** Adds the updates to R rows and C lanes-wide columns of a block. */
    template <unsigned int R, unsigned int C, typename Point, unsigned int K>
    MORULA_INLINE void
    update_tile(const Point       *points,
                const unsigned int n,
                const Update<Point> (&updates)[K],
                const unsigned int row,
                const unsigned int column,
                Block<Point::dim> &block)
    {
      Lanes sums[R][C];
      for (unsigned int r = 0; r < R; ++r)
        for (unsigned int c = 0; c < C; ++c)
          sums[r][c] = *reinterpret_cast<const LanesInMemory *>(
            &block[row + r][column + c * lanes]);
      for (unsigned int p = 0; p < n; ++p)
        for (unsigned int k = 0; k < K; ++k)
          {
            const double *const left  = updates[k].left.of(points[p]) + row;
            const double *const right = updates[k].right.of(points[p]) + column;
            Lanes               factors[C];
            for (unsigned int c = 0; c < C; ++c)
              factors[c] =
                *reinterpret_cast<const LanesInMemory *>(right + c * lanes);
            for (unsigned int r = 0; r < R; ++r)
              {
                const Lanes factor = all(left[r]);
                for (unsigned int c = 0; c < C; ++c)
                  sums[r][c] += factor * factors[c];
              }
          }
      for (unsigned int r = 0; r < R; ++r)
        for (unsigned int c = 0; c < C; ++c)
          *reinterpret_cast<LanesInMemory *>(
            &block[row + r][column + c * lanes]) = sums[r][c];
    }

    /** A row of tiles, from a column on. */
    template <unsigned int R, typename Point, unsigned int K>
    MORULA_INLINE void
    update_rows(const Point       *points,
                const unsigned int n,
                const Update<Point> (&updates)[K],
                const unsigned int row,
                unsigned int       column,
                Block<Point::dim> &block)
    {
      constexpr unsigned int width        = Sizes<Point::dim>::width;
      constexpr unsigned int tile_columns = Sizes<Point::dim>::tile_columns;
      constexpr unsigned int step         = tile_columns * lanes;
      for (; column + step <= width; column += step)
        update_tile<R, tile_columns>(points, n, updates, row, column, block);
      switch ((width - column) / lanes)
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
           const bool         symmetric,
           Block<Point::dim> &block)
    {
      constexpr unsigned int n_splines = Sizes<Point::dim>::n_splines;
      constexpr unsigned int tile_rows = Sizes<Point::dim>::tile_rows;
      const auto first_column          = [symmetric](const unsigned int row) {
        return symmetric ? row / lanes * lanes : 0;
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
    template <int dim>
    struct Blocks
    {
      alignas(64) Block<dim> geometric     = {}; // of all (i, i)
      alignas(64) Block<dim> diagonal[dim] = {};
      // (0, 1), and in 3-D (0, 2), (1, 2)
      alignas(64) Block<dim> other[dim == 2 ? 1 : 3] = {};

      /** Adds the products of the rows of @p n points. */
      MORULA_INLINE void
      update(const PointRows<dim> *points, const unsigned int n)
      {
        using P = PointRows<dim>;
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

      /** The same of a law with B and C. */
      MORULA_INLINE void
      update(const CoupledPointRows<dim> *points, const unsigned int n)
      {
        using P = CoupledPointRows<dim>;
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
        constexpr unsigned int n_splines = Sizes<dim>::n_splines;
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
  } // namespace MORULA_KERNELS
} // namespace Morula
