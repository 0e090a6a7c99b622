// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_points_h
#define morula_effects_contact_contact_points_h

#include <morula/effects/interaction.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <utility>
#include <vector>

namespace Morula
{
  /** A boundary point that may come into contact, and how its displacement
   *  follows from the unknowns. */
  template <int dim>
  struct ContactPoint
  {
    types::particle_index id;
    /** Its body, and the part of its grid cell that it belongs to. */
    unsigned int body, part;
    /** Position (µm) and area vector a n (µm^(dim-1)) at t. */
    Point<dim>     x;
    Tensor<1, dim> area;
    /** Distance to its neighbours l, µm. */
    double spacing;
    /** Pressure of contact at t, averaged, kPa. */
    double pressure;
    /** The rank that has it, and its position in the store there. */
    unsigned int owner, p;
    /** Its grid cell, by number; points of one part there have the same
     *  unknowns. */
    unsigned int grid_cell;
    /** The unknowns that move it, as positions in SplineSpace::relevant(). */
    std::vector<unsigned int> unknowns;
    /** Σ_a C_as N_a and its gradient (1/µm) at the point, by unknown. */
    std::vector<double>         values;
    std::vector<Tensor<1, dim>> gradients;
  };

  /** Two points of different sides, by their numbers in a list of points: the
   *  first one has the lower id and is one of this rank. */
  using ContactPair = std::pair<unsigned int, unsigned int>;

  /**
   * The boundary points of a configuration that may touch tissue of another
   * side within a step: of another body or, where bodies can touch themselves,
   * of another strand, which bonds around the pair do not join with the first
   * (see Parting). With them come the pairs that they may make: those nearer
   * to each other than the reach of the contact's kernel plus a way. Each pair
   * is on the rank of its point with the lower id, in the order of the ids.
   */
  template <int dim>
  class ContactPoints
  {
  public:
    /** Pairs of points farther from each other than this along their surface
     *  do not act on each other: in units of the larger spacing. */
    static constexpr double kernel = 1.5;

    /** Deepest overlap of a pair that acts, in units of h: the two faces of a
     *  sheet "overlap" by its thickness. */
    static constexpr double deepest_pair = 0.4;

    /**
     * Collective.
     * @param space of the configuration; unknowns of other ranks that move
     *        points of this rank's pairs become relevant in it
     * @param way   that two points may come nearer to each other, µm
     */
    ContactPoints(const Tissue<dim> &tissue,
                  SplineSpace<dim>  &space,
                  const double       way);

    /** This rank's points first. */
    const std::vector<ContactPoint<dim>> &
    points() const
    {
      return points_;
    }

    const std::vector<ContactPair> &
    pairs() const
    {
      return pairs_;
    }

    /** How far two points may come nearer to each other, or slide, in a step,
     *  µm. */
    double
    way() const
    {
      return way_;
    }

    /** Whether any rank has a pair. */
    bool
    any() const
    {
      return any_;
    }

    /** The largest spacing of a boundary point, over all ranks, µm. */
    double
    largest_spacing() const
    {
      return largest_spacing_;
    }

  private:
    /** Finds pairs, and the points in them. Collective. */
    void
    find_pairs(const Tissue<dim> &tissue, const double reach);

    /** Keeps the points that occur in pairs, and the pairs by their numbers.
     *  @param found pairs of places in @p near, in any order */
    void
    number_points(const std::vector<ContactPoint<dim>> &near,
                  const std::vector<ContactPair>       &found,
                  const unsigned int                    rank);

    /** Sets the unknowns of all points. Collective. */
    void
    find_unknowns(const Tissue<dim> &tissue, SplineSpace<dim> &space);

    std::vector<ContactPoint<dim>> points_;
    std::vector<ContactPair>       pairs_;
    bool                           any_             = false;
    double                         largest_spacing_ = 0.;
    double                         way_;
  };

  /**
   * The forces of pairs on this rank's boundary points, also of pairs of other
   * ranks: one for each point and body that touches it, in the
   * order of the store; p is the position there. Collective.
   * @param of_pairs on points with these numbers in @p points
   */
  template <int dim>
  std::vector<ForceBetween<dim>>
  contact_forces(const ContactPoints<dim>             &points,
                 const std::vector<ForceBetween<dim>> &of_pairs,
                 const MPI_Comm                        comm);
} // namespace Morula

#endif
