// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/contact/contact_pairs.h>

#include <deal.II/base/numbers.h>

#include <cmath>

namespace Morula
{
  namespace
  {
    /** The growth of an overlap from which on points have crossed, in units of
     *  the deepest overlap of a pair. */
    constexpr double crossing = 0.9;

    /** k_t of a pair, in units of its pressure by h, and of one that is about
     *  to touch, in units of E/h; such a pair has a gap below this times h. */
    constexpr double drag_of_pressure = 0.3, first_drag = 0.02,
                     nearly_touching = 0.05;

    /** Of an overlap that no pressure has made a half is let go in a step, but
     *  not less and not more than this, in units of h: facetted surfaces make
     *  gaps scatter as much, and more would be a blow. */
    constexpr double least_let_go = 0.005, most_let_go = 0.02;

    /** The kernel ω, whose integral along the surface is 1: doc/theory.md
     *  (4.8k). */
    template <int dim>
    double
    contact_kernel(const double s, const double r)
    {
      const double q = 1. - s * s / (r * r);
      if (q <= 0.)
        return 0.;
      return (dim == 2 ? 35. / (32. * r) : 4. / (numbers::PI * r * r)) * q * q *
             q;
    }
  } // namespace


  template <int dim>
  ContactPairs<dim>::ContactPairs(const ContactPoints<dim> &points,
                                  const ContactLaw         &law)
    : points(points)
    , law(law)
  {
    std::vector<State> at_rest;
    for (const ContactPoint<dim> &point : points.points())
      at_rest.push_back({Tensor<1, dim>(),
                         point.x,
                         point.area / point.area.norm(),
                         point.area.norm()});
    // Points of a fold that deepens may overlap before they count as a pair, as
    // long as bonds around its end connect them. An overlap at t that is deeper
    // than their pressure makes it is let go a little in each step, since all
    // of it at once would be a blow: doc/theory.md (4.8m).
    for (const auto &[b, c] : points.pairs())
      {
        first_gaps.push_back(0.5 * (at_rest[c].n - at_rest[b].n) *
                             (at_rest[b].x - at_rest[c].x));
        const double expected =
          0.5 * (points.points()[b].pressure + points.points()[c].pressure) /
          law.kappa;
        const double overlap = -first_gaps.back();
        slacks.push_back(
          std::max(0.,
                   overlap - expected -
                     std::max({least_let_go * law.h,
                               0.5 * expected,
                               std::min(0.5 * overlap, most_let_go * law.h)})));
      }
    pairs  = pairs_at(at_rest, true);
    links_ = link(pairs);
  }


  template <int dim>
  std::vector<Tensor<1, dim>>
  ContactPairs<dim>::displacements(const std::vector<double> &u) const
  {
    std::vector<Tensor<1, dim>> list;
    for (const ContactPoint<dim> &point : points.points())
      {
        Tensor<1, dim> way;
        for (std::size_t s = 0; s < point.unknowns.size(); ++s)
          for (unsigned int i = 0; i < dim; ++i)
            way[i] += point.values[s] * u[point.unknowns[s] * dim + i];
        list.push_back(way);
      }
    return list;
  }


  template <int dim>
  std::vector<typename ContactPairs<dim>::State>
  ContactPairs<dim>::states(const std::vector<double> &u) const
  {
    // An area vector moves with the cofactor of the step's deformation,
    // doc/theory.md (1.2).
    const std::vector<Tensor<1, dim>> ways = displacements(u);
    std::vector<State>                list;
    for (std::size_t k = 0; k < ways.size(); ++k)
      {
        const ContactPoint<dim> &point = points.points()[k];
        Tensor<2, dim>           f(unit_symmetric_tensor<dim>());
        for (std::size_t s = 0; s < point.unknowns.size(); ++s)
          for (unsigned int i = 0; i < dim; ++i)
            f[i] += u[point.unknowns[s] * dim + i] * point.gradients[s];
        const Tensor<1, dim> area = determinant(f) * (point.area * invert(f));
        list.push_back(
          {ways[k], point.x + ways[k], area / area.norm(), area.norm()});
      }
    return list;
  }


  template <int dim>
  std::optional<typename ContactPairs<dim>::Facing>
  ContactPairs<dim>::facing(const std::size_t         k,
                            const std::vector<State> &states) const
  {
    const auto &[b, c] = points.pairs()[k];
    const State &one = states[b], &other = states[c];
    if (one.n * other.n >= Parting<dim>::facing)
      return {};
    const Tensor<1, dim> across   = 0.5 * (other.n - one.n);
    const Tensor<1, dim> normal   = across / across.norm();
    const Tensor<1, dim> distance = one.x - other.x;
    return Facing{across,
                  normal,
                  -(across * distance),
                  (distance - (normal * distance) * normal).norm(),
                  ContactPoints<dim>::kernel *
                    std::max(points.points()[b].spacing,
                             points.points()[c].spacing)};
  }


