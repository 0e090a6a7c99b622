// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_lumen_h
#define morula_effects_surface_lumen_h

#include <morula/effects/step_effect.h>
#include <morula/effects/surface/placed_condition.h>
#include <morula/mechanics/enclosure.h>

#include <mpi.h>

#include <optional>
#include <vector>

namespace Morula
{
  /** The keys of the lumen, in section "Boundary conditions". */
  struct LumenParameters : public ConditionKeys
  {
    LumenParameters()
      : ConditionKeys("Boundary conditions/Lumen where",
                      "Expression of X, Y, Z: the boundary points for which it "
                      "is > 0 enclose a lumen; empty: there is none.")
    {}

    /** relative to that at t = 0 */
    ExpressionKey volume{
      {this, "Boundary conditions/Lumen volume"},
      "",
      "Volume of the lumen relative to that at t = 0, a function of t; "
      "> 0. The pressure that it takes is found, and stands in "
      "statistics.csv. Empty: what fills the lumen is a gas.",
      Evaluated::place,
      positive("times the volume at t = 0", "1 keeps the volume.")};

    ExpressionKey pressure{
      {this, "Boundary conditions/Lumen pressure"},
      "",
      "Pressure of a gas in the lumen at the volume that this has at "
      "t = 0, V0, a function of t; at the volume V the pressure is V0/V "
      "times it. Empty: the volume is given. Units: kPa.",
      Evaluated::place};
    std::string
    details() const override;
  };

  /** A patch of the surface around a lumen. */
  template <int dim>
  struct LumenPatch
  {
    /** Position, µm. */
    Point<dim> x;
    /** Area times normal, out of the tissue and so into the lumen;
     *  µm^(dim-1). */
    Tensor<1, dim> area;
  };

  /**
   * The volume that patches enclose, µm^dim: doc/theory.md (4.8g). It does not
   * change if all patches move together. Collective.
   */
  template <int dim>
  double
  enclosed_volume(const std::vector<LumenPatch<dim>> &patches,
                  const MPI_Comm                      comm);

  /**
   * A lumen that the tissue encloses: its volume is given, and its pressure
   * follows; or it is filled with a gas. doc/theory.md (4.8g) to (4.8j).
   */
  template <int dim>
  class Lumen : public PlacedCondition<dim>, public Moments<dim>
  {
  public:
    using Parameters = LumenParameters;

    /** @throws InputError for expressions that cannot be parsed or depend on
     *  places, and unless exactly one of volume and pressure is given */
    explicit Lumen(const Parameters &parameters);

    /** Whether the volume is given. */
    bool
    keeps_volume() const
    {
      return volume_.has_value();
    }

    /** V*, µm^dim, at @p t (day), if it was @p at_start at t = 0.
     *  @throws InputError if the key has no value or is not positive */
    double
    volume(const double t, const double at_start) const;

    /** Pressure at the volume of t = 0, kPa. @throws InputError */
    double
    pressure(const double t) const
    {
      return pressure_->value(Point<dim>(), t);
    }

    /**
     * Refuses a surface that does not enclose anything. Collective.
     * @param patches of this rank, at t = 0
     * @throws InputError on all ranks together
     */
    void
    check_surface(const std::vector<LumenPatch<dim>> &patches,
                  const MPI_Comm                      comm) const;
    void
    check_surface(const Preview<dim>        &scene,
                  const std::vector<double> &areas) const override;

    /** None: the momentum balance has the content of the lumen as a whole. */
    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override;

    std::unique_ptr<PartOfStep<dim>>
    part_of_step(const AttemptAtStep<dim> &attempt) const override;

    /** Measures the volume. The first pressure of a lumen that keeps it is a
     *  guess, 0, from which the turns of the first step begin. */
    void
    settle(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override;

    void
    describe(const Tissue<dim>      &tissue,
             const MomentOfRun<dim> &moment) const override;

    /** Volume and pressure in statistics.csv; what it had at t = 0 and its last
     *  pressure are kept. */
    void
    declare(Tables<dim> &tables) const override;

    void
    check(const Preview<dim> &scene) const override;
    void
    review(const Preview<dim> &scene, Review &review) const override;

  private:
    const ExpressionKey             where;
    const std::optional<Expression> volume_;
    const std::optional<Expression> pressure_;
  };
} // namespace Morula

#endif
