// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_pairs_h
#define morula_effects_contact_contact_pairs_h

#include <morula/effects/interaction.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
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

  /** How stiff contact is. */
  struct ContactLaw
  {
    double kappa; // κ, kPa/µm
    double E;     // a typical Young's modulus, kPa
    double h;     // grid spacing, µm
    double slow;  // ζ/Δt of viscous friction, kPa/µm
  };

  /**
   * The energy of bodies that touch: doc/theory.md (4.8k). It is a sum over
   * pairs of boundary points of different bodies that face each other, weighted
   * with a smooth kernel of their distance along the surface, so that no point
   * of one surface has to find its projection on the other. Positions, normals
   * and areas in it are frozen; renew() takes them anew. With them the energy
   * is convex and its tangent exact. Forces of a pair are equal and opposite.
   */
  template <int dim>
  class ContactPairs : public PairTerm
  {
  public:
    /** Freezes the configuration at t. Keeps a reference to the points. */
    ContactPairs(const ContactPoints<dim> &points, const ContactLaw &law);

    const std::vector<UnknownLink> &
    links() const override
    {
      return links_;
    }
    void
    add_residual(const std::vector<double> &u, Sums &sums) const override;
    using AddBlock =
      std::function<void(unsigned int, const std::vector<double> &)>;
    void
    add_tangent(const std::vector<double> &u,
                const AddBlock            &add) const override;

    /** What a renewal has found, on this rank. */
    struct Renewal
    {
      /** Sums of A p and of the tangential forces before it, kPa µm^(dim-1). */
      double normal = 0., tangential = 0.;
      /** The part of the tangential forces that goes on in the direction of the
       *  renewal before. */
      double onward = 0.;
      /** The normal force of pairs that were not there before. */
      double of_new_pairs = 0.;
      /** The deepest overlap of points that did not overlap so much at t, and
       *  the longest way of a pair that touches, µm. */
      double crossed = 0., slid = 0.;
      /** Whether the links are others than before. */
      bool has_new_links = false;
    };

    /** Looks at the configuration at @p u. The frozen one stays. */
    Renewal
    look(const std::vector<double> &u);

    /** Makes the drag of pairs that look() finds so much of its usual strength.
     */
    void
    set_drag(const double part)
    {
      drag_part = part;
    }

    /** Freezes the configuration that look() has seen last. */
    void
    adopt()
    {
      // The numbers of the links change with them, so that the matrix needs a
      // new pattern even where the same unknowns are linked.
      pairs  = std::move(seen);
      links_ = std::move(seen_links);
      slides = std::move(seen_slides);
    }

    /** The force on each point that another body touches, by the points'
     *  numbers in points(). */
    std::vector<ForceBetween<dim>>
    forces(const std::vector<double> &u) const;

  private:
    /** A pair with its frozen geometry. */
    struct Pair
    {
      unsigned int   b, c;             // points
      double         weight;           // A = a_b a_c ω, µm^(dim-1)
      double         gap;              // g_k and the slack, µm
      Tensor<1, dim> across;           // D = (n_c - n_b)/2
      Tensor<1, dim> normal;           // m = D/|D|
      Tensor<1, dim> jump;             // w_k = u_b - u_c, µm
      double         drag;             // k_t, kPa/µm
      double         slow;             // ζ/Δt where it touches, else 0, kPa/µm
      unsigned int   group_b, group_c; // their links with themselves
      unsigned int   link; // of b with c; the next is that of c with b
    };

    /** Where a point is and what surface it stands for. */
    struct State
    {
      Tensor<1, dim> u; // µm
      Point<dim>     x; // µm
      Tensor<1, dim> n; // outward unit normal
      double         a; // µm^(dim-1)
    };

    /** How the points of a candidate stand to each other. */
    struct Facing
    {
      Tensor<1, dim> across;  // D
      Tensor<1, dim> normal;  // m
      double         overlap; // µm
      double         beside;  // distance along the surface, µm
      double         reach;   // of the kernel, µm
    };

    /** That of candidate number @p k, if its points face each other. */
    std::optional<Facing>
    facing(const std::size_t k, const std::vector<State> &states) const;

    std::vector<Tensor<1, dim>>
    displacements(const std::vector<double> &u) const;

    std::vector<State>
    states(const std::vector<double> &u) const;

    /** The gap at the displacements @p u of the points. */
    double
    gap(const Pair &pair, const std::vector<Tensor<1, dim>> &u) const
    {
      return pair.gap + pair.across * (u[pair.b] - u[pair.c] - pair.jump);
    }

    /** The part of a jump along the pair's surface. */
    static Tensor<1, dim>
    along(const Pair &pair, const Tensor<1, dim> &w)
    {
      return w - (pair.normal * w) * pair.normal;
    }

    /** The force on the pair's point b; that on c is opposite. */
    Tensor<1, dim>
    force(const Pair &pair, const std::vector<Tensor<1, dim>> &u) const
    {
      const Tensor<1, dim> w = u[pair.b] - u[pair.c] - pair.jump;
      const double         g = gap(pair, u);
      return -pair.weight * (law.kappa * std::min(g, 0.) * pair.across +
                             pair.drag * along(pair, w) +
                             pair.slow * along(pair, u[pair.b] - u[pair.c]));
    }

    /** Minus the derivative of force() by the displacement of b. */
    Tensor<2, dim>
    stiffness(const Pair &pair, const std::vector<Tensor<1, dim>> &u) const
    {
      Tensor<2, dim> M = (pair.drag + pair.slow) *
                         (Tensor<2, dim>(unit_symmetric_tensor<dim>()) -
                          outer_product(pair.normal, pair.normal));
      if (gap(pair, u) < 0.)
        M += law.kappa * outer_product(pair.across, pair.across);
      return pair.weight * M;
    }

    /** The pairs of a configuration.
     *  @param first_contact whether pairs that nearly touch may turn into
     *         contact, as in the first turn of a step */
    std::vector<Pair>
    pairs_at(const std::vector<State> &states, const bool first_contact) const;

    /** The links of pairs: first those of each group of points with itself,
     *  then, for each two groups that have pairs, those of the first with the
     *  second and of the second with the first. Points of one body in one grid
     *  cell are a group, as they have the same unknowns. */
    std::vector<UnknownLink>
    link(std::vector<Pair> &list) const;

    /** Pairs, and minus the derivatives of their forces. */
    using WithStiffness = std::vector<std::pair<const Pair *, Tensor<2, dim>>>;

    /** Adds the block of a link, and that of the link behind it. */
    void
    add_link(const unsigned int   link,
             const WithStiffness &list,
             const AddBlock      &add) const;

    /** Adds (M φ) φᵀ, given row(i, j) = M_ij φ of the columns, to a matrix with
     *  these numbers of rows and columns. */
    static void
    add_products(const std::vector<double>              &of_rows,
                 const std::vector<std::vector<double>> &columns,
                 std::vector<double>                    &matrix);

    const ContactPoints<dim> &points;
    const ContactLaw          law;
    std::vector<Pair>         pairs, seen;
    std::vector<UnknownLink>  links_, seen_links;
    std::vector<double>       first_gaps; // by pair of points, µm
    std::vector<double>       slacks;     // likewise
    double                    drag_part = 1.;
    /** How far pairs have slid between the last two renewals, and since, µm. */
    std::map<ContactPair, Tensor<1, dim>> slides, seen_slides;
  };

  /**
   * Whether boundary points that were too far apart at t to be candidates have
   * passed through another body, or into one. Collective.
   * @param h grid spacing, µm
   */
  template <int dim>
  bool
  has_crossed_from_afar(const Tissue<dim>            &tissue,
                        const ContactPoints<dim>     &points,
                        const DisplacementField<dim> &displacement,
                        const double                  h);

  /**
   * The contact in an attempt at a step: its pairs hold positions, normals and
   * areas fixed in a turn, and take them anew after it. Keeps references to all
   * that it is given.
   * @param keeps_drag in/out: whether an attempt at the step has failed by a
   * drag that had become weaker
   */
  template <int dim>
  std::unique_ptr<InteractionInStep<dim>>
  contact_in_step(const AttemptAtStep<dim> &attempt,
                  const ContactPoints<dim> &points,
                  const ContactLaw         &law,
                  bool                     &keeps_drag);
} // namespace Morula

#endif
