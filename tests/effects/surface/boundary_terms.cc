// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  constexpr double area = 30.; // a⁰

  TissueMaterial
  material(const std::string &E,
           const double       nu,
           const bool         grown             = false,
           const std::string &volumetric_strain = "pointwise")
  {
    MaterialParameters parameters;
    parameters.youngs_modulus    = E;
    parameters.poissons_ratio    = nu;
    parameters.energy_per        = grown ? "grown volume" : "initial volume";
    parameters.volumetric_strain = volumetric_strain;
    return TissueMaterial(parameters);
  }

  /** Keys of the conditions, and how stiffly these hold. */
  struct Given
  {
    std::vector<std::string> settings;
    NitscheParameters        nitsche;

    void
    set(const std::string &name, const std::string &value)
    {
      settings.push_back("Boundary conditions/" + name + "=" + value);
    }
  };

  template <int dim>
  BoundaryConditions<dim>
  conditions_of(const Given &given)
  {
    NitscheParameters nitsche = given.nitsche;
    nitsche.form              = "symmetric"; // of all tests here
    return {std::move(effects_of<dim>(scene_of(given.settings)).conditions),
            nitsche};
  }

  /**
   * A ball with boundary points where the axes leave it, each with its
   * condition. Points are displaced by @p moved from their initial positions,
   * and have the deformation gradient @p F.
   */
  template <int dim>
  struct Problem
  {
    const BoundaryConditions<dim>     conditions;
    const CellDevelopment<dim>        growth;
    Tissue<dim>                       tissue;
    std::unique_ptr<SplineSpace<dim>> space;

    Problem(const Given          &parameters,
            CellDevelopment<dim>  growth_of_cells,
            const Tensor<1, dim> &moved = Tensor<1, dim>(),
            const Tensor<2, dim> &F     = unit_tensor<dim>())
      : conditions(conditions_of<dim>(parameters))
      , growth(std::move(growth_of_cells))
      , tissue(GridParameters(), growth.columns(), MPI_COMM_WORLD)
    {
      const BoundaryColumns<dim> &columns = tissue.boundary_points().columns();
      PointList<dim>              boundary(columns.n_numbers());
      for (unsigned int d = 0; d < dim; ++d)
        for (const int sign : {-1, 1})
          {
            Tensor<1, dim> N;
            N[d] = sign;
            const Point<dim> X(90. * N);
            boundary.add(
              boundary.size(),
              X + moved,
              columns.initial_point(X, N, area, conditions.condition(X, N)));
            BoundaryView<dim, double>(boundary.row(boundary.size() - 1),
                                      columns)
              .deform(F);
          }
      tissue.place(only_first_rank(founders(ball_points(Point<dim>(), 88., 20.),
                                            std::pow(20., dim),
                                            growth,
                                            [](const auto &) {
                                              return unit_tensor<dim>();
                                            }),
                                   MPI_COMM_WORLD),
                   only_first_rank(boundary, MPI_COMM_WORLD));
      space = std::make_unique<SplineSpace<dim>>(tissue.splines());
    }

    struct Sums
    {
      double         energy = 0.;
      Tensor<1, dim> force;
    };

    /** Energy and resultant of a term at u = 0, over all ranks. */
    Sums
    sums(const Term<dim> &term, const GrowthAt at = GrowthAt::current) const
    {
      LocalField<dim> rest{};
      Sums            result;
      for (unsigned int c = 0; c < space->grid_cells().size(); ++c)
        {
          LocalSystem<dim> system(LocalSystem<dim>::energy_and_residual);
          term.add(c, rest, at, system);
          result.energy += system.energy;
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
              result.force[i] += system.residual[i * BSpline<dim>::n + a];
        }
      result.energy = Utilities::MPI::sum(result.energy, MPI_COMM_WORLD);
      result.force  = Utilities::MPI::sum(result.force, MPI_COMM_WORLD);
      return result;
    }

    std::unique_ptr<Term<dim>>
    nitsche(const TissueMaterial &material, const double t) const
    {
      const DevelopmentOfStep<dim> grown = growth.of_step(tissue, 0., t);
      return nitsche_term(
        conditions, material, tissue, *space, grown, t, "automatic");
    }
  };

  const std::string at_top = "X > 80"; // one point

  /** Growth that is no symmetric tensor, of the cells that are nearest to the
   *  point at_top; others grow far more. */
  template <int dim>
  class ShearedGrowth : public GrowthLaw<dim>
  {
  public:
    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double,
           const double t1) const override
    {
      if (std::abs(cell.founder_position[1]) > 15.)
        return (1. + 7. * t1) * unit_tensor<dim>();
      Tensor<2, dim> F_g = unit_tensor<dim>();
      F_g[0][1] += 0.4 * t1;
      F_g[1][0] -= 0.1 * t1;
      F_g[dim - 1][dim - 1] += 0.2 * t1;
      return F_g;
    }
  };
} // namespace


