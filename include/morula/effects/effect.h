// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_effect_h
#define morula_effects_effect_h

#include <morula/base/expression.h>
#include <morula/base/key.h>
#include <morula/base/review.h>
#include <morula/effects/state/state_columns.h>
#include <morula/particles/cell_state.h>
#include <morula/particles/neighbours.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/particles/property_pool.h>

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  class Catalogue;
  class ExpressionKey;
  struct SceneKeys;

  /** A field whose value at a cell expressions may read. */
  struct NamedField
  {
    std::string name;
    /** Whether cells that exchange their places take its amount along. */
    bool exchanged;
  };

  /** What a scene has to know of the keys of an effect. */
  struct EffectFacts
  {
    /** The key that switches the effect on, or null if a name does. */
    const AnyKey *switch_key = nullptr;
    /** Whether the effect, if it is on, acts on the surface: tissue that needs
     *  none gets one. */
    bool needs_surface = false;
    /** Whether cells divide by the effect, so that the scene's division axes
     *  are its own. */
    bool divides_cells = false;
    /** Whether cells grow by the effect, besides the law of growth. */
    bool grows_cells = false;
    /** Whether cells exchange places by the effect, if it is on. */
    bool exchanges_places = false;
    /** Whether all tissue flows by the effect, besides what relaxes. */
    bool releases_shear = false;
    /** The key whose value names sections of the effect, or null. */
    const AnyKey *names_key = nullptr;
    /** The condition that chooses founders on which the effect acts, or null:
     *  it acts on all. */
    const ExpressionKey *founders_key = nullptr;
    /** What it is called in --explain; empty: the effect's name. */
    std::string topic = {};
    /** The fields that the effect gives to cells, in the order of their
     *  numbers. One effect of a scene may have some. */
    std::vector<NamedField> fields = {};
    /** The columns of cells, of one number each, that the effect declares and
     *  that expressions may read by their names. */
    std::vector<std::string> numbers = {};
    /** Keys that choose boundary points on which the effect acts, besides those
     *  of conditions: the run warns when their last point is gone. */
    std::vector<const ExpressionKey *> places = {};
  };

  /**
   * The keys of an effect. Unless a scene chooses the effect by its name, they
   * say whether it is on. These are all questions that a scene asks of them.
   */
  struct EffectKeys : public Keys
  {
    /** Whether the scene has the effect: without a switch_key it has, else if
     *  the key does not have its default. */
    virtual bool
    is_on() const
    {
      const AnyKey *const key = facts().switch_key;
      return key == nullptr || key->is_changed();
    }

    virtual EffectFacts
    facts() const
    {
      return {};
    }

    /** Whether tissue loses cells by the effect after t = 0. Expressions must
     *  know the names of the scene. */
    virtual bool
    loses_cells() const
    {
      return false;
    }

    /** Makes the keys in sections that others name, before any key has its
     *  value: from the value of the names_key, and from the names of the cells'
     *  types, in the order of their numbers, which equations do not know yet.
     *  @throws InputError */
    virtual void
    declare_sections(const std::string & /*names*/,
                     const std::vector<std::string> & /*types*/)
    {}

    /** Takes from others' keys what concerns the effect, when all have their
     *  values; also from those whose expressions speak of cells.
     *  @throws InputError */
    virtual void
    see(const SceneKeys & /*scene*/,
        const std::vector<ExpressionKey *> & /*of_cells*/)
    {}

    /** Refuses what the keys contradict in the scene, also while the effect is
     *  off, and warns of what they alone tell to be unwise.
     *  Effect::review() sees the founders as well. @throws InputError */
    virtual void
    check(const SceneKeys &, Review &) const
    {}
  };

  template <int dim>
  class PresentCell;
  template <int dim>
  class Tables;

  /** Tensions of the interfaces between types of cells, and of the free surface
   *  of each type, kPa µm; by the types' numbers. Empty: there are none. */
  struct TypeTensions
  {
    /** Symmetric; 0 on the diagonal. */
    std::vector<std::vector<double>> between;
    std::vector<double>              with_surface;

    /** Whether the free surface of some type has one. */
    bool
    any_with_surface() const
    {
      for (const double gamma : with_surface)
        if (gamma != 0.)
          return true;
      return false;
    }
  };

  /** What a scene offers to the constructor of every effect. */
  template <int dim>
  struct EffectSetting
  {
    /** Random seed. */
    std::uint64_t random_seed;
    /** Times closer than this are equal, day. */
    double slack;
    /** The columns of the cells: an effect that has a state in cells adds its
     *  own, and keeps the handles. They are saved and resumed with the others.
     */
    CellColumns<dim> &columns;
    /** The variables of cells in expressions: an effect takes its expressions
     *  of cells from here. */
    StateColumns<dim> &state;
    /** Tissue/Center if the shape has one, else the origin, µm. */
    Point<dim> center = Point<dim>();
    /** Tensions between types of cells. */
    TypeTensions tensions = {};
    /** How it is found out which cells touch. */
    NeighbourSearch neighbours = {};
    /** Volume of a whole cell at t = 0 where those at the surface are cut by
     * it, µm^dim; 0: none is cut. */
    double whole_volume = 0.;
  };

  /**
   * What an effect may inspect before a run: plain values. The founders and
   * boundary points are those of this rank.
   */
  template <int dim>
  struct Preview
  {
    const SceneKeys &keys;
    /** Initial positions, µm. */
    const std::vector<Point<dim>> &founders;
    /** Number of founders on all ranks. */
    types::particle_index n_founders;
    /** Initial positions, µm. */
    const std::vector<Point<dim>> &boundary_points;
    /** Initial outward unit normals. */
    const std::vector<Tensor<1, dim>> &normals;
    /** Whether some boundary points are fixed. */
    bool     is_clamped;
    MPI_Comm comm;
    /** Mean initial volume of the founders of all ranks, µm^dim. */
    double mean_volume = 0.;
    /** Initial volumes of this rank's founders, µm^dim. */
    std::vector<double> volumes = {};
    /** Their types by number; empty without types. */
    std::vector<unsigned int> types = {};
  };

  /** What all effects have in common. An effect keeps nothing between calls: a
   *  state that outlives a step is in columns of the cells. */
  template <int dim>
  class Effect
  {
  public:
    virtual ~Effect() = default;

    /** Says what the effect adds to the tables of a run, and which of its
     *  numbers outlive a step. */
    virtual void
    declare(Tables<dim> &) const
    {}

    /** Sets the effect's columns of a founder at t = 0, if they differ from the
     *  declared values. Only called if the effect has columns. `founder`
     *  evaluates expressions of its state at t = 0: place, volume, type, depth,
     *  fields; the cell cycle has given it no phase yet. `row` is the same. */
    virtual void
    begin(const PresentCell<dim> & /*founder*/,
          const CellView<dim, double> & /*row*/) const
    {}

    /** Sets the effect's columns of a daughter, whose row is her mother's of
     *  the end @p t1 (day) of the step by the columns' rules, as they are at
     *  t1. Only called if the effect has columns.
     *  `daughter` evaluates expressions, of the same row and with t1;
     *  `mother` is the key of the mother's random numbers;
     *  `which` is 0 for the one at -n_s, 1 for the other; `birth` her day */
    virtual void
    born(const PresentCell<dim> & /*daughter*/,
         const CellView<dim, double> & /*row*/,
         const std::uint64_t /*mother*/,
         const unsigned int /*which*/,
         const double /*birth*/,
         const double /*t1*/) const
    {}

    /**
     * Sets the effect's columns of a cell at the end @p t1 (day) of a step.
     * Only called if the effect has columns; in every attempt of a step.
     * `before` is the cell at @p t0, which evaluates expressions, too;
     * `after` is the same cell: what this effect does not write, others may
     *               have written already
     */
    virtual void
    advance(const PresentCell<dim> & /*before*/,
            const CellView<dim, double> & /*after*/,
            const double /*t0*/,
            const double /*t1*/) const
    {}

    /** Refuses a founder that the effect cannot handle, in its state at t = 0
     *  and with steps of @p step days. @throws InputError */
    virtual void
    check_cell(const PresentCell<dim> &, const double) const
    {}

    /**
     * Refuses what the effect cannot do at these founders and boundary points,
     * at t = 0 and at the end. Not collective.
     * @throws InputError
     */
    virtual void
    check(const Preview<dim> &) const
    {}

    /** Adds warnings. Collective. */
    virtual void
    review(const Preview<dim> &, Review &) const
    {}
  };

} // namespace Morula

#endif
