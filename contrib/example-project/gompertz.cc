// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A growth law of your own, outside of Morula's tree: start here, and change
// it.
//
// Tissues that feed through their surface, like spheroids of tumour cells, do
// not grow at the same rate for ever. Gompertz (1825) lets the rate decay. The
// growth stretch theta of each cell obeys
//
//   $\dot\theta / \theta = k\, e^{-a t}$, so that
//   $\theta(t) = \exp\left( \frac{k}{a} (1 - e^{-a t}) \right)$,
//
// which comes to rest at $e^{k/a}$. The file has three parts: the keys, the
// law, and a main() that adds it to the library's own. Everything else is
// Morula.

#include <morula/base/expression_key.h>
#include <morula/program/program.h>

#include <cmath>

namespace MyMorula
{
  using namespace dealii;
  using namespace Morula;

  // The keys, with their defaults. What stands in the text is what
  // --parameters prints; the unit at its end is what messages say. Numbers that
  // may depend on the place are expressions. Here is also the place to refuse
  // what makes no sense: what is allowed, and what to do.
  struct GompertzParameters : public EffectKeys
  {
    ExpressionKey rate{{this, "Rate"},
                       "0.35",
                       "k: rate of the growth stretch at t = 0. An "
                       "expression of X, Y, Z, evaluated at the founder's "
                       "initial position. Units: 1/day.",
                       Evaluated::founder};
    Key<double>   decay{{this, "Decay"},
                      0.5,
                      "a: by which the rate decays; >= 0, where 0 is growth "
                        "at a constant rate. Units: 1/day."};

    GompertzParameters()
    {
      decay.require([](const double a) { return a >= 0.; },
                    "a number >= 0",
                    "Growth that accelerates has a negative Decay: take "
                    "0, and a larger Rate.");
    }
  };

  // The law has a type Parameters, is made of one, and does the two things that
  // Morula::GrowthLaw asks for, in 2-D and 3-D alike. It is made when the scene
  // is checked, before any work.
  template <int dim>
  class GompertzGrowth : public GrowthLaw<dim>
  {
  public:
    using Parameters = GompertzParameters;

    explicit GompertzGrowth(const Parameters &parameters)
      : rate(parameters.rate.expression(dim))
      , decay(parameters.decay)
    {}

    // What the law has made of a cell at t1, from what it had made at t0. It
    // is exact for steps of any length.
    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double            t0,
           const double            t1) const override
    {
      const double k = rate.value(cell.founder_position, 0.);
      return std::exp(k * (effective_time(t1) - effective_time(t0))) *
             cell.growth;
    }

  private:
    // (1 - exp(-a t))/a: the time that growth at the rate k would have needed.
    double
    effective_time(const double t) const
    {
      return decay > 0. ? -std::expm1(-decay * t) / decay : t;
    }

    const Expression rate;
    const double     decay;
  };
} // namespace MyMorula

// The name that `Growth/Law` knows the law by; its keys stand in the section
// `Growth/Gompertz`.
int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.catalogue.add<MyMorula::GompertzGrowth>("gompertz");
  return program.run(argc, argv);
}
