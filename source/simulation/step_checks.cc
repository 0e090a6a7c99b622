// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/particles/nearest.h>
#include <morula/simulation/step_checks.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <sstream>

namespace Morula
{
  template <int dim>
  bool
  inverts(const DisplacementField<dim> &displacement,
          const PointStore<dim>        &store,
          const MPI_Comm                comm)
  {
    // f is taken at each point's own position, in the configuration at t. The
    // sum makes all ranks agree, so that they reject the step together.
    unsigned int inverted = 0;
    displacement.at_points(store,
                           [&](const unsigned int,
                               const LocalField<dim>   &field,
                               const SplineValues<dim> &splines) {
                             const Tensor<2, dim> f =
                               field.step_deformation(splines);
                             if (!(determinant(f) > 0.))
                               ++inverted;
                           });
    return Utilities::MPI::sum(inverted, comm) > 0;
  }

  template <int dim>
  void
  check_gap(const Extreme<dim> &gap, const double largest_gap, const double h)
  {
    // The gap is that of all ranks, so that all throw.
    if (largest_gap == 0. || gap.value <= largest_gap * h)
      return;
    std::ostringstream text;
    text << "The fixed surface slips: its point at (" << gap.place << ") um is "
         << gap.value
         << " um from its prescribed place, more than Solver/Largest gap = "
         << largest_gap << " grid spacings. A higher Boundary "
         << "conditions/Nitsche penalty holds it";
    throw StepFailed(text.str());
  }

  template <int dim>
  std::string
  torn_tissue_message(const std::vector<Point<dim>> &cells,
                      const std::vector<Point<dim>> &boundary_points,
                      const GridBox<dim>            &box,
                      const MPI_Comm                 comm)
  {
    // The box around all points follows from one reduction: the largest
    // coordinates, and the largest of the negative ones for the lower corner.
    // Its grid cells are counted as a floating-point number, as an integer
    // could overflow just where this matters. A rank without points leaves the
    // box alone.
    constexpr double    infinity = std::numeric_limits<double>::infinity();
    std::vector<double> reach(2 * dim, -infinity);
    for (const auto *points : {&cells, &boundary_points})
      for (const Point<dim> &x : *points)
        for (unsigned int d = 0; d < dim; ++d)
          {
            reach[d]       = std::max(reach[d], x[d]);
            reach[dim + d] = std::max(reach[dim + d], -x[d]);
          }
    Utilities::MPI::max(reach, comm, reach);
    double     n_grid_cells = 1.;
    Point<dim> lower, upper;
    for (unsigned int d = 0; d < dim; ++d)
      {
        upper[d] = reach[d];
        lower[d] = -reach[dim + d];
        n_grid_cells *= (upper[d] - lower[d]) / box.spacing() + 1.;
      }
    const double n_cells = Utilities::MPI::sum(1. * cells.size(), comm);
    // Tables over two million grid cells fit in any memory, and tissue of many
    // cells may have more of them, also where it is as sparse as one cell in
    // 100. The third bound lets a step double the box in each of three
    // directions.
    if (n_grid_cells <= std::max(2e6 + 100. * n_cells, 8. * box.size()))
      return "";
    std::ostringstream text;
    text << "points have left the tissue: it would reach from (" << lower
         << ") to (" << upper << ") um, over " << n_grid_cells
         << " grid cells. Look at the surface in the last output; choose a "
            "shape without corners that lie far from the cells, another "
            "Grid/Spacing, or Grid/Points per cell = 2";
    return text.str();
  }

  MORULA_INSTANTIATE(inverts);
  MORULA_INSTANTIATE(check_gap);
  MORULA_INSTANTIATE(torn_tissue_message);


  namespace
  {
    /** The largest turn of tissue, 36°: two points that did not face each
     *  other, whose normals' product was above -0.3, do not look at each other
     *  straight after both have turned by less. */
    const double largest_turn = std::acos(0.8);

    /** How much of tissue that has turned so far counts, in h^dim: single cells
     *  at the end of a fold may turn. */
    constexpr double strand = 0.3;

    /** The cosine of the angle by which f = R U turns, from the trace of R. */
    template <int dim>
    double
    cosine_of_turn(const Tensor<2, dim> &f)
    {
      double trace = 0.;
      for (const auto &[square, e] : eigenvectors(symmetrize(transpose(f) * f)))
        trace += e * (f * e) / std::sqrt(square);
      return dim == 2 ? 0.5 * trace : 0.5 * (trace - 1.);
    }
  } // namespace


