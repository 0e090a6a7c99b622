// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_end_at_rate_h
#define morula_effects_fate_end_at_rate_h

#include <morula/base/expression_key.h>
#include <morula/effects/fate/cell_hazard.h>

#include <optional>
#include <string>

namespace Morula
{
  /** A fate that ends lives at a rate. A cell has one threshold for its whole
   *  life: a change of its type changes the rate and keeps the integral,
   *  doc/theory.md, section 6.9. */
  template <int dim>
  class EndAtRate : public Fate<dim>
  {
  public:
    void
    make_good(const PresentCell<dim>      &before,
              const CellView<dim, double> &row) const override;

    std::optional<double>
    next(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch) const override;

    void
    pass(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch,
         const double                 s) const override;

    void
    expect(const PresentCell<dim>      &before,
           const CellView<dim, double> &row,
           const double                 t,
           const bool                   is_whole) const override;

    bool
    is_deadly() const override
    {
      return true;
    }

    double
    time_of_death(const CellView<dim, const double> &cell) const override
    {
      return has_ended(cell) ? cell.get(time) :
                               std::numeric_limits<double>::infinity();
    }

    std::vector<const Expression *>
    rates(const unsigned int type) const override;

    /** The columns of events, which those that end lives share. */
    void
    declare(Tables<dim> &tables) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override;

  protected:
    /** The names and the meanings of the columns. */
    struct Words
    {
      /** The columns are NAME_hazard, NAME_rate and NAME_time. */
      std::string name;
      /** Of NAME_time. */
      std::string meaning;
      /** What no cell does by a rate that is 0 everywhere, a sentence. */
      std::string nobody;
      /** Whether NAME_time is written to the tables of cells. */
      bool in_tables;
    };

    /** Declares the columns: no hazard for a rate that is always zero.
     *  @throws InputError */
    EndAtRate(const ExpressionKey      &rate,
              const EffectSetting<dim> &setting,
              const Words              &words);

    /** The threshold of a cell with this lineage key. */
    virtual double
    threshold(const std::uint64_t seed, const std::uint64_t key) const = 0;

    /** Ends the life at @p t, day. */
    void
    end(const CellView<dim, double> &row, const double t) const;

    /** Whether the life has ended by this fate. */
    bool
    has_ended(const CellView<dim, const double> &cell) const;

  private:
    /** Declares the columns of the rate. */
    static CellHazard<dim>
    hazard_of(const ExpressionKey      &rate,
              const EffectSetting<dim> &setting,
              const std::string        &name);

    const CellHazard<dim> hazard;
    const Column<double>  time; // day
    const std::uint64_t   random_seed;
    const std::string     nobody;
  };
} // namespace Morula

#endif
