// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/momentum_balance.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

// The part of MomentumBalance that says where a state is extreme.

namespace Morula
{
  namespace
  {
    /** The value for which better(value, others') holds, and its place, over
     *  all ranks; the first rank's of equal ones. */
    template <typename Better>
    Equilibrium::Extreme
    best_of_ranks(const Equilibrium::Extreme &extreme,
                  const Better               &better,
                  const MPI_Comm              comm)
    {
      // Every rank gathers the extremes of all ranks, so that all of them pick
      // the same one. An equal value of a later rank does not replace an
      // earlier one.
      const auto all =
        Utilities::MPI::all_gather(comm,
                                   std::array<double, 4>{{extreme.value,
                                                          extreme.place[0],
                                                          extreme.place[1],
                                                          extreme.place[2]}});
      const auto *best = &all[0];
      for (const auto &other : all)
        if (better(other[0], (*best)[0]))
          best = &other;
      return {(*best)[0], Point<3>((*best)[1], (*best)[2], (*best)[3])};
    }

    Point<3>
    in_space(const Point<2> &x)
    {
      return Point<3>(x[0], x[1], 0.);
    }

    Point<3>
    in_space(const Point<3> &x)
    {
      return x;
    }

    template <int dim>
    Point<dim>
    from_space(const Point<3> &x)
    {
      Point<dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = x[d];
      return result;
    }
  } // namespace

  template <int dim>
  void
  MomentumBalance<dim>::update_extremes(const LocalSystem<dim> &system,
                                        const unsigned int      number,
                                        Evaluation &evaluation) const
  {
    // Terms know places only as coordinates in their grid cell. Places of the
    // configuration at t are needed where ranks compare.
    const auto place = [&](const Point<dim> &xi) {
      return in_space(space.box().corner(space.box().index(number)) +
                      space.box().spacing() * Tensor<1, dim>(xi));
    };
    if (system.smallest_J.value < evaluation.smallest_J.value)
      evaluation.smallest_J = {system.smallest_J.value,
                               place(system.smallest_J.xi)};
    if (system.largest_gap.value > evaluation.largest_gap.value)
      evaluation.largest_gap = {system.largest_gap.value,
                                place(system.largest_gap.xi)};
  }

  template <int dim>
  Extremes<dim>
  MomentumBalance<dim>::extremes(const Evaluation &evaluation) const
  {
    const Extreme J = smallest_J(evaluation);
    const Extreme gap =
      best_of_ranks(evaluation.largest_gap, std::greater<double>(), comm);
    return {J.value,
            from_space<dim>(J.place),
            gap.value,
            from_space<dim>(gap.place)};
  }

  template <int dim>
  Equilibrium::Extreme
  MomentumBalance<dim>::smallest_J(const Evaluation &evaluation) const
  {
    return best_of_ranks(evaluation.smallest_J, std::less<double>(), comm);
  }

  template <int dim>
  bool
  MomentumBalance<dim>::is_far_from(const Vector &begin, const Vector &u) const
  {
    // Tissue that is squeezed to less than this part of its volume within a
    // step has left the range in which Newton's method converges from the old
    // state.
    constexpr double least_J = 0.3;
    Vector           moved(u), R(u);
    moved -= begin;
    return moved.linfty_norm() > space.box().spacing() ||
           smallest_J(residual(u, R)).value < least_J;
  }

  template <int dim>
  Point<dim>
  MomentumBalance<dim>::place_of_largest(const Vector &R) const
  {
    double     largest = -1.;
    Point<dim> place;
    // The search runs over the unknowns that this rank owns, component after
    // component. An unknown's place is its coefficient in the field x, the
    // affine field that maps each point to itself: the centre of a plain
    // spline. That field is made only for pieces in which a larger entry was
    // met.
    std::vector<std::vector<double>> places(space.n_pieces());
    unsigned int                     k = 0;
    for (const auto row : R.locally_owned_elements())
      {
        const unsigned int unknown = k++ / dim;
        if (!(std::abs(R(row)) > largest))
          continue;
        const unsigned int piece = space.pieces_of_unknowns()[unknown];
        if (places[piece].empty())
          places[piece] =
            affine_displacement(space,
                                piece,
                                Tensor<1, dim>(),
                                Tensor<2, dim>(unit_symmetric_tensor<dim>()));
        largest = std::abs(R(row));
        for (unsigned int d = 0; d < dim; ++d)
          place[d] = places[piece][unknown * dim + d];
      }
    return from_space<dim>(
      best_of_ranks({largest, in_space(place)}, std::greater<double>(), comm)
        .place);
  }

  template <int dim>
  std::string
  MomentumBalance<dim>::describe(const Vector &u) const
  {
    Vector              R(u);
    const Extremes<dim> all = extremes(residual(u, R));
    std::ostringstream  text;
    if (all.smallest_J > 0.)
      text << "The smallest J_e is " << all.smallest_J << ", at ("
           << all.place_of_J << ") um";
    else
      text << "The tissue is inverted at (" << all.place_of_J << ") um";
    text << ", the largest unbalanced force acts near (" << place_of_largest(R)
         << ") um";
    if (all.largest_gap >= 0.)
      text << ", and the largest gap of a held point is " << all.largest_gap
           << " um, at (" << all.place_of_gap << ") um";
    return text.str();
  }

#define INSTANTIATE(dim)                                                       \
  template void MomentumBalance<dim>::update_extremes(                         \
    const LocalSystem<dim> &, const unsigned int, Evaluation &) const;         \
  template Extremes<dim> MomentumBalance<dim>::extremes(const Evaluation &)    \
    const;                                                                     \
  template Equilibrium::Extreme MomentumBalance<dim>::smallest_J(              \
    const Evaluation &) const;                                                 \
  template bool       MomentumBalance<dim>::is_far_from(const Vector &,        \
                                                  const Vector &) const; \
  template Point<dim> MomentumBalance<dim>::place_of_largest(const Vector &)   \
    const;                                                                     \
  template std::string MomentumBalance<dim>::describe(const Vector &) const;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
