// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

// F_g of law, cycle, contraction and relaxation together: doc/theory.md (8.7).

namespace
{
  /** Which effects there are. */
  struct Wanted
  {
    bool        law, cycle, contraction;
    std::string relaxation_time = "0";
  };

  const std::string stretch = "1 - 0.2*t*(X > 0)";

  template <int dim>
  Tensor<1, dim>
  direction()
  {
    Tensor<1, dim> a;
    a[0] = 0.6;
    a[1] = 0.8;
    return a;
  }

  double
  theta(const double t)
  {
    return 1. + 0.1 * t;
  }

  template <int dim>
  CellDevelopment<dim>
  development(const Wanted &wanted)
  {
    Scene scene;
    scene.dimension = dim;
    if (wanted.law)
      {
        scene.growth_law                                = "isotropic";
        scene.keys<IsotropicGrowthParameters>().stretch = "1 + 0.1*t";
      }
    if (wanted.cycle)
      {
        scene.keys<CellCycleParameters>().law   = "cell cycle";
        scene.keys<CellCycleParameters>().start = "waiting";
      }
    if (wanted.contraction)
      {
        auto &contraction     = scene.keys<ContractionParameters>();
        contraction.stretch   = stretch;
        contraction.direction = dim == 2 ? "3; 4" : "3; 4; 0";
      }
    scene.keys<RelaxationParameters>().time = wanted.relaxation_time;
    return development_of<dim>(scene);
  }

  /** F_a of theory at a cell. */
  template <int dim>
  Tensor<2, dim>
  contracted(const CellView<dim, const double> &cell, const double t)
  {
    const double gamma = cell.founder_position()[0] > 0. ? 1. - 0.2 * t : 1.;
    EXPECT_EQ(cell.get(cell.columns().template find<double>("contraction")),
              gamma);
    return active_strain(direction<dim>(), gamma, true);
  }

  template <int dim>
  void
  check_product(const Wanted &wanted)
  {
    const auto relaxing = development<dim>(wanted);
    const auto elastic =
      development<dim>({wanted.law, wanted.cycle, wanted.contraction});
    SmallBall<dim> tissue(relaxing), other(elastic);
    const bool     is_complete = wanted.relaxation_time == "1e-9";
    const auto     relaxed =
      relaxing.columns().template find<Tensor<2, dim>>("relaxed");
    EXPECT_EQ(relaxed.exists(), !wanted.cycle);
    double flow = 0.;
    for (const double t : {0., 0.2, 0.4, 0.6, 0.8})
      {
        grow(tissue, relaxing, t, t + 0.2);
        grow(other, elastic, t, t + 0.2);
        for (unsigned int p = 0; p < tissue.cells().size(); ++p)
          {
            const auto           cell = tissue.cells()[p];
            const Tensor<2, dim> F_g  = cell.growth();
            Tensor<2, dim>       product =
              wanted.cycle ? relaxing.cycle()->growth(relaxing.clock(cell),
                                                      cell.founder_position(),
                                                      t + 0.2) :
                                   cell.get(relaxed);
            if (wanted.law)
              product *= theta(t + 0.2);
            if (wanted.contraction)
              product = contracted(cell, t + 0.2) * product;
            EXPECT_LE((F_g - product).norm(), 1e-13);

            const Tensor<2, dim> without = other.cells()[p].growth();
            flow += (F_g - without).norm();
            EXPECT_NEAR(determinant(F_g), determinant(without), 1e-13);
            // What can be seen of the cycle is the same.
            if (wanted.cycle)
              {
                const auto state = relaxing.clock(cell),
                           as_of = elastic.clock(other.cells()[p]);
                EXPECT_EQ(state.phase, as_of.phase);
                EXPECT_EQ(state.event_time, as_of.event_time);
                EXPECT_EQ(state.axis, as_of.axis);
              }
            // Free of shear in the end.
            const Tensor<2, dim> F_e = cell.elastic_deformation();
            const auto           b   = symmetrize(F_e * transpose(F_e));
            if (is_complete)
              {
                EXPECT_LE(deviator(b).norm(), 1e-6);
              }
            if (wanted.relaxation_time == "0*t")
              {
                EXPECT_EQ(F_g, without);
              }
          }
      }
    EXPECT_EQ(flow > 1., wanted.relaxation_time != "0*t");
  }

  /** The von Mises stress of the cells, one cell after the other, after a step
   *  of complete relaxation. */
  template <int dim>
  std::vector<double>
  stress_after(const std::string &energy_per, const std::string &yield_stress)
  {
    Scene scene;
    scene.dimension                                 = dim;
    scene.growth_law                                = "isotropic";
    scene.material.energy_per                       = energy_per;
    scene.keys<RelaxationParameters>().time         = "1e-9";
    scene.keys<RelaxationParameters>().yield_stress = yield_stress;
    scene.keys<IsotropicGrowthParameters>().stretch = "1.1";
    const TissueMaterial material(scene.material);
    const auto           growth = development_of<dim>(scene);
    SmallBall<dim>       tissue(growth);
    grow(tissue, growth, 0., 1.);
    std::vector<double> stresses;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const SymmetricTensor<2, 3> sigma =
          cell_quantities(tissue.cells()[p],
                          material.material(),
                          lame(1., 0.4),
                          material.per_grown_volume())
            .stress;
        SymmetricTensor<2, dim> in_plane;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = i; j < dim; ++j)
            in_plane[i][j] = sigma[i][j];
        stresses.push_back(std::sqrt(1.5) * deviator(in_plane).norm());
      }
    return stresses;
  }
} // namespace


TEST_2D_3D(PartsOfGrowth, AreMultipliedInTheirOrder)
{
  for (const std::string tau : {"1e-9", "0.3 + 0.2*generation", "0*t"})
    for (unsigned int i = 0; i < 8; ++i)
      {
        SCOPED_TRACE(tau + ", " + std::to_string(i));
        check_product<dim>({i % 2 == 1, i / 2 % 2 == 1, i / 4 == 1, tau});
      }
}


/** The yield stress is one of the stress that the files show. */
TEST_2D_3D(PartsOfGrowth, YieldAtATrueStress)
{
  for (const std::string per : {"initial volume", "grown volume"})
    {
      SCOPED_TRACE(per);
      const auto   elastic = stress_after<dim>(per, "1000");
      const auto   yielded = stress_after<dim>(per, "0.02 + 0*J_e");
      unsigned int flowed  = 0;
      for (std::size_t i = 0; i < elastic.size(); ++i)
        {
          EXPECT_NEAR(yielded[i], std::min(elastic[i], 0.02), 1e-8);
          flowed += elastic[i] > 0.021;
        }
      EXPECT_GT(flowed, 10u);
    }
}
