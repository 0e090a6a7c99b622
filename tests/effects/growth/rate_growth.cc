// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  RateGrowthParameters
  keys(const std::string &rate,
       const std::string &share     = "",
       const std::string &direction = "")
  {
    RateGrowthParameters parameters;
    parameters.rate        = rate;
    parameters.share_along = share;
    parameters.direction   = direction;
    return parameters;
  }

  /** One cell that grows, with F as the tests set it. */
  template <int dim>
  struct Growing : public LoneCell<dim>
  {
    explicit Growing(const RateGrowthParameters &parameters)
      : law(std::make_unique<RateGrowth<dim>>(parameters, this->setting()))
    {
      Point<dim> X;
      X[0] = 3.;
      this->place(X);
    }

    /** A step in which F becomes what @p moves makes of it and F_g. */
    template <typename Moves>
    void
    step(const double t0, const double t1, const Moves &moves)
    {
      this->reader.past                      = last;
      this->reader.time                      = t0;
      last                                   = {t0, t1};
      const auto                        cell = this->cell();
      const CellView<dim, const double> view(cell);
      const auto                        present = this->present();
      const GrowingCell<dim>            growing{cell.founder_position(),
                                     cell.growth(),
                                     cell.elastic_deformation(),
                                     &view,
                                     &present};
      const Tensor<2, dim>              F_g = law->growth(growing, t0, t1);
      std::vector<double>               row = this->row;
      const CellView<dim, double> after(make_array_view(row), this->columns);
      law->remember(growing, t0, t1, after);
      after.set(this->columns.growth, F_g);
      after.set(this->columns.deformation, moves(cell.F(), F_g));
      this->row = row;
    }

    double
    log_growth()
    {
      return std::log(determinant(this->cell().growth()));
    }

    std::unique_ptr<RateGrowth<dim>> law;
    PastStep                         last;
  };

  template <int dim>
  Tensor<2, dim>
  held(const Tensor<2, dim> &F, const Tensor<2, dim> &)
  {
    return F;
  }

  template <int dim>
  Tensor<2, dim>
  free(const Tensor<2, dim> &, const Tensor<2, dim> &F_g)
  {
    return F_g;
  }

  /** The relative error of growth after 2 days, where the place gives way by
   *  the part @p relief of what the cell grows. k = 0.5 + C ln J_e. */
  template <int dim>
  double
  error_where_the_place_gives_way(const double relief, const double step)
  {
    const double C = 0.83, k = 0.5;
    Growing<dim> cell(keys("0.5 + 0.83*ln(J_e)"));
    const auto moves = [&](const Tensor<2, dim> &, const Tensor<2, dim> &F_g) {
      return std::pow(determinant(F_g), relief / dim) * unit_tensor<dim>();
    };
    const unsigned int n_steps = std::lround(2. / step);
    for (unsigned int n = 0; n < n_steps; ++n)
      cell.step(n * step, (n + 1) * step, moves);
    const double held  = C * (1. - relief);
    const double exact = k / held * -std::expm1(-held * 2.);
    return std::abs(cell.log_growth() / exact - 1.);
  }

  /** Growth along a direction that turns with the state. */
  template <int dim>
  double
  error_of_a_direction_that_turns(const double step)
  {
    Growing<dim> cell(keys("0.5", "1", "1; volume/1000 - 1; 0"));
    const auto   clock = [](const double t) {
      return std::pow(1. + t, 1. / dim) * unit_tensor<dim>();
    };
    const unsigned int n_steps = std::lround(1. / step);
    for (unsigned int n = 0; n < n_steps; ++n)
      cell.step(n * step,
                (n + 1) * step,
                [&](const Tensor<2, dim> &, const Tensor<2, dim> &) {
                  return clock((n + 1) * step);
                });
    // The integral of a ⊗ a with a = (1, t)/√(1 + t²): its off-diagonal entry
    // is that of the rates, to first order of the growth.
    Tensor<2, dim> exact = unit_tensor<dim>();
    constexpr int  fine  = 4000;
    for (int i = 0; i < fine; ++i)
      {
        Tensor<1, dim> a;
        a[0] = 1.;
        a[1] = (i + 0.5) / fine;
        a /= a.norm();
        exact = grown(exact, rate_along_and_across(a, 0.5, 0.), 1. / fine);
      }
    return (cell.cell().growth() - exact).norm();
  }
} // namespace


TEST_2D_3D(RateGrowth, GrowsAlongAndAcross)
{
  Tensor<1, dim> y;
  y[1]                    = 1.;
  const Tensor<2, dim> I  = unit_tensor<dim>();
  const Tensor<2, dim> yy = outer_product(y, y);
  for (const double s : {0., 0.25, 1.})
    {
      Growing<dim> cell(keys("0.3 + 0.1*t", std::to_string(s), "0; 2; 0"));
      // No column of its own: the rate follows no stress.
      EXPECT_FALSE(cell.columns.template find<double>("rate_place").exists());
      cell.step(0., 0.5, free<dim>);
      cell.step(0.5, 1., free<dim>);
      const double         k = 0.35; // the mean over the day
      const Tensor<2, dim> exact =
        std::exp(s * k) * yy + std::exp((1. - s) * k / (dim - 1)) * (I - yy);
      EXPECT_LE((cell.cell().growth() - exact).norm(), 1e-14) << s;
    }
  Growing<dim> isotropic(keys("-0.3"));
  isotropic.step(0., 1., free<dim>);
  EXPECT_LE((isotropic.cell().growth() - std::exp(-0.3 / dim) * I).norm(),
            1e-14);
}


