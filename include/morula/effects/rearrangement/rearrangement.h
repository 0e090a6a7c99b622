// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_rearrangement_rearrangement_h
#define morula_effects_rearrangement_rearrangement_h

#include <morula/base/expression_key.h>
#include <morula/effects/rearrangement/exchange.h>
#include <morula/effects/step_effect.h>
#include <morula/particles/neighbours.h>

#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** Section "Rearrangement". */
  struct RearrangementParameters : public EffectKeys
  {
    ExpressionKey diffusion{
      {this, "Rearrangement/Diffusion"},
      "0",
      "Diffusion coefficient of a cell among equal ones, which "
      "exchanges its place with neighbours; of two that differ the "
      "harmonic mean counts. An expression; 0: the cell keeps its "
      "place. Units: um^2/day.",
      Evaluated::step,
      not_negative("um^2/day", "0 lets the cell keep its place.")};

    Key<double> energy{
      {this, "Rearrangement/Fluctuation energy"},
      0.,
      "T in the probability 1/(1 + exp(E/T)) that an exchange is made "
      "which changes the energy of adhesion (Cell types/NAME/Tension) "
      "by E; 0: never one that raises it. In 3-D times um. Units: kPa "
      "um^2.",
      {0.}};

    /** q */
    Key<double> shear_released{
      {this, "Rearrangement/Shear released"},
      1.,
      "Part of the elastic shear that each exchange takes from "
      "both places: 1 is a liquid as long as cells exchange "
      "places.",
      {0.},
      {[](const double q) { return q <= 1.; },
       "a number from 0 to 1",
       "1 releases all shear at the two places."}};

    ExpressionKey drive{
      {this, "Rearrangement/Drive"},
      "0; 0; 0",
      "Force with which a cell looks for exchanges along it; none acts on "
      "the tissue. An expression. In 3-D times um. Units: kPa um.",
      Evaluated::step,
      3};

    bool
    is_on() const override
    {
      return !diffusion.is_default() || diffusion.differs_by_type();
    }
    EffectFacts
    facts() const override
    {
      return {&diffusion};
    }
    void
    check(const SceneKeys &scene, Review &review) const override;
  };

  /** Cells exchange their places with neighbours: doc/theory.md, section 12.3.
   */
  template <int dim>
  class Rearrangement : public StepEffect<dim>
  {
  public:
    using Parameters = RearrangementParameters;

    /** @throws InputError for expressions that cannot be parsed */
    Rearrangement(const Parameters         &parameters,
                  const EffectSetting<dim> &setting);

    void
    declare(Tables<dim> &tables) const override;
    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;
    void
    review(const Preview<dim> &scene, Review &review) const override;
    void
    settle(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override;
    void
    rearrange(Tissue<dim>            &tissue,
              const MomentOfRun<dim> &moment) const override;

  private:
    /** The cells of this rank as occupants of places. @throws InputError */
    std::vector<Occupant>
    cells_of(const Tissue<dim> &tissue, const CellReader<dim> &reader) const;

    /** Writes the numbers of the step. Collective. */
    void
    tell(const MomentOfRun<dim>      &moment,
         const Places                &places,
         const std::vector<Occupant> &occupants,
         const double                 n_exchanges,
         const MPI_Comm               comm) const;

    /** Evens the places out as fast as cells exchange them. Collective. */
    void
    spread(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const;

    const Expression      diffusion, drive;
    const AdhesionEnergy  energy;
    const double          shear_released;
    const std::uint64_t   random_seed;
    const Column<double>  death_time;
    const NeighbourSearch neighbours;
  };

  /**
   * F of a cell that comes to a place: doc/theory.md (12.6). The place keeps
   * its volume, and its elastic deformation in shape.
   * @param F_e of the place, after what is released
   * @param V   of the place, µm^dim
   * @param F_g of the cell
   * @param V0  of the cell, µm^dim
   */
  template <int dim>
  Tensor<2, dim>
  deformation_at(const Tensor<2, dim> &F_e,
                 const double          V,
                 const Tensor<2, dim> &F_g,
                 const double          V0);

  /** F_e whose logarithmic shear is multiplied by @p part; its volume and
   *  rotation stay. */
  template <int dim>
  Tensor<2, dim>
  with_less_shear(const Tensor<2, dim> &F_e, const double part);
} // namespace Morula

#endif