TEST_2D_3D(BoundaryTerms, PenaltyFollowsStiffnessAndSpacing)
{
  Given parameters;
  parameters.set("Fixed where", at_top);
  parameters.set("Displacement", "2*t; -t; 0");
  parameters.nitsche.penalty = 1e3;
  const Problem<dim> problem(parameters, CellDevelopment<dim>({}, {}));
  Tensor<1, dim>     U;
  U[0] = 1.;
  U[1] = -0.5;
  // E = 2 at X = 90; close to incompressible the least penalty counts.
  const double h = 50.;
  for (const auto &[nu, beta] :
       {std::pair<double, double>(0.4, 2e3 / h),
        {0.4999,
         20. * (lame(2., 0.4999).lambda + 2. * lame(2., 0.4999).mu) / h}})
    {
      const auto sums =
        problem.sums(*problem.nitsche(material("X/45", nu), 0.5));
      EXPECT_NEAR(sums.energy,
                  0.5 * beta * area * (U * U),
                  1e-10 * sums.energy);
      EXPECT_LE((sums.force + beta * area * U).norm(),
                1e-10 * sums.force.norm());
    }
}


/** What is squeezed is stiffer than at rest, and so must be what holds it. */
TEST_2D_3D(BoundaryTerms, PenaltyFollowsTheSqueeze)
{
  Given parameters;
  parameters.set("Fixed where", at_top);
  parameters.nitsche.penalty = 10.;
  const Lame   constants     = lame(1., 0.4);
  const double squeeze = 0.4, J = std::pow(squeeze, dim);
  const double b         = squeeze * squeeze;
  const double log_J     = std::log(J);
  const double stiffness = (constants.lambda + constants.mu -
                            constants.lambda * log_J + constants.mu * b) /
                           J;
  const double   at_rest = constants.lambda + 2. * constants.mu;
  const double   beta    = (20. * at_rest + 100. * (stiffness - at_rest)) / 50.;
  Tensor<1, dim> moved;
  moved[0] = 1e-3;
  const Problem<dim> problem(parameters,
                             CellDevelopment<dim>({}, {}),
                             moved,
                             squeeze * unit_tensor<dim>());
  const double       a_t = area * std::pow(squeeze, dim - 1);
  const double       traction =
    (constants.mu * (b - 1.) + constants.lambda * log_J) / J;
  const double energy =
    problem.sums(*problem.nitsche(material("1", 0.4), 1.)).energy;
  EXPECT_GT(stiffness, 5. * at_rest);
  EXPECT_NEAR(energy,
              a_t * (0.5 * beta * 1e-6 - traction * 1e-3),
              1e-9 * energy);
}


/** Where the volume is the grid cell's, the traction of a volume change alone
 *  is left to the penalty, which counts in λ + 2μ. */
TEST_2D_3D(BoundaryTerms, TractionHasNoVolumetricPartWhereThatIsTheGridCells)
{
  Given parameters;
  parameters.nitsche.penalty = 1e3;
  parameters.set("Fixed where", at_top);
  const Lame     constants = lame(1., 0.4999);
  const double   b         = 1.01 * 1.01 - 1.;
  const double   penalty   = 1e3 * (constants.lambda + 2. * constants.mu) / 50.;
  Tensor<1, dim> moved;
  moved[0] = 1e-3;
  const Problem<dim>   problem(parameters,
                             CellDevelopment<dim>({}, {}),
                             moved,
                             1.01 * unit_tensor<dim>());
  const double         a_t      = area * std::pow(1.01, dim - 1);
  const double         traction = constants.mu * b / std::pow(1.01, dim);
  const TissueMaterial pooled   = material("1", 0.4999, true, "pooled");
  const double energy = problem.sums(*problem.nitsche(pooled, 1.)).energy;
  EXPECT_NEAR(energy,
              a_t * (0.5 * penalty * 1e-6 - traction * 1e-3),
              1e-9 * energy);
}


