// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// The internal force on grid cells of 125 particles (2-D: 25), plain and
// vectorised, of each material, with the volumetric strain of each point,
// pooled, next to what the core can do: a matrix product and the
// triad of STREAM.

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/materials/material.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <benchmark/benchmark.h>

#include <random>

using

#include "common/pools.h"

  namespace Morula;

namespace
{
  constexpr unsigned int n_grid_cells = 64;

  /** Of a grid cell. */
  template <int dim>
  constexpr unsigned int n_points = dim == 2 ? 25 : 125;

  /** A particle's part of a tangent in 3-D, in the smallest known form. */
  constexpr double flop_of_tangent = 11e3;

  template <int dim>
  MaterialPoints<dim>
  random_points(const Material &material)
  {
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> uniform(0., 1.);
    MaterialPoints<dim>                    points;
    points.h        = 50.;
    points.material = &material;
    points.lame     = {lame(1., 0.4)};
    points.offsets.push_back(0);
    for (unsigned int c = 0; c < n_grid_cells; ++c)
      {
        for (unsigned int p = 0; p < n_points<dim>; ++p)
          {
            Point<dim>        xi;
            ElasticState<dim> state;
            for (unsigned int d = 0; d < dim; ++d)
              {
                xi[d] = uniform(generator);
                for (unsigned int e = 0; e < dim; ++e)
                  state.A[d][e] = (d == e) + 0.1 * uniform(generator);
              }
            points.xi.push_back(xi);
            state.W = 1000. * (1. + uniform(generator));
            points.current.push_back(state);
          }
        points.offsets.push_back(points.xi.size());
      }
    pool(points);
    return points;
  }

  template <int dim>
  void
  assemble(benchmark::State                       &state,
           const Material                         *material,
           const VolumetricStrain                  form,
           const std::string                      &kernel,
           const typename LocalSystem<dim>::Wanted wanted)
  {
    const MaterialPoints<dim> points = random_points<dim>(*material);
    const auto                term   = internal_force(points, form, kernel);
    std::mt19937              generator(2);
    std::uniform_real_distribution<double> uniform(-2., 2.);
    LocalField<dim>                        field;
    for (auto &component : field.coefficient)
      for (double &value : component)
        value = uniform(generator);
    LocalSystem<dim> system(wanted);
    for (auto _ : state)
      for (unsigned int c = 0; c < n_grid_cells; ++c)
        {
          system.clear();
          term->add(c, field, GrowthAt::current, system);
          benchmark::DoNotOptimize(system.residual.data());
          benchmark::DoNotOptimize(system.matrix.data());
        }
    const double n = 1. * n_grid_cells * n_points<dim> * state.iterations();
    state.counters["seconds_per_point"] = benchmark::Counter(
      n, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    if (dim == 3 && wanted == LocalSystem<dim>::tangent)
      state.counters["flop_rate"] =
        benchmark::Counter(n * flop_of_tangent, benchmark::Counter::kIsRate);
  }

  /** By the BLAS that deal.II is linked to. */
  void
  matrix_product(benchmark::State &state)
  {
    const unsigned int       n = 1000;
    LAPACKFullMatrix<double> A(n), B(n), C(n);
    A = 0.5;
    B = 0.25;
    for (auto _ : state)
      {
        A.mmult(C, B);
        benchmark::DoNotOptimize(C(0, 0));
      }
    state.counters["flop_rate"] =
      benchmark::Counter(2. * n * n * n * state.iterations(),
                         benchmark::Counter::kIsRate);
  }

  void
  triad(benchmark::State &state)
  {
    const std::size_t   n = 20000000; // 480 MB, larger than caches
    std::vector<double> a(n, 1.), b(n, 2.), c(n, 3.);
    for (auto _ : state)
      {
        for (std::size_t i = 0; i < n; ++i)
          a[i] = b[i] + 0.5 * c[i];
        benchmark::DoNotOptimize(a.data());
        benchmark::ClobberMemory();
      }
    state.counters["byte_rate"] =
      benchmark::Counter(24. * n * state.iterations(),
                         benchmark::Counter::kIsRate);
  }

  /** Of all materials, forms of the volumetric strain, and kernels. */
  template <int dim>
  void
  register_assemblies(const Materials &materials)
  {
    const std::pair<std::string, VolumetricStrain> forms[] = {
      {"pointwise", VolumetricStrain::pointwise},
      {"pooled", VolumetricStrain::pooled}};
    const std::pair<std::string, typename LocalSystem<dim>::Wanted> parts[] = {
      {"tangent", LocalSystem<dim>::tangent},
      {"residual", LocalSystem<dim>::energy_and_residual}};
    for (const std::string &name : materials.names())
      {
        const Material          &material = *materials.find(name);
        std::vector<std::string> kernels  = {"plain"};
        for (const auto &available : material.vector_kernels<dim>())
          kernels.push_back(available.name);
        for (const auto &[form_name, form] : forms)
          for (const auto &[part, wanted] : parts)
            for (const std::string &kernel : kernels)
              benchmark::RegisterBenchmark((std::to_string(dim) + "-D/" + name +
                                            '/' + form_name + '/' + part + '/' +
                                            kernel)
                                             .c_str(),
                                           assemble<dim>,
                                           &material,
                                           form,
                                           kernel,
                                           wanted);
      }
  }
} // namespace

int
main(int argc, char **argv)
{
  benchmark::RegisterBenchmark("matrix product", matrix_product);
  const Materials materials;
  register_assemblies<3>(materials);
  register_assemblies<2>(materials);
  benchmark::RegisterBenchmark("triad", triad);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
    return 1;
  benchmark::RunSpecifiedBenchmarks();
}
