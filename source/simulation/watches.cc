// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/point_exchange.h>
#include <morula/simulation/step_checks.h>
#include <morula/simulation/watches.h>
#include <morula/surface/walls.h>

#include <deal.II/base/mpi.templates.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace Morula
{
  namespace
  {
    /** The least cosine of the angle between a normal and the way to the other
     *  side, and of that between one normal and the other one turned round:
     *  the two sides need not be quite parallel. Neighbours on one side never
     *  count, as their normals point the same way. */
    constexpr double least_cosine = 0.8;

    /** The largest part of the cells that may be behind held sides. */
    constexpr double most_behind = 0.01;

    /** A cell is outside if it is deeper there than this part of its size. */
    constexpr double outside = 0.1;

    template <int dim>
    using Forbidden = typename BoundaryCondition<dim>::Forbidden;

    /** The narrowest gap across which splines reach: its width and the
     *  coordinates of its middle, µm; an infinite width if there is none. Two
     *  boundary points look at each other there through empty space, and their
     *  grid cells share unknowns. Collective. */
    template <int dim>
    std::vector<double>
    narrowest_gap(const Tissue<dim> &tissue, const SplineSpace<dim> &space)
    {
      // Each rank looks around its own boundary points, as far as splines
      // reach. All points come with their areas and with the unknowns of
      // their grid cells, some of them twice, so that all rows are as long.
      // Equal widths, as in a symmetric tissue, are told apart by the place.
      // So all ranks, and any number of them, choose the same gap.
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      const GridBox<dim>        &box    = space.box();
      const double               widest = 2. * box.spacing();
      std::size_t                most   = 0;
      for (const auto &grid_cell : space.grid_cells())
        most = std::max(most, grid_cell.unknowns.size());
      PointList<dim> near(dim +
                          Utilities::MPI::max(most, tissue.communicator()));
      for (unsigned int p = 0; p < points.size(); ++p)
        {
          const Point<dim>   x = points.position(p);
          const unsigned int entry =
            space.entry(box.number(box.locate(x)), points.body(p));
          const auto         &list = space.grid_cells()[entry].unknowns;
          std::vector<double> row;
          append_flat(row, points.area_vector(p));
          for (unsigned int k = 0; row.size() < near.n_numbers; ++k)
            row.push_back(
              space.relevant().nth_index_in_set(list[k % list.size()]));
          near.add(points.id(p), x, make_array_view(row));
        }
      near.append(halo(near, tissue.grid(), widest));
      const NearTree<dim> tree(near.positions);
      const auto          normal = [&](const unsigned int i) {
        const auto area = Flat<Tensor<1, dim>>::read(near.row(i).data());
        return area / area.norm();
      };
      const auto stick = [&](const unsigned int i, const unsigned int j) {
        const auto a = near.row(i), b = near.row(j);
        return std::find_first_of(&a[dim], a.end(), &b[dim], b.end()) !=
               a.end();
      };
      std::vector<double> best{std::numeric_limits<double>::infinity()};
      for (unsigned int i = 0; i < near.size(); ++i)
        {
          // All that a point faces lies in a ball before it that touches it.
          const Tensor<1, dim> n = normal(i);
          const double radius = std::min(widest, best[0]) / (2. * least_cosine);
          for (const unsigned int j :
               tree.within(near.positions[i] + radius * n,
                           radius * (1. + 1e-9)))
            {
              const Tensor<1, dim> way = near.positions[j] - near.positions[i];
              const Tensor<1, dim> m   = normal(j);
              std::vector<double>  gap{way.norm()};
              const double         least = least_cosine * gap[0];
              if (gap[0] >= widest || way * n <= least || way * m >= -least ||
                  n * m >= -least_cosine || !stick(i, j))
                continue;
              append_flat(gap, Point<dim>(near.positions[i] + 0.5 * way));
              best = std::min(best, gap);
            }
        }
      const auto all = Utilities::MPI::all_gather(tissue.communicator(), best);
      return *std::min_element(all.begin(), all.end());
    }

    /** The numbers of a cell at @p x (µm) that is farther outside than @p depth
     *  (µm): how far, its place, the number of the obstacle, or one more, and
     *  the normal of the side that it is @p behind (µm). Empty if it is not. */
    template <int dim>
    std::vector<double>
    row_of(const Point<dim>                  &x,
           double                             depth,
           const std::vector<Forbidden<dim>> &places,
           const Tensor<1, dim>              &behind)
    {
      unsigned int which = places.size() + 1;
      for (unsigned int k = 0; k < places.size(); ++k)
        if (const double found = places[k].second(x).norm(); found > depth)
          {
            depth = found;
            which = k;
          }
      const bool is_behind = behind.norm() > depth;
      if (!is_behind && which > places.size())
        return {};
      std::vector<double> row{is_behind ? behind.norm() : depth};
      append_flat(row, x);
      append_flat(row, is_behind ? unsigned(places.size()) : which);
      append_flat(row, behind / std::max(behind.norm(), depth));
      return row;
    }

    /** How many cells are where none may be: all and those in obstacles and
     *  behind sides, @p n, and the numbers of the farthest. */
    template <int dim>
    std::string
    text_of(const std::vector<std::uint64_t>  &n,
            const double *const                farthest,
            const std::vector<Forbidden<dim>> &places)
    {
      const unsigned int which = farthest[dim + 1];
      std::ostringstream text;
      text << n[1] + n[2] << " of " << n[0]
           << " cells lie where none may be, the farthest by " << farthest[0]
           << " um at (" << Flat<Point<dim>>::read(farthest + 1) << ") um, ";
      if (which < places.size())
        text << "in the obstacle '" << places[which].first << "'. ";
      else
        text << "behind the fixed or slip side with the normal "
             << Flat<Tensor<1, dim>>::read(farthest + dim + 2) << ". ";
      return text.str();
    }
  } // namespace


  template <int dim>
  void
  Watches<dim>::look_at_conditions(const Tissue<dim> &tissue, const double t)
  {
    // Points keep the place and normal by which conditions choose them. The
    // names follow from the scene, so that all ranks add up the same ones.
    // Obstacles act where they touch and hold nothing. Some points may go with
    // their cells, and forces.csv has their number. Once the last one is gone
    // the scene is another one. Where all cells are gone nothing is left to be
    // told of.
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    const MPI_Comm             comm   = tissue.communicator();
    const auto                 n_cells =
      Utilities::MPI::sum<std::uint64_t>(tissue.cells().size(), comm);
    const auto look = [&](const std::string &name, const auto &acts_on) {
      std::uint64_t n = 0;
      for (unsigned int p = 0; p < points.size(); ++p)
        n += acts_on(points[p].seed_position(), points[p].initial_normal());
      n                          = Utilities::MPI::sum(n, comm);
      const std::uint64_t before = std::exchange(points_before[name], n);
      if (before == 0 || n > 0 || n_cells == 0)
        return;
      std::ostringstream text;
      text << "Warning: from t = " << t << " day on " << name
           << " acts on no boundary point any more, and did on " << before
           << " before: the cells near them are gone. What it fixed, loaded "
              "or fed goes on without it. Keep these cells alive, or choose "
              "a place that stays.";
      announce(text.str());
    };
    for (const auto &named : model.boundary_conditions.list())
      if (!named.condition->only_pushes())
        look(named.name, [&](const Point<dim> &X, const Tensor<1, dim> &N) {
          return named.condition->acts_on(X, N);
        });
    for (const EffectKeys *const keys : model.scene.keys_in_use())
      for (const ExpressionKey *const where : keys->facts().places)
        look(where->path(), [&](const Point<dim> &X, const Tensor<1, dim> &) {
          return where->expression(dim).value(X, 0.) > 0.;
        });
  }


  template <int dim>
  void
  Watches<dim>::look_at_pieces(const SplineSpace<dim> &space,
                               const MPI_Comm          comm,
                               const double            t)
  {
    // The user is told of the first joining and of the first parting only.
    // Only pieces with cells count. The first count has nothing to be compared
    // with.
    std::vector<unsigned int> has_cells(space.n_pieces(), 0);
    for (const auto &grid_cell : space.grid_cells())
      if (space.occupancy(grid_cell.part).n_particles(space.node(grid_cell)) >
          0)
        has_cells[space.piece(grid_cell.number, grid_cell.part)] = 1;
    Utilities::MPI::max(has_cells, comm, has_cells);
    const unsigned int before =
      std::exchange(n_pieces_,
                    std::count(has_cells.begin(), has_cells.end(), 1));
    const bool parts = n_pieces_ > before;
    if (before == 0 || n_pieces_ == before ||
        std::exchange(parts ? has_parted : has_joined, true))
      return;
    std::ostringstream text;
    text << "Warning: at t = " << t << " day the tissue has " << n_pieces_
         << " connected parts after " << before << ". "
         << (parts ?
               "Each moves on its own." :
               "If none has died, parts have come within a grid spacing of "
               "each other. They stick together from now on, though their "
               "cells may not touch yet (doc/faq.md, bodies that stick): set "
               "Contact/Between, or a smaller Grid/Spacing.")
         << " Further cases are not reported.";
    announce(text.str());
  }


  template <int dim>
  void
  Watches<dim>::look_at_gaps(const Tissue<dim>      &tissue,
                             const SplineSpace<dim> &space,
                             const double            t)
  {
    // When the user knows no rank searches any more.
    if (has_told_of_gap)
      return;
    const std::vector<double> gap = narrowest_gap(tissue, space);
    has_told_of_gap               = std::isfinite(gap[0]);
    if (!has_told_of_gap)
      return;
    std::ostringstream text;
    text << "Warning: from t = " << t
         << " day on two surfaces face each other at a distance of " << gap[0]
         << " um near (" << Flat<Point<dim>>::read(&gap[1])
         << ") um. The grid does not resolve so narrow a gap or lumen: its "
            "walls are coupled, and it hardly closes any further (doc/faq.md, "
            "bodies that stick). A smaller Grid/Spacing follows it down to two "
            "spacings. Further cases are not reported.";
    announce(text.str());
  }


  template <int dim>
  void
  Watches<dim>::look_at_necks(const Tissue<dim> &tissue, const double t)
  {
    if (has_told_of_neck)
      return;
    const double              h    = tissue.grid().box().spacing();
    const std::vector<double> neck = narrowest_neck(tissue);
    has_told_of_neck               = std::isfinite(neck[0]);
    if (!has_told_of_neck)
      return;
    std::ostringstream text;
    text << "Warning: from t = " << t << " day on the tissue has a neck about "
         << neck[0] << " um wide, " << neck[0] / h << " grid spacings, near ("
         << Flat<Point<dim>>::read(&neck[1])
         << ") um. The grid does not resolve so narrow a neck: that of two "
            "drops that fuse is 34 % too narrow at 2.6 spacings, 7 % at 5.8 "
            "and 0.2 % at 11. Set Grid/Spacing = "
         << neck[0] / 5.8 << " for the second. Further cases are not reported.";
    announce(text.str());
  }


  template <int dim>
  void
  Watches<dim>::look_at_losses(const Tissue<dim> &tissue,
                               const double       t,
                               const double       dt)
  {
    // Where a rate follows the state, what it was in the last step is kept in a
    // column. Who leaves relieves the others only in the next step.
    constexpr double most = 0.3;
    for (const auto &fate : model.development.fates().list)
      if (dynamic_cast<const Dies<dim> *>(fate.get()) != nullptr)
        for (unsigned int k = 0; k < fate->hazards(0).size(); ++k)
          {
            const CellHazard<dim> &hazard = fate->hazards(0)[k];
            if (!hazard.expected.exists() || has_told_of_losses)
              continue;
            double largest = 0.;
            for (unsigned int p = 0; p < tissue.cells().size(); ++p)
              largest =
                std::max(largest, dt * tissue.cells()[p].get(hazard.expected));
            largest = Utilities::MPI::max(largest, tissue.communicator());
            has_told_of_losses = largest > most;
            if (!has_told_of_losses)
              continue;
            std::ostringstream text;
            text
              << "Warning: in the step to t = " << t << " day the "
              << hazard.rate.key() << " of some cells times the step is "
              << largest
              << ", more than 0.3: cells leave together that would stay once "
                 "others have left, as the rate follows the state of the "
                 "step's beginning. Shorten Time/Step, or lower the rate. "
                 "Further cases are not reported.";
            announce(text.str());
          }
  }


  template <int dim>
  std::string
  Watches<dim>::around(const Tissue<dim> &tissue,
                       const Point<dim>  &x,
                       const double       t) const
  {
    // One-sided obstacles act on all points and remember none; where one pushes
    // a point, that is in it a little.
    const auto of_nearest = [&](const auto &store, const auto &text) {
      std::pair<double, unsigned int> nearest{
        std::numeric_limits<double>::infinity(), 0};
      for (unsigned int p = 0; p < store.size(); ++p)
        nearest = std::min(nearest, {store.position(p).distance(x), p});
      const auto all = Utilities::MPI::all_gather(
        tissue.communicator(),
        std::make_pair(nearest.first,
                       store.size() > 0 ? text(nearest.second) : ""));
      return std::min_element(all.begin(), all.end())->second;
    };
    const auto        names  = model.scene.cell_types.name_list();
    const auto       &points = tissue.boundary_points();
    const std::string cell =
      of_nearest(tissue.cells(), [&](const unsigned int p) {
        return std::to_string(tissue.cells().id(p)) +
               (names.empty() ?
                  "" :
                  " of type " + names[tissue.cells()[p].get(
                                  model.development.state().type)]);
      });
    const std::string  acts = of_nearest(points, [&](const unsigned int p) {
      const auto  point    = points[p];
      const auto &pressure = points.columns().contact_pressure;
      std::string text;
      for (const auto &[name, condition] : model.boundary_conditions.list())
        {
          if (!condition->only_pushes() &&
              condition->acts_on(point.seed_position(), point.initial_normal()))
            text += ", " + name;
          for (const auto &[obstacle, way_out] : condition->forbidden(t))
            if (way_out(points.position(p)).norm() > 0.)
              text += ", obstacle " + obstacle;
        }
      if (pressure.exists() && point.get(pressure) > 0.)
        text += ", contact";
      return text.empty() ? text : text.substr(2);
    });
    std::ostringstream text;
    text << " Nearest to (" << x << ") um is cell " << cell
         << "; on the surface next to it acts "
         << (acts.empty() ? "nothing" : acts) << '.';
    return text.str();
  }


  template <int dim>
  std::string
  Watches<dim>::look_at_cells(const Tissue<dim>         &tissue,
                              const std::vector<double> &walls,
                              const bool                 with_obstacles,
                              const double               t)
  {
    // Hardly ever a cell is behind the plane of a side, and only then the held
    // points tell whether it is behind the side itself. What began there may be
    // there. The farthest cell is that with the largest row: its depth, its
    // place, the number of the obstacle and the side's normal. So any number of
    // ranks finds the same one.
    const auto    &points     = tissue.boundary_points();
    const auto    &cells      = tissue.cells();
    const auto    &conditions = model.boundary_conditions;
    const MPI_Comm comm       = tissue.communicator();
    const double   near       = 0.5 * tissue.grid().box().spacing();
    if (!planes)
      {
        held   = walls.empty() ? walls_of(points, comm) : walls;
        planes = one_of_each_plane<dim>(held, 2. * near);
      }
    std::vector<Forbidden<dim>> places;
    for (const auto &named : conditions.list())
      for (const auto &place : named.condition->forbidden(t))
        if (with_obstacles)
          places.push_back(place);
    if (planes->empty() && places.empty())
      return "";
    const PlaceConditions<dim> scene{{}, {}, [&](const auto &point) {
                                       return conditions.displacement(point, t);
                                     }};
    const Walls<dim>           fronts(*planes, scene, points.columns());
    std::optional<Walls<dim>>  sides;
    std::vector<std::uint64_t> n{cells.size(), 0, 0};
    std::vector<double>        farthest(2 * dim + 2, 0.);
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const Point<dim> x = cells.position(p);
        Tensor<1, dim>   behind;
        if (fronts.any_behind(x))
          {
            if (!sides)
              sides.emplace(held, scene, points.columns());
            if (sides->behind(cells[p].founder_position(), near).norm() == 0.)
              behind = sides->behind(x, near);
          }
        const std::vector<double> row = row_of<dim>(
          x, outside * std::pow(cells.volume(p), 1. / dim), places, behind);
        if (row.empty())
          continue;
        ++n[row[dim + 1] == places.size() ? 2 : 1];
        farthest = std::max(farthest, row);
      }
    Utilities::MPI::sum(n, comm, n);
    if (n[1] + n[2] == 0)
      return "";
    const auto        all = Utilities::MPI::all_gather(comm, farthest);
    const std::string text =
      text_of<dim>(n, std::max_element(all.begin(), all.end())->data(), places);
    if (n[2] > most_behind * n[0])
      return text +
             "More than 1 % of the cells are behind sides that slip or are "
             "fixed: these act on the points of t = 0, not on places. No shorter "
             "step helps, but plane obstacles do (Obstacles/NAME/Two-sided).";
    if (!std::exchange(has_told_of_cells, true))
      announce("Warning: at t = " + as_text(t) + " day " + text +
               "Smaller steps and grid spacings keep more of them inside. "
               "Further cases are not reported.");
    return "";
  }

  template class Watches<2>;
  template class Watches<3>;
} // namespace Morula
