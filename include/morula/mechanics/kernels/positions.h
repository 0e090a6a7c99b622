// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// See kernels.h. How points move in a step.

namespace Morula
{
  namespace MORULA_KERNELS
  {
    /** Component i of the displacement. */
    template <int dim>
    MORULA_INLINE Lanes
    displacement(const Points<dim> &points,
                 const double      *coefficients,
                 const unsigned int i)
    {
      Lanes u = {};
      for (unsigned int z = 0; z < n_yz<dim> / 3; ++z)
        {
          Lanes value = {};
          for (unsigned int y = 0; y < 3; ++y)
            {
              const double *const c =
                coefficients + 3 * (n_yz<dim> * i + 3 * z + y);
              const auto &N = points.N[0];
              value +=
                points.N[1][y] * (N[0] * c[0] + N[1] * c[1] + N[2] * c[2]);
            }
          if constexpr (dim == 2)
            u += value;
          else
            u += points.N[2][z] * value;
        }
      return u;
    }

    /** See FindMotions. */
    template <int dim>
    inline void
    find_motions(const KernelInput &input, double *motions)
    {
      constexpr unsigned int n_numbers = dim + dim * dim;
      for (unsigned int first = 0; first < input.n; first += lanes)
        {
          const unsigned int n =
            input.n - first < lanes ? input.n - first : lanes;
          Numbers xi[dim];
          for (unsigned int l = 0; l < lanes; ++l)
            for (unsigned int d = 0; d < dim; ++d)
              xi[d][l] = input.xi[dim * (first + (l < n ? l : 0)) + d];
          Lanes places[dim];
          for (unsigned int d = 0; d < dim; ++d)
            places[d] = xi[d];
          Points<dim> points;
          find_splines(places, input.h, points);
          Numbers numbers[n_numbers];
          for (unsigned int i = 0; i < dim; ++i)
            {
              numbers[i] = displacement(points, input.coefficients, i);
              Lanes f[dim];
              step_deformation(points, input.coefficients, i, f);
              for (unsigned int j = 0; j < dim; ++j)
                numbers[dim + dim * i + j] = f[j];
            }
          for (unsigned int l = 0; l < n; ++l)
            for (unsigned int k = 0; k < n_numbers; ++k)
              motions[n_numbers * (first + l) + k] = numbers[k][l];
        }
    }
  } // namespace MORULA_KERNELS
} // namespace Morula
