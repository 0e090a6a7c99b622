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
    RearrangementParameters();

    ExpressionKey diffusion;      // D, µm²/day
    Key<double>   energy;         // T, kPa µm^dim
    Key<double>   shear_released; // q
    ExpressionKey drive;          // f, kPa µm^(dim-1)

    bool
    is_on() const override
    {
      return !diffusion.is_default() || diffusion.differs_by_type();
    }
    const AnyKey *
    switch_key() const override
    {
      return &diffusion;
    }
    void
    check_with(const RestOfScene &scene) const override;
    void
    review(const RestOfScene &scene, Review &review) const override;
    std::string
    further_lines(const RestOfScene &scene) const override;
    using Keys::list;
    KeyList
    list() override
    {
      return {&diffusion, &energy, &shear_released, &drive};
    }

  private:
    /** How often a cell takes part in an exchange per day, k = 2 d D/a², among
     *  equal cells with the largest D that is a plain number. */
    std::optional<double>
    rate_of_exchange(const RestOfScene &scene) const;
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
