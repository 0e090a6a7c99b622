// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/effects/contact/contact_pairs.h>
#include <morula/grid/grid_box.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** Points may face each other only if the product of their normals is below
     *  this. It leaves room for turns within a step: a pair acts below -0.3. */
    constexpr double may_face = 0.2;

    /** How far points that overlap without a pressure may slide in a step until
     *  they touch, in units of h. */
    constexpr double short_slide = 0.5;

    /** Points of one strand that have pressed on each other do so up to this
     *  overlap, in units of h. */
    constexpr double small_overlap = 0.1;

    /** Value and gradient weights of the unknowns of a point at @p x. */
    template <int dim>
    void
    set_unknowns(const SplineSpace<dim> &space, ContactPoint<dim> &point)
    {
      // With u = C ũ inside a grid cell, the displacement of a place is
      // Σ_s (Σ_a C_as N_a) ũ_s, doc/theory.md (3.5).
      const auto &grid_cell =
        space.grid_cells()[space.entry(point.grid_cell, point.part)];
      const SplineValues<dim> splines(
        space.box().unit_position(point.x, space.box().index(grid_cell.number)),
        space.box().spacing());
      const unsigned int m = grid_cell.unknowns.size();
      point.unknowns       = grid_cell.unknowns;
      point.values.assign(m, 0.);
      point.gradients.assign(m, Tensor<1, dim>());
      const auto add =
        [&](const unsigned int s, const unsigned int a, const double weight) {
          point.values[s] += weight * splines.value[a];
          for (unsigned int d = 0; d < dim; ++d)
            point.gradients[s][d] += weight * splines.gradient[d][a];
        };
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        if (grid_cell.weights.empty())
          add(a, a, 1.);
        else
          for (unsigned int s = 0; s < m; ++s)
            add(s, a, grid_cell.weights[a * m + s]);
    }

    /** Appends the unknowns of a point of this rank's store to an answer. */
    template <int dim>
    void
    append_unknowns(const Tissue<dim>      &tissue,
                    const SplineSpace<dim> &space,
                    const unsigned int      p,
                    std::vector<double>    &answer)
    {
      const BoundaryPoints<dim> &store = tissue.boundary_points();
      ContactPoint<dim>          point;
      point.x         = store.position(p);
      point.body      = store.body(p);
      point.part      = store.part(p);
      point.grid_cell = space.box().number(space.box().locate(point.x));
      set_unknowns(space, point);
      answer.push_back(point.unknowns.size());
      for (std::size_t s = 0; s < point.unknowns.size(); ++s)
        {
          answer.push_back(
            space.relevant().nth_index_in_set(point.unknowns[s]));
          answer.push_back(point.values[s]);
          append_flat(answer, point.gradients[s]);
        }
    }

    /** The boundary points of all ranks within @p reach (µm) of this rank's,
     * and some more, without their unknowns. Collective. */
    template <int dim>
    std::vector<ContactPoint<dim>>
    points_around(const Tissue<dim> &tissue, const double reach)
    {
      // Ranks tell each other a point's area vector, body, part, spacing,
      // pressure, and position in the store.
      using Message                    = std::tuple<Tensor<1, dim>,
                                                    unsigned int,
                                                    unsigned int,
                                                    double,
                                                    double,
                                                    unsigned int>;
      const BoundaryPoints<dim> &store = tissue.boundary_points();
      const GridBox<dim>        &box   = tissue.grid().box();
      const auto append = [&](const unsigned int p, std::vector<double> &list) {
        append_flat(list,
                    Message(store.area_vector(p),
                            store.body(p),
                            store.part(p),
                            store[p].spacing(),
                            store.get(store.columns().contact_pressure, p),
                            p));
      };
      const PointList<dim> near =
        near_points(store.positions(),
                    store,
                    {Flat<Message>::n, append, Ties::lowest_id},
                    tissue.grid(),
                    static_cast<int>(std::ceil(reach / box.spacing())));
      std::vector<ContactPoint<dim>> points;
      for (unsigned int i = 0; i < near.size(); ++i)
        {
          const auto [area, body, part, spacing, pressure, p] =
            near.template value<Message>(i);
          const GridIndex<dim> index = box.locate(near.positions[i]);
          points.push_back({near.ids[i],
                            body,
                            part,
                            near.positions[i],
                            area,
                            spacing,
                            pressure,
                            tissue.grid().owner(index),
                            p,
                            box.number(index),
                            {},
                            {},
                            {}});
        }
      return points;
    }

    /** Whether two points whose outward unit normals are @p n and @p m may come
     *  into contact in the step. */
    template <int dim>
    bool
    may_touch(const ContactPoint<dim> &a,
              const Tensor<1, dim>    &n,
              const ContactPoint<dim> &b,
              const Tensor<1, dim>    &m,
              const Tissue<dim>       &tissue)
    {
      // Points of one body with a gap between them may meet. The sides of a
      // sheet, or of an edge, overlap for ever, which is no contact: bonds
      // connect them. They also connect the sides of a fold at its end, which
      // have contact if they had it before. What overlaps without a pressure is
      // looked at only where points stand before each other, since the search
      // along bonds takes long.
      if (a.body != b.body || !tissue.boundary_points().has_parts())
        return a.body != b.body;
      const double         h        = tissue.grid().box().spacing();
      const Tensor<1, dim> across   = 0.5 * (m - n);
      const Tensor<1, dim> distance = a.x - b.x;
      const double         gap      = across * distance;
      if (gap >= 0. ||
          (a.pressure > 0. && b.pressure > 0. && gap > -small_overlap * h))
        return true;
      const double beside =
        (distance - gap / across.norm_square() * across).norm();
      return gap > -2. * ContactPoints<dim>::deepest_pair * h &&
             beside <
               ContactPoints<dim>::kernel * std::max(a.spacing, b.spacing) +
                 short_slide * h &&
             !tissue.parting().are_connected(a.id, b.id);
    }
  } // namespace


  template <int dim>
  ContactPoints<dim>::ContactPoints(const Tissue<dim> &tissue,
                                    SplineSpace<dim>  &space,
                                    const double       way)
    : way_(way)
  {
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    for (unsigned int p = 0; p < store.size(); ++p)
      largest_spacing_ = std::max(largest_spacing_, store[p].spacing());
    largest_spacing_ =
      Utilities::MPI::max(largest_spacing_, tissue.communicator());
    find_pairs(tissue, kernel * largest_spacing_ + way);
    any_ = Utilities::MPI::logical_or(!pairs_.empty(), tissue.communicator());
    if (any_)
      find_unknowns(tissue, space);
  }


  template <int dim>
  void
  ContactPoints<dim>::find_pairs(const Tissue<dim> &tissue, const double reach)
  {
    // Each rank gets the boundary points of all ranks around its own. Of each
    // pair the point with the lower id looks.
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(tissue.communicator());
    const std::vector<ContactPoint<dim>> near = points_around(tissue, reach);
    std::vector<Point<dim>>              positions;
    std::vector<Tensor<1, dim>>          n; // outward unit normals
    for (const ContactPoint<dim> &point : near)
      {
        positions.push_back(point.x);
        n.push_back(point.area / point.area.norm());
      }
    const PointBins<dim>     bins(tissue.grid().box(), positions);
    std::vector<ContactPair> found; // places in `near`
    for (unsigned int i = 0; i < near.size(); ++i)
      if (near[i].owner == rank)
        bins.visit_within(positions[i], reach, [&](const unsigned int j) {
          if (near[j].id > near[i].id && n[i] * n[j] < may_face &&
              may_touch(near[i], n[i], near[j], n[j], tissue))
            found.emplace_back(i, j);
        });
    number_points(near, found, rank);
  }


  template <int dim>
  void
  ContactPoints<dim>::number_points(const std::vector<ContactPoint<dim>> &near,
                                    const std::vector<ContactPair>       &found,
                                    const unsigned int                    rank)
  {
    // This rank's points come first, each group by id, and pairs by the ids of
    // their points, so that nothing depends on the order of a search.
    std::map<std::pair<bool, types::particle_index>, unsigned int> places;
    for (const auto &[i, j] : found)
      for (const unsigned int k : {i, j})
        places[{near[k].owner != rank, near[k].id}] = k;
    std::map<unsigned int, unsigned int> number; // by place in `near`
    for (const auto &[key, k] : places)
      {
        number[k] = points_.size();
        points_.push_back(near[k]);
      }
    for (const auto &[i, j] : found)
      pairs_.emplace_back(number.at(i), number.at(j));
    std::sort(pairs_.begin(),
              pairs_.end(),
              [&](const ContactPair &a, const ContactPair &b) {
                return std::make_pair(points_[a.first].id,
                                      points_[a.second].id) <
                       std::make_pair(points_[b.first].id,
                                      points_[b.second].id);
              });
  }


  template <int dim>
  void
  ContactPoints<dim>::find_unknowns(const Tissue<dim> &tissue,
                                    SplineSpace<dim>  &space)
  {
    // A rank asks the owners of other ranks' points for their unknowns, by
    // position in their stores. An answer is a list of numbers: how many
    // unknowns, then each unknown's global number, its value and its gradient.
    // All foreign unknowns become relevant at once, since that changes the
    // positions of the others.
    const MPI_Comm     comm = tissue.communicator();
    const unsigned int rank = Utilities::MPI::this_mpi_process(comm);
    std::map<unsigned int, std::vector<unsigned int>> questions;
    for (const ContactPoint<dim> &point : points_)
      if (point.owner != rank)
        questions[point.owner].push_back(point.p);
    std::map<unsigned int, std::vector<double>> answers;
    for (const auto &[asking, list] : send_records(questions, comm))
      for (const unsigned int p : list)
        append_unknowns(tissue, space, p, answers[asking]);
    const auto     received = send_records(answers, comm);
    constexpr auto width    = 2 + dim;        // numbers for each unknown
    std::map<unsigned int, std::size_t> next; // number to be read, by owner
    std::vector<std::vector<types::global_dof_index>> global(points_.size());
    std::vector<types::global_dof_index>              foreign;
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (ContactPoint<dim> &point = points_[k]; point.owner != rank)
        {
          const std::vector<double> &answer = received.at(point.owner);
          std::size_t               &i      = next[point.owner];
          const auto                 n = static_cast<std::size_t>(answer[i++]);
          for (std::size_t s = 0; s < n; ++s, i += width)
            {
              global[k].push_back(answer[i]);
              point.values.push_back(answer[i + 1]);
              point.gradients.push_back(
                Flat<Tensor<1, dim>>::read(&answer[i + 2]));
            }
          foreign.insert(foreign.end(), global[k].begin(), global[k].end());
        }
    std::sort(foreign.begin(), foreign.end());
    foreign.erase(std::unique(foreign.begin(), foreign.end()), foreign.end());
    IndexSet more(space.owned().size());
    more.add_indices(foreign.begin(), foreign.end());
    space.add_relevant(more);
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (points_[k].owner == rank)
        set_unknowns(space, points_[k]);
      else
        for (const auto unknown : global[k])
          points_[k].unknowns.push_back(
            space.relevant().index_within_set(unknown));
  }


  template <int dim>
  std::vector<ForceBetween<dim>>
  contact_forces(const ContactPoints<dim>             &points,
                 const std::vector<ForceBetween<dim>> &of_pairs,
                 const MPI_Comm                        comm)
  {
    // A rank knows the forces of its pairs, also on points of other ranks. They
    // go to the owners of the points, which add up what comes from several
    // ranks in the order of these.
    std::map<unsigned int, std::vector<ForceBetween<dim>>> by_owner;
    for (const ForceBetween<dim> &one : of_pairs)
      {
        const ContactPoint<dim> &point = points.points()[one.p];
        by_owner[point.owner].push_back(one);
        by_owner[point.owner].back().p = point.p;
      }
    std::map<std::pair<unsigned int, unsigned int>, ForceBetween<dim>> sums;
    for (const auto &[rank, list] : send_records(by_owner, comm))
      for (const ForceBetween<dim> &one : list)
        {
          const auto [sum, is_new] =
            sums.emplace(std::make_pair(one.p, one.other), one);
          if (!is_new)
            {
              sum->second.force += one.force;
              sum->second.normal += one.normal;
            }
        }
    std::vector<ForceBetween<dim>> result;
    for (const auto &[key, sum] : sums)
      result.push_back(sum);
    return result;
  }


  MORULA_INSTANTIATE(contact_forces);
  template class ContactPoints<2>;
  template class ContactPoints<3>;
} // namespace Morula
