// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Step 7: your own growth law and your own division rule.
//
// Nothing in this file is in the library, and the library knows nothing of this
// file. It defines a law by which cells grow less the more they are squeezed,
// and a rule by which they divide across their long axis; hands both to the
// library; and is then a complete Morula that can do two things more, with
// --parameters, --explain, --resume and all checks. Theory and results are in
// doc/steps/step-7.md, equation numbers are those of doc/theory.md.
//
//   build/step-7 prm/step-7.prm

#include <morula/base/expression_key.h>
#include <morula/effects/state/present_cell.h>
#include <morula/program/program.h>

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

namespace Step7
{
  using namespace dealii;
  using namespace Morula;

  // The growth law. A squeezed cell has $J_e < 1$, (1.3). The growth stretch
  // theta of each cell obeys
  //
  //   $\dot\theta / \theta = k\, r$, with the room $r = 1 - (1 - J_e) / c$,
  //
  // which is cut off to lie between 0 and 1. A cell grows with the rate k where
  // there is no pressure, slower under pressure, and not at all once it has
  // lost the part c of its volume. A cell that is pulled grows with the rate k.

  // Its keys are the members of a struct, as for all effects of the library. A
  // key knows its name, its default, and the text that --parameters prints. The
  // rate is an expression, so that it can depend on the place; `Evaluated` says
  // that it may not depend on the time. The crowding is a number, with a rule
  // that is checked before any work. list() gives the keys in their order.
  struct CrowdingLimitedParameters : public EffectKeys
  {
    ExpressionKey rate{"Rate",
                       "1",
                       "k, 1/day: rate of the growth stretch of a cell without "
                       "pressure. An expression of X, Y, Z (um), evaluated at "
                       "the founder's initial position.",
                       Evaluated::founder};
    Key<double>   crowding{
      "Crowding",
      0.2,
      "c: part of its volume that a cell has lost to pressure "
        "when it stops growing; > 0 and < 1."};

    CrowdingLimitedParameters()
    {
      crowding.require([](const double c) { return c > 0. && c < 1.; },
                       "a number > 0 and < 1",
                       "Cells shall stop growing before they have no volume "
                       "left.");
    }

    using Keys::list;
    KeyList
    list() override
    {
      return {&rate, &crowding};
    }
  };


  // The law is a class with a type Parameters, made from one of these, and with
  // the two functions that GrowthLaw asks for. It is a template, since scenes
  // are 2-D or 3-D. The key has parsed its expression, once; one that cannot be
  // parsed has been refused before.
  template <int dim>
  class CrowdingLimitedGrowth : public GrowthLaw<dim>
  {
  public:
    using Parameters = CrowdingLimitedParameters;

    explicit CrowdingLimitedGrowth(const Parameters &parameters)
      : rate(parameters.rate.expression(dim))
      , crowding(parameters.crowding)
    {}

    // The growth from $t_0$ to $t_1$. The cell brings along what the law made
    // of it so far, and its elastic deformation at $t_0$. So a law may depend
    // on the cell's history without keeping anything itself; the state is saved
    // in snapshots with everything else. With $J_e$ from the beginning of the
    // step the rate is constant during the step: an explicit method, whose
    // error is proportional to the time step.
    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double            t0,
           const double            t1) const override
    {
      const double J_e  = determinant(cell.elastic);
      const double room = std::clamp(1. - (1. - J_e) / crowding, 0., 1.);
      const double k    = rate.value(cell.founder_position, 0.);
      return std::exp(k * room * (t1 - t0)) * cell.growth;
    }


  private:
    const Expression rate;
    const double     crowding;
  };


  // The division rule: cells divide across their longest axis (Hertwig, 1884).
  // A cell that is longer than wide by less than a given factor cannot tell,
  // and takes the random direction that it would have taken anyway. With a
  // memory, it is not the shape of the moment that counts, but a mean over the
  // past that forgets within that time.
  struct LongAxisParameters : public EffectKeys
  {
    Key<double> least_elongation{
      "Least elongation",
      1.02,
      "Ratio of the largest to the second largest elastic "
      "stretch below which a cell takes a random axis; >= 1.",
      {1.}};
    Key<double> memory{"Memory",
                       0.,
                       "day: within which a cell forgets what shape it had; 0: "
                       "its present shape counts.",
                       {0.}};

    using Keys::list;
    KeyList
    list() override
    {
      return {&least_elongation, &memory};
    }
  };


  // The axis $n_s$ stands between growth and elastic deformation, $F = F_e (I +
  // (\theta - 1) n_s \otimes n_s) F_{g,pre}$, (6.2): it is stretched by $F_e$.
  // The direction that is stretched most is the eigenvector of $C_e = F_e^T
  // F_e$ with the largest eigenvalue, the square of the stretch. deal.II sorts
  // them, largest first.
  //
  // The mean $M$ obeys $\dot M = (C_e - M)/\tau$. A rule keeps nothing between
  // calls: what outlives a step stands in a column of the cells, which the rule
  // adds and which exists only with a memory. Snapshots save it, and daughters
  // have their mother's, with nothing to be done for it. advance() is called in
  // every attempt at a step; for $C_e$ of the step's beginning it is exact.
  template <int dim>
  class LongAxis : public DivisionRule<dim>
  {
  public:
    using Parameters = LongAxisParameters;

    LongAxis(const Parameters &parameters, const EffectSetting<dim> &setting)
      : least_elongation(parameters.least_elongation)
      , memory(parameters.memory)
    {
      if (memory > 0.)
        remembered = setting.columns.template add<Tensor<2, dim>>(
          {"remembered_shape",
           "",
           "mean of C_e over the past",
           Tensor<2, dim>(unit_symmetric_tensor<dim>())});
    }

    void
    advance(const PresentCell<dim>      &before,
            const CellView<dim, double> &after,
            const double                 t0,
            const double                 t1) const override
    {
      if (!remembered.exists())
        return;
      const Tensor<2, dim> F_e  = before.cell().elastic_deformation();
      const double         kept = std::exp(-(t1 - t0) / memory);
      after.set(remembered,
                kept * before.cell().get(remembered) +
                  (1. - kept) * (transpose(F_e) * F_e));
    }

    // The library asks the founders before they have columns, too.
    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override
    {
      const bool           remembers  = remembered.exists() && cell.present;
      const Tensor<2, dim> C          = remembers ?
                                          cell.present->cell().get(remembered) :
                                          transpose(cell.elastic) * cell.elastic;
      const auto           eigenpairs = eigenvectors(symmetrize(C));
      const double         elongation =
        std::sqrt(eigenpairs[0].first / eigenpairs[1].first);
      return elongation >= least_elongation ? eigenpairs[0].second :
                                              cell.random;
    }

  private:
    const double           least_elongation, memory;
    Column<Tensor<2, dim>> remembered;
  };
} // namespace Step7


// The catalogue is a plain object: what is added to it has a name in the scene,
// `Growth/Law = crowding limited`, and a section for its keys, `Growth/Crowding
// limited`. The rule's is `Proliferation/Cell cycle/Long axis`. The program
// does with a scene what morula does, so there is nothing else to say.
int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.catalogue.add<Step7::CrowdingLimitedGrowth>("crowding limited");
  program.catalogue.add<Step7::LongAxis>("long axis");
  return program.run(argc, argv);
}