  template <int dim>
  bool
  turns_too_far(const Tissue<dim>            &tissue,
                const SplineSpace<dim>       &space,
                const DisplacementField<dim> &displacement,
                const double                  part)
  {
    // Cells tell how the tissue turns, as boundary points beyond the last ones
    // see an extrapolated field. Of cells that turn those of a piece within h
    // around are taken together, so that a few do not count, nor single cells
    // between the sides of a fold, which nothing keeps from turning. The part
    // of f - I that turns by φ is as large as √2 sin φ, which is faster to look
    // at.
    const double sine             = std::sin(part * largest_turn),
                 cosine           = std::cos(part * largest_turn);
    const Cells<dim>       &cells = tissue.cells();
    const double            h     = tissue.grid().box().spacing();
    std::vector<double>     turned(cells.size(), 0.); // volume, µm^dim
    std::vector<double>     pieces;                   // of all cells
    std::vector<Point<dim>> queries;
    std::vector<double>     of_queries;
    for (const auto &grid_cell : cells.grid_cells())
      pieces.resize(grid_cell.end,
                    space.piece(grid_cell.number, grid_cell.part));
    displacement.at_points(
      cells,
      [&](const unsigned int       p,
          const LocalField<dim>   &field,
          const SplineValues<dim> &splines) {
        const Tensor<2, dim> f = field.step_deformation(splines);
        if ((f - Tensor<2, dim>(unit_symmetric_tensor<dim>())).norm() < sine ||
            cosine_of_turn(f) > cosine)
          return;
        turned[p] = cells.volume(p);
        queries.push_back(cells.position(p));
        of_queries.push_back(pieces[p]);
      });
    const auto numbers = [&](const unsigned int p, std::vector<double> &list) {
      list.push_back(turned[p]);
      list.push_back(pieces[p]);
    };
    const PointList<dim> near = near_points(
      queries, cells, {2, numbers, Ties::lowest_id}, tissue.grid(), 1);
    const NearTree<dim> tree(near.positions);
    double              largest = 0.;
    for (std::size_t k = 0; k < queries.size(); ++k)
      {
        double volume = 0.;
        for (const unsigned int i : tree.within(queries[k], h))
          if (near.row(i)[1] == of_queries[k])
            volume += near.row(i)[0];
        largest = std::max(largest, volume);
      }
    return Utilities::MPI::max(largest, tissue.communicator()) >
           strand * Utilities::fixed_power<dim>(h);
  }


  template <int dim>
  void
  check_turn(const Tissue<dim>            &tissue,
             const SplineSpace<dim>       &space,
             const DisplacementField<dim> &displacement)
  {
    if (tissue.cells().has_parts() &&
        turns_too_far(tissue, space, displacement))
      throw StepFailed("a strand of the tissue rotates by more than 36 "
                       "degrees, so that the step is too long for its contact");
  }


  MORULA_INSTANTIATE(turns_too_far);
  MORULA_INSTANTIATE(check_turn);


  namespace
  {
    /** A neck is narrower than this, in units of h; the parts that it joins are
     *  wider. */
    constexpr double narrow = 3.;

    /** The surface of all ranks: positions, with areas times normals in their
     *  rows. Collective. */
    template <int dim>
    PointList<dim>
    surface_of(const Tissue<dim> &tissue)
    {
      const auto    &points = tissue.boundary_points();
      PointList<dim> list(dim);
      for (unsigned int p = 0; p < points.size(); ++p)
        {
          std::vector<double> row;
          append_flat(row, points.area_vector(p));
          list.add(points.id(p), points.position(p), make_array_view(row));
        }
      return of_all_ranks(list, tissue.communicator());
    }

    /** Whether two points of the surface look away from each other that are
     *  nearer than a neck is wide. One point of each of the @p cubes counts,
     *  whose edge is h/2. */
    template <int dim>
    bool
    has_narrow_part(const PointList<dim> &surface, const GridBox<dim> &cubes)
    {
      constexpr double         most_cosine = -0.5; // of their normals
      std::set<GridIndex<dim>> taken;
      PointList<dim>           some(dim);
      for (unsigned int i = 0; i < surface.size(); ++i)
        if (taken.insert(cubes.locate(surface.positions[i])).second)
          some.add(surface.ids[i], surface.positions[i], surface.row(i));
      const auto normal = [&](const unsigned int i) {
        const auto area = Flat<Tensor<1, dim>>::read(some.row(i).data());
        return area / area.norm();
      };
      const NearTree<dim> tree(some.positions);
      for (unsigned int i = 0; i < some.size(); ++i)
        for (const unsigned int j :
             tree.within(some.positions[i],
                         (2. * narrow + 1.) * cubes.spacing()))
          if (normal(i) * normal(j) < most_cosine)
            return true;
      return false;
    }