  template <int dim>
  std::vector<typename ContactPairs<dim>::Pair>
  ContactPairs<dim>::pairs_at(const std::vector<State> &states,
                              const bool                first_contact) const
  {
    // Of the candidates those become pairs that face each other and are near
    // along their surfaces. A pair with a gap costs nothing until the gap is
    // used up, so that all gaps count which a step can use up: bodies that meet
    // within a solve do not pass through each other.
    std::vector<Pair> list;
    for (std::size_t k = 0; k < points.pairs().size(); ++k)
      {
        const auto pair = facing(k, states);
        if (!pair ||
            pair->overlap >= ContactPoints<dim>::deepest_pair * law.h ||
            pair->overlap <= -points.way())
          continue;
        const auto &[b, c] = points.pairs()[k];
        const State &one = states[b], &other = states[c];
        const double gap = slacks[k] - pair->overlap;
        const double weight =
          one.a * other.a * contact_kernel<dim>(pair->beside, pair->reach);
        if (weight <= 0.)
          continue;
        // The drag keeps frozen normals from letting a body spin: k_t of
        // doc/theory.md (4.8k).
        double drag =
          drag_part * drag_of_pressure * law.kappa * std::max(-gap, 0.) / law.h;
        if (first_contact && gap < nearly_touching * law.h)
          drag = std::max(drag, first_drag * law.E / law.h);
        list.push_back({b,
                        c,
                        weight,
                        gap,
                        pair->across,
                        pair->normal,
                        one.u - other.u,
                        drag,
                        gap < 0. ? law.slow : 0.,
                        0,
                        0,
                        0});
      }
    return list;
  }


  template <int dim>
  std::vector<UnknownLink>
  ContactPairs<dim>::link(std::vector<Pair> &list) const
  {
    // Groups get their numbers in the order in which pairs name them, and so do
    // the couples of groups, behind them.
    using Group = std::pair<unsigned int, unsigned int>;
    std::map<Group, unsigned int> groups;
    std::vector<UnknownLink>      links;
    const auto                    group_of = [&](const unsigned int k) {
      const ContactPoint<dim> &point = points.points()[k];
      const auto [found, is_new] =
        groups.emplace(Group{point.grid_cell, point.part}, links.size());
      if (is_new)
        links.push_back({point.unknowns, point.unknowns});
      return found->second;
    };
    for (Pair &pair : list)
      {
        pair.group_b = group_of(pair.b);
        pair.group_c = group_of(pair.c);
      }
    std::map<Group, unsigned int> couples;
    for (Pair &pair : list)
      {
        const auto [found, is_new] =
          couples.emplace(Group{pair.group_b, pair.group_c}, links.size());
        if (is_new)
          {
            const auto &b = links[pair.group_b].rows,
                       &c = links[pair.group_c].rows;
            UnknownLink there{b, c}, back{c, b};
            links.push_back(std::move(there));
            links.push_back(std::move(back));
          }
        pair.link = found->second;
      }
    return links;
  }


  template <int dim>
  void
  ContactPairs<dim>::add_residual(const std::vector<double> &u,
                                  Sums                      &sums) const
  {
    // First the forces of all pairs add up at the points, then each point gives
    // its force to its unknowns: pairs are many more than points.
    const std::vector<Tensor<1, dim>> ways = displacements(u);
    std::vector<Tensor<1, dim>>       of_points(ways.size());
    std::vector<double>               magnitudes(ways.size(), 0.);
    for (const Pair &pair : pairs)
      {
        const Tensor<1, dim> w = ways[pair.b] - ways[pair.c] - pair.jump;
        const double         g = gap(pair, ways);
        if (g >= 0. && pair.drag + pair.slow == 0.)
          continue;
        const Tensor<1, dim> t = force(pair, ways);
        const double         energy =
          0.5 * pair.weight *
          (law.kappa * std::pow(std::min(g, 0.), 2) +
           pair.drag * along(pair, w).norm_square() +
           pair.slow * along(pair, ways[pair.b] - ways[pair.c]).norm_square());
        sums.energy += energy;
        sums.energy_magnitude += energy;
        of_points[pair.b] += t;
        of_points[pair.c] -= t;
        magnitudes[pair.b] += t.norm();
        magnitudes[pair.c] += t.norm();
      }
    for (std::size_t k = 0; k < of_points.size(); ++k)
      {
        const ContactPoint<dim> &point = points.points()[k];
        if (magnitudes[k] > 0.)
          for (std::size_t s = 0; s < point.unknowns.size(); ++s)
            for (unsigned int i = 0; i < dim; ++i)
              {
                // A residual is minus the force.
                sums.residual[point.unknowns[s] * dim + i] -=
                  point.values[s] * of_points[k][i];
                if (sums.magnitudes != nullptr)
                  (*sums.magnitudes)[point.unknowns[s] * dim + i] +=
                    std::abs(point.values[s]) * magnitudes[k];
              }
      }
  }


