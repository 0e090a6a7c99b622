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
  MomentumBalance<dim>::MomentumBalance(const SplineSpace<dim> &space,
                                        const TermList         &terms,
                                        TimerOutput            &timer,
                                        const MPI_Comm          comm,
                                        const Enclosure<dim>   *enclosure)
    : space(space)
    , terms(terms)
    , timer(timer)
    , comm(comm)
    , assembly(space, comm)
    , enclosure(enclosure)
  {}

  template <int dim>
  Equilibrium::Vector
  MomentumBalance<dim>::rest() const
  {
    return assembly.unknowns().zero();
  }

  template <int dim>
  Equilibrium::Evaluation
  MomentumBalance<dim>::sum_up(const Vector &u,
                               Vector       &R,
                               Vector       *magnitudes) const
  {
    const TimerOutput::Scope section(timer, "residual");
    LocalSystem<dim>         system(wanted(magnitudes));
    std::vector<double>      sizes;
    Evaluation               evaluation;
    evaluation.smallest_J.value = std::numeric_limits<double>::infinity();
    double     energies[3]      = {0., 0., 0.};
    const auto add              = [&](const unsigned int     c,
                         const LocalField<dim> &field,
                         LocalSystem<dim>      &local) {
      for (const auto &term : terms)
        term->add(c, field, GrowthAt::current, local);
      update_extremes(local, space.grid_cells()[c].number, evaluation);
      energies[0] += local.energy;
      energies[1] += local.energy_magnitude;
      return !local.inverted;
    };
    const std::vector<double> sums = assembly.residual(
      u, system, add, magnitudes != nullptr ? &sizes : nullptr);
    energies[2] = system.inverted;
    double totals[3];
    Utilities::MPI::sum(energies, comm, totals);
    const bool inverted = totals[2] > 0.;
    evaluation.energy =
      inverted ? std::numeric_limits<double>::infinity() : totals[0];
    evaluation.energy_magnitude = inverted ? 0. : totals[1];
    if (!inverted)
      R = assembly.unknowns().sum(sums);
    if (!inverted && magnitudes != nullptr)
      *magnitudes = assembly.unknowns().sum(sizes);
    return evaluation;
  }

  template <int dim>
  Equilibrium::Evaluation
  MomentumBalance<dim>::residual(const Vector &u, Vector &R) const
  {
    return evaluate(u, R, nullptr);
  }

  template <int dim>
  Equilibrium::Evaluation
  MomentumBalance<dim>::residual_and_magnitude(const Vector &u,
                                               Vector       &R,
                                               double       &magnitude) const
  {
    Vector           magnitudes;
    const Evaluation evaluation = evaluate(u, R, &magnitudes);
    magnitude = magnitudes.size() == 0 ? 0. : magnitudes.l2_norm();
    return evaluation;
  }

  template <int dim>
  double
  MomentumBalance<dim>::residual_magnitude(const Vector &u) const
  {
    Vector R(u);
    double magnitude;
    residual_and_magnitude(u, R, magnitude);
    return magnitude;
  }

  template <int dim>
  Equilibrium::Evaluation
  MomentumBalance<dim>::evaluate(const Vector &u,
                                 Vector       &R,
                                 Vector       *magnitudes) const
  {
    Evaluation evaluation = sum_up(u, R, magnitudes);
    if (enclosure != nullptr && std::isfinite(evaluation.energy))
      add_content(u, evaluation, R, magnitudes);
    return evaluation;
  }

  template <int dim>
  typename LocalSystem<dim>::Wanted
  MomentumBalance<dim>::wanted(const Vector *magnitudes)
  {
    return magnitudes != nullptr ? LocalSystem<dim>::rounding :
                                   LocalSystem<dim>::energy_and_residual;
  }

  template <int dim>
  std::pair<double, double>
  MomentumBalance<dim>::gain(const Vector &u,
                             Vector       &derivative,
                             Vector       *magnitudes) const
  {
    const TimerOutput::Scope section(timer, "residual");
    LocalSystem<dim>         system(wanted(magnitudes));
    std::vector<double>      sizes;
    double                   volumes[2] = {0., 0.};
    const auto               add        = [&](const unsigned int     c,
                         const LocalField<dim> &field,
                         LocalSystem<dim>      &local) {
      enclosure->gain.add(c, field, GrowthAt::current, local);
      volumes[0] += local.energy;
      volumes[1] += local.energy_magnitude;
      return true;
    };
    derivative = assembly.unknowns().sum(assembly.residual(
      u, system, add, magnitudes != nullptr ? &sizes : nullptr));
    if (magnitudes != nullptr)
      *magnitudes = assembly.unknowns().sum(sizes);
    double totals[2];
    Utilities::MPI::sum(volumes, comm, totals);
    return {totals[0], totals[1]};
  }

  template <int dim>
  double
  MomentumBalance<dim>::enclosed_volume(const Vector &u) const
  {
    Vector ignored;
    return enclosure->volume + gain(u, ignored).first;
  }

  template <int dim>
  void
  MomentumBalance<dim>::add_content(const Vector &u,
                                    Evaluation   &evaluation,
                                    Vector       &R,
                                    Vector       *magnitudes) const
  {
    Vector b, sizes;
    const auto [gained, magnitude] =
      gain(u, b, magnitudes != nullptr ? &sizes : nullptr);
    const double V        = enclosure->volume + gained;
    const double pressure = enclosure->content.pressure(V);
    if (magnitudes != nullptr)
      magnitudes->add(std::abs(pressure), sizes);
    evaluation.energy += enclosure->content.energy(V, enclosure->volume);
    if (!std::isfinite(evaluation.energy))
      return;
    evaluation.energy_magnitude += std::abs(pressure) * magnitude;
    R.add(-pressure, b);
  }

  template <int dim>
  void
  MomentumBalance<dim>::update_extremes(const LocalSystem<dim> &system,
                                        const unsigned int      number,
                                        Evaluation &evaluation) const
  {
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
    // An unknown belongs to the place that is its coefficient in the field x.
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

  template <int dim>
  const TrilinosWrappers::SparseMatrix &
  MomentumBalance<dim>::tangent(const Vector &u, const GrowthAt growth)
  {
    if (!assembly.has_pattern())
      {
        const TimerOutput::Scope section(timer, "sparsity pattern");
        assembly.make_pattern();
      }
    const GrowthAt at       = goes_on ? GrowthAt::current : growth;
    double         pressure = 0.;
    if (enclosure != nullptr)
      {
        Vector       b;
        const double V = enclosure->volume + gain(u, b).first;
        pressure       = enclosure->content.pressure(V);
        of_content.emplace(
          RankOne{std::move(b), enclosure->content.stiffness(V)});
      }
    const TimerOutput::Scope section(timer, "tangent");
    if (growth == GrowthAt::previous)
      linearisations.clear();
    LocalSystem<dim> of_gain(LocalSystem<dim>::tangent);
    const auto       add = [&](const unsigned int     c,
                         const LocalField<dim> &field,
                         LocalSystem<dim>      &local) {
      local.last = !linearisations.empty() && linearisations[c] ?
                           &*linearisations[c] :
                           nullptr;
      // Hardly anything may resist extended splines, and some motions of thin
      // tissue.
      const auto &grid_cell = space.grid_cells()[c];
      local.in_single =
        dim == 3 && grid_cell.weights.empty() && !grid_cell.thin;
      for (const auto &term : terms)
        term->add(c, field, at, local);
      if (pressure != 0.)
        {
          of_gain.clear();
          enclosure->gain.add(c, field, at, of_gain);
          for (std::size_t k = 0; k < local.matrix.size(); ++k)
            local.matrix[k] -= pressure * of_gain.matrix[k];
        }
      if (local.linearisation)
        {
          linearisations.resize(space.grid_cells().size());
          linearisations[c] = local.linearisation;
        }
    };
    LocalSystem<dim> system(LocalSystem<dim>::tangent);
    return assembly.matrix(u, system, add);
  }

  template <int dim>
  const Equilibrium::RankOne *
  MomentumBalance<dim>::rank_one() const
  {
    return of_content ? &*of_content : nullptr;
  }

  template <int dim>
  void
  MomentumBalance<dim>::use_growth_at_end()
  {
    goes_on = true;
  }

  template <int dim>
  LinearProblem
  MomentumBalance<dim>::linear_problem(const double        youngs_modulus,
                                       std::vector<Vector> null_space,
                                       const unsigned int  n_cells) const
  {
    // In 2-D a tangent of fewer cells a spline costs less than the residual
    // and the linear system of a further iteration: doc/performance.md. Fewer
    // cells than splines in 3-D leave motions that hardly anything resists:
    // with a kept tangent these drift.
    constexpr double least_cells_a_spline = dim == 2 ? 20. : 2.;
    LinearProblem    result;
    result.symmetric =
      std::all_of(terms.begin(), terms.end(), [](const auto &term) {
        return term->is_conservative();
      });
    result.null_space   = std::move(null_space);
    result.n_components = dim;
    result.typical_entry =
      youngs_modulus * std::pow(space.box().spacing(), dim - 2);
    result.costly = Utilities::MPI::sum(1. * n_cells, comm) >=
                    least_cells_a_spline * space.n_unknowns();
    // With the reference BLAS MUMPS takes 12 s for 11,016 unknowns in 3-D and
    // goes with the square of their number; in 2-D it takes 3 s for 44,656.
    if (dim == 3)
      result.most_to_factorise = 20000;
    return result;
  }

  template <int dim>
  NewtonScales
  MomentumBalance<dim>::scales(const double youngs_modulus) const
  {
    const double h = space.box().spacing();
    return {1e-6 * youngs_modulus * std::pow(h, dim - 1), h};
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace Morula