/** k = k0 (1 + h ln J_e): linear, so that each step can be told by hand. */
TEST_2D_3D(RateGrowth, PredictsWhatStressWillSay)
{
  const std::string feedback = "0.5*(1 + 8*ln(J_e))";
  const double      dt = 0.5, c = dt * 0.5 * 8.;
  // Held: exactly 1/8 (1 - e^{-4 t}), with steps of any length.
  Growing<dim> in_box(keys(feedback));
  for (unsigned int n = 0; n < 4; ++n)
    {
      in_box.step(n * dt, (n + 1) * dt, held<dim>);
      EXPECT_NEAR(in_box.log_growth(),
                  -0.125 * std::expm1(-4. * (n + 1) * dt),
                  1e-11);
    }
  // Free: exact from the second step on.
  Growing<dim> outside(keys(feedback));
  outside.step(0., dt, free<dim>);
  EXPECT_NEAR(outside.log_growth(), 0.5 * dt * mean_of_decay(c), 1e-11);
  for (unsigned int n = 1; n < 5; ++n)
    {
      outside.step(n * dt, (n + 1) * dt, free<dim>);
      EXPECT_NEAR(outside.log_growth(), 0.5 * (n + 1) * dt, 1e-4);
    }
  // Explicit steps swing, as c > 2 at twice the length.
  RateGrowthParameters parameters = keys(feedback);
  parameters.predictor            = false;
  Growing<dim> swings(parameters);
  EXPECT_FALSE(swings.columns.template find<double>("rate_place").exists());
  for (unsigned int n = 0; n < 5; ++n)
    swings.step(n, n + 1., held<dim>);
  EXPECT_GT(std::abs(swings.log_growth() - 0.125), 10.);
}


/** A pull along x, in a frame turned by 30 degrees: growth along the pull in
 *  the frame of the cell. */
TEST_2D_3D(RateGrowth, SeeksAStressInTheFrameOfTheCell)
{
  RateGrowthParameters parameters = keys("0");
  parameters.homeostasis          = "0.01";
  parameters.predictor            = false;
  Growing<dim>   cell(parameters);
  Tensor<2, dim> U = unit_tensor<dim>(), R = unit_tensor<dim>();
  U[0][0] = 1.2;
  R[0][0] = R[1][1] = std::cos(0.5);
  R[1][0]           = std::sin(0.5);
  R[0][1]           = -R[1][0];
  cell.cell().set(cell.columns.deformation, R * U);
  const auto sigma = cell.present().quantities().stress;
  EXPECT_GT(std::abs(sigma[0][1]), 0.05); // turned
  cell.step(0., 1., held<dim>);
  const Lame   lame = cell.present().lame();
  const double J    = 1.2;
  const auto   F_g  = cell.cell().growth();
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      {
        const double tau =
          lame.mu * (i == 0 ? 1.2 * 1.2 - 1. : 0.) + lame.lambda * std::log(J);
        EXPECT_NEAR(F_g[i][j], i == j ? std::exp(0.01 * tau / J) : 0., 1e-12);
      }
}


TEST_2D_3D(RateGrowth, IsOfSecondOrderWherePlacesGiveWay)
{
  // In a rigid box it is exact.
  EXPECT_LE(error_where_the_place_gives_way<dim>(0., 0.4), 1e-10);
  EXPECT_LE(error_where_the_place_gives_way<dim>(0.7, 0.4), 2e-3);
  EXPECT_LE(error_where_the_place_gives_way<dim>(0.7, 0.2), 5e-4);
  EXPECT_LE(error_where_the_place_gives_way<dim>(0.7, 0.1), 1.2e-4);
}


/** What follows the state without feedback, as a field does: the trapezoidal
 *  rule for steps of any lengths, but for the last one. */
TEST_2D_3D(RateGrowth, MakesGoodWhatTheLastStepMissed)
{
  for (const std::string rate : {"0.3*volume/1000", "0.3*t*volume/1000"})
    {
      Growing<dim> cell(keys(rate));
      EXPECT_TRUE(cell.columns.template find<double>("rate_expected").exists());
      // F is a clock here: ln det F goes with t².
      double       t = 0., sum = 0.;
      const double steps[] = {0.1, 0.2, 0.2, 0.05, 0.4};
      double       k_begin = 1.;
      for (const double dt : steps)
        {
          const double end   = 1. + (t + dt) * (t + dt);
          const double time  = rate.size() > 15 ? t + 0.5 * dt : 1.;
          const double k_end = end;
          sum += 0.3 * time * 0.5 * dt * (k_begin + k_end);
          const double last = 0.3 * time * 0.5 * dt * (k_end - k_begin);
          cell.step(t,
                    t + dt,
                    [&](const Tensor<2, dim> &, const Tensor<2, dim> &) {
                      return std::pow(end, 1. / dim) * unit_tensor<dim>();
                    });
          EXPECT_NEAR(cell.log_growth(), sum - last, 1e-13);
          t += dt;
          k_begin = k_end;
        }
    }
}


TEST_2D_3D(RateGrowth, FollowsADirectionThatTurns)
{
  const double coarse = error_of_a_direction_that_turns<dim>(0.1),
               fine   = error_of_a_direction_that_turns<dim>(0.05);
  // The first and the last step are of first order, each once.
  EXPECT_LE(fine, 1.5e-3);
  EXPECT_GE(coarse / fine, 3.3);
}