  template <int dim>
  typename ContactPairs<dim>::Renewal
  ContactPairs<dim>::look(const std::vector<double> &u)
  {
    // Before the old geometry goes it says how large its forces are: what is
    // left of the drag tells whether the frozen state was good enough. The
    // candidates at u then show what has come near, and whether points have
    // passed through each other.
    seen_slides.clear();
    const std::vector<State>    now = states(u);
    std::vector<Tensor<1, dim>> ways;
    Renewal                     result;
    for (const State &state : now)
      ways.push_back(state.u);
    for (const Pair &pair : pairs)
      {
        const Tensor<1, dim> w = ways[pair.b] - ways[pair.c] - pair.jump;
        const double         p =
          -law.kappa * std::min(gap(pair, ways), 0.) * pair.across.norm();
        const Tensor<1, dim> slide = along(pair, w);
        const double         drag  = pair.weight * pair.drag;
        result.normal += pair.weight * p;
        result.tangential += drag * slide.norm();
        if (const auto last = slides.find({pair.b, pair.c});
            last != slides.end() && last->second.norm() > 0.)
          result.onward += drag * (slide * last->second) / last->second.norm();
        // Also of a pair that has lost its pressure by sliding.
        if (p > 0. || pair.gap < 0.)
          result.slid =
            std::max(result.slid,
                     along(pair, ways[pair.b] - ways[pair.c]).norm());
        seen_slides.emplace(ContactPair{pair.b, pair.c}, slide);
      }
    seen       = pairs_at(now, false);
    seen_links = link(seen);
    for (const Pair &pair : seen)
      if (seen_slides.count({pair.b, pair.c}) == 0)
        result.of_new_pairs +=
          pair.weight * law.kappa * std::max(-pair.gap, 0.);
    result.has_new_links = seen_links != links_;
    // A pair that overlaps far more than at t has crossed, if it does so along
    // its normals at t as well: patches that turn change their overlap where
    // they are. What overlaps less is a new pair, which the next turn pushes
    // apart: a fold that snaps shut brings points together that were too far
    // apart at t.
    const double deep   = crossing * ContactPoints<dim>::deepest_pair * law.h;
    const auto   normal = [this](const unsigned int p) {
      return points.points()[p].area / points.points()[p].area.norm();
    };
    for (std::size_t k = 0; k < points.pairs().size(); ++k)
      if (const auto pair = facing(k, now); pair && pair->beside < pair->reach)
        {
          const auto &[b, c] = points.pairs()[k];
          const double overlap =
            std::min(pair->overlap,
                     0.5 * (normal(b) - normal(c)) * (now[b].x - now[c].x));
          if (overlap > deep + std::max(0., -first_gaps[k]))
            result.crossed = std::max(result.crossed, overlap);
        }
    return result;
  }


  template <int dim>
  std::vector<ForceBetween<dim>>
  ContactPairs<dim>::forces(const std::vector<double> &u) const
  {
    // Each pair that touches adds its force to both points, apart for each body
    // that touches a point. What the drag of the last turn has left counts: it
    // is part of the equilibrium. The part that presses is the same on both.
    const std::vector<State>    now = states(u);
    std::vector<Tensor<1, dim>> ways;
    for (const State &state : now)
      ways.push_back(state.u);
    std::map<std::pair<unsigned int, unsigned int>, ForceBetween<dim>> sums;
    for (const Pair &pair : pairs)
      {
        const double g = std::min(gap(pair, ways), 0.);
        if (g == 0. && pair.slow == 0.)
          continue;
        const Tensor<1, dim> t = force(pair, ways);
        const double         normal =
          -pair.weight * law.kappa * g * pair.across.norm_square();
        const auto add = [&](const unsigned int    k,
                             const unsigned int    other,
                             const Tensor<1, dim> &force) {
          const unsigned int body = points.points()[other].body;
          ForceBetween<dim> &sum =
            sums
              .emplace(std::make_pair(k, body),
                       ForceBetween<dim>{
                         k, points.points()[k].body, body, {}, 0., now[k].x})
              .first->second;
          sum.force += force;
          sum.normal += normal;
        };
        add(pair.b, pair.c, t);
        add(pair.c, pair.b, -t);
      }
    std::vector<ForceBetween<dim>> list;
    for (const auto &[key, sum] : sums)
      list.push_back(sum);
    return list;
  }


  template class ContactPairs<2>;
  template class ContactPairs<3>;
} // namespace Morula