    /** Where two wide parts of tissue meet in a narrow place: its width and
     *  position, µm; infinity if nowhere.
     *  @param places in the tissue, with depth (µm) and body in their rows */
    template <int dim>
    std::vector<double>
    narrowest_meeting(const PointList<dim> &places, const double h)
    {
      // Places are visited from the deepest on, and join those around, within
      // more than two cubes' edges; balls in tissue around neighbours overlap,
      // but for a fifth that the cubes leave open. Where two parts meet is a
      // neck, if both are wide. The deepest of a part is its root.
      constexpr double widening = 1.4; // of a part beside the neck
      const auto depth = [&](const unsigned int i) { return places.row(i)[0]; };
      std::vector<double>       best{std::numeric_limits<double>::infinity()};
      std::vector<unsigned int> order(places.size()),
        root(places.size(), places.size());
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(),
                       order.end(),
                       [&](const auto i, const auto j) {
                         return depth(i) > depth(j);
                       });
      const auto root_of = [&](unsigned int i) {
        while (root[i] != i)
          i = root[i] = root[root[i]];
        return i;
      };
      const std::vector<Point<dim>> &x = places.positions;
      const NearTree<dim>            tree(x);
      for (const unsigned int i : order)
        {
          root[i] = i;
          for (const unsigned int j : tree.within(x[i], 0.6 * h))
            if (root[j] < places.size() &&
                places.row(j)[1] == places.row(i)[1] &&
                x[i].distance(x[j]) <= 1.2 * (depth(i) + depth(j)))
              {
                unsigned int a = root_of(i), b = root_of(j);
                if (depth(a) < depth(b))
                  std::swap(a, b);
                if (a != b && 2. * depth(i) < narrow * h &&
                    depth(b) >= std::max(narrow * h / 2., widening * depth(i)))
                  {
                    best = {2. * depth(i)};
                    append_flat(best, x[i]);
                  }
                root[b] = a;
              }
        }
      return best;
    }
  } // namespace


  template <int dim>
  std::vector<double>
  narrowest_neck(const Tissue<dim> &tissue)
  {
    // Where the surface has no narrow part there is no neck, which costs least
    // to see. One cell of each cube of a quarter of a grid spacing tells how
    // deep the tissue is there: half of the way to the nearest point of the
    // surface and on to the other side.
    const double         h       = tissue.grid().box().spacing();
    const PointList<dim> surface = surface_of(tissue);
    const NearTree<dim>  tree(surface.positions);
    PointList<dim>       places(2);
    const Point<dim>     corner = tissue.grid().box().corner({});
    if (!has_narrow_part(surface, {{}, {}, h / 2., corner}))
      return narrowest_meeting(places, h);
    const Cells<dim>  &cells = tissue.cells();
    const GridBox<dim> cubes({}, {}, h / 4., corner);
    std::set<std::pair<unsigned int, GridIndex<dim>>> taken;
    for (unsigned int p = 0; p < cells.size(); ++p)
      if (taken.emplace(cells.body(p), cubes.locate(cells.position(p))).second)
        {
          const Point<dim> x   = cells.position(p),
                           one = surface.positions[tree.nearest(x)],
                           other =
                             surface.positions[tree.nearest(x + (x - one))];
          const double row[] = {0.5 * (x.distance(one) + x.distance(other)),
                                1. * cells.body(p)};
          places.add(cells.id(p), x, make_array_view(row, row + 2));
        }
    return narrowest_meeting(of_all_ranks(places, tissue.communicator()), h);
  }


  MORULA_INSTANTIATE(narrowest_neck);


  namespace
  {
    /** Half a step begins with half the force where the force comes from the
     *  step. With more than this, something does not come from it. */
    constexpr double part_that_stays = 0.8;

    /** Cells that are neither squeezed nor stretched beyond these do not make a
     *  step fail by themselves. */
    constexpr double healthy_J = 0.3;

    /** A held point with a smaller J_e is crushed. */
    constexpr double crushed_J = 0.01;

    std::string
    of_jump(const FailedStep &step)
    {
      std::ostringstream text;
      text << " A step of " << step.part << " times the length begins with "
           << step.last_force / step.first_force
           << " times the unbalanced force: a load, stiffness, growth or "
              "displacement jumps in time, or the last state is about to fold. "
              "Let what jumps rise over some steps, as ramp(t, t0, t1) does; "
              "after a jump there may be more than one equilibrium.";
      return text.str();
    }

    std::string
    of_fold(const FailedStep &step)
    {
      std::ostringstream text;
      text << " The tissue folds or buckles: along some motion it has no "
              "stiffness left. A Friction/Coefficient of about "
           << step.friction
           << " kPa day/um^2 lets the fold take a step; compare with a third "
              "and three times of it, as friction decides which fold is found "
              "(doc/modelling.md, Folds). A finer grid may help, too.";
      return text.str();
    }
  } // namespace


  // The surest sign comes first (doc/theory.md, section 5.10): a negative
  // energy of an unloaded body has one cause, while a fold is what is left when
  // all other causes are out. A jump shows only when the step was halved twice
  // (part below 0.3), since only then it is clear that the force does not fall
  // with the length.
  std::string
  diagnosis(const FailedStep &step)
  {
    if (step.symmetric && step.smallest_J < crushed_J && step.energy < 0. &&
        !step.loaded)
      return " A fixed point is crushed there: the symmetric Nitsche form "
             "has no least energy. Set Boundary conditions/Nitsche form = "
             "bounded.";
    if (step.part < 0.3 && step.last_force > part_that_stays * step.first_force)
      return of_jump(step);
    if (step.smallest_J < healthy_J)
      return "";
    return step.curvature < 0. ? of_fold(step) : "";
  }


  double
  friction_against(const double curvature,
                   const double E,
                   const double h,
                   const double dt)
  {
    // This is doc/theory.md (5.8).
    return -curvature * E * dt / (h * h);
  }
} // namespace Morula