/** The total position counts, not the increment. */
TEST_2D_3D(BoundaryTerms, TheTotalPositionIsHeld)
{
  Given parameters;
  parameters.nitsche.penalty = 1e3;
  parameters.set("Fixed where", at_top);
  parameters.set("Displacement", "1; 2; 0");
  parameters.set("Slip where", "Y > 80");
  Tensor<1, dim> moved;
  moved[0] = 0.7;
  moved[1] = -0.4;
  const Problem<dim> problem(parameters, CellDevelopment<dim>({}, {}), moved);
  Tensor<1, dim>     gap; // fixed: moved - displacement; slip: along y
  gap[0]          = -0.3;
  gap[1]          = -2.4 + moved[1];
  const auto sums = problem.sums(*problem.nitsche(material("1", 0.4), 1.));
  EXPECT_LE((sums.force - 1e3 / 50. * area * gap).norm(),
            1e-10 * sums.force.norm());
  EXPECT_NEAR(sums.energy,
              10. * area * (0.3 * 0.3 + 2.4 * 2.4 + moved[1] * moved[1]),
              1e-10 * sums.energy);
}


/** Growth of the nearest cell presses on the held point: F_e = F F_g^-1, not
 *  that of the transpose. */
TEST_2D_3D(BoundaryTerms, TractionOfTheNearestCellsGrowth)
{
  Given parameters;
  parameters.set("Fixed where", at_top);
  Tensor<2, dim> F = unit_tensor<dim>();
  F[0][0]          = 1.1;
  F[0][1]          = 0.2;
  Tensor<1, dim> N;
  N[0] = 1.;
  const Problem<dim> problem(
    parameters,
    CellDevelopment<dim>(std::make_unique<ShearedGrowth<dim>>(), {}),
    Tensor<1, dim>(),
    F);
  for (const bool grown : {false, true})
    for (const GrowthAt at : {GrowthAt::previous, GrowthAt::current})
      {
        const Tensor<2, dim> F_g =
          ShearedGrowth<dim>().growth({},
                                      0.,
                                      at == GrowthAt::current ? 1. : 0.);
        const auto state =
          neo_hookean_point<dim>(F * invert(F_g), lame(3., 0.3));
        // a_t n_t = det F F⁻ᵀ a⁰ N, and W / V_t = det F_g^(0, 1) / det F
        const Tensor<1, dim> expected =
          -area * (grown ? determinant(F_g) : 1.) *
          (Tensor<2, dim>(state.kirchhoff_stress()) * (N * invert(F)));
        const auto sums =
          problem.sums(*problem.nitsche(material("3", 0.3, grown), 1.), at);
        EXPECT_LE((sums.force - expected).norm(), 1e-12 * expected.norm());
      }
}


/** Where a held point is as far from its nearest cell as no surface is, its
 *  state is an extrapolation, and its traction counts in part or not. */
TEST_2D_3D(BoundaryTerms, ExtrapolatedTractionDoesNotCount)
{
  Tensor<2, dim> F = unit_tensor<dim>();
  F[0][0]          = 1.1;
  Tensor<1, dim> N;
  N[0]                       = 1.;
  const auto           state = neo_hookean_point<dim>(F, lame(3., 0.3));
  const Tensor<1, dim> all =
    -area * (Tensor<2, dim>(state.kirchhoff_stress()) * (N * invert(F)));
  for (const double distance : {0., 16., 200.})
    {
      Given parameters;
      parameters.set("Fixed where", at_top);
      parameters.set("Displacement", std::to_string(distance) + "; 0; 0");
      Tensor<1, dim> moved;
      moved[0] = distance;
      const Problem<dim> problem(parameters,
                                 CellDevelopment<dim>({}, {}),
                                 moved,
                                 F);
      Point<dim>         x;
      x[0]                  = 90. + distance;
      const double attached = attachment<dim>({x}, problem.tissue)[0];
      EXPECT_EQ(attached == 1., distance == 0.);
      EXPECT_EQ(attached == 0., distance == 200.);
      const auto sums = problem.sums(*problem.nitsche(material("3", 0.3), 1.));
      EXPECT_LE((sums.force - attached * all).norm(), 1e-11 * all.norm());
    }
}


TEST_2D_3D(BoundaryTerms, SupportsAreFixedAndSlipPoints)
{
  Given parameters;
  parameters.set("Fixed where", at_top);
  parameters.set("Slip where", "Y > 80 || Y < -80");
  parameters.set("Traction where", "X < -80");
  const Problem<dim> problem(parameters, CellDevelopment<dim>({}, {}));
  const auto         list =
    supports(problem.conditions, problem.tissue, *problem.space);
  EXPECT_EQ(Utilities::MPI::sum<unsigned int>(list.size(), MPI_COMM_WORLD), 3u);
  for (const auto &support : list)
    {
      EXPECT_EQ(support.piece, 0u);
      EXPECT_EQ(support.area, area);
      Tensor<2, dim> M = unit_tensor<dim>();
      if (support.x[0] < 80.)
        {
          M       = 0.;
          M[1][1] = 1.;
        }
      EXPECT_EQ(support.projection, M);
    }
}
