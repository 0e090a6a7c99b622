// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/momentum_balance.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <functional>
#include <limits>
#include <sstream>

namespace Morula
{


  template <int dim>
  Equilibrium::Evaluation
  MomentumBalance<dim>::sum_up(const Vector &u,
                               Vector       &R,
                               Vector       *magnitudes) const
  {
    // The terms of all active grid cells of this rank add up here: the energy,
    // doc/theory.md (2.1), and its derivative, the residual, which is condensed
    // to the unknown splines, doc/theory.md (3.5). Energies and inversions of
    // all ranks are summed before anything is done with the residuals. If a
    // point of any rank is inverted there is no residual to exchange: all ranks
    // take the same branch, and leave R alone. Else the owners of the unknowns
    // collect what other ranks have for them.
    const TimerOutput::Scope section(timer, "residual");
    LocalSystem<dim>         system(wanted(magnitudes));
    std::vector<double>      sizes;
    Evaluation               evaluation;
    // Any point has a smaller J_e than this.
    evaluation.smallest_J.value = std::numeric_limits<double>::infinity();
    // This rank's energy, its magnitude, and whether a point is inverted: one
    // reduction sums all three.
    double energies[3] = {0., 0., 0.};
    // The field on a grid cell is given by its plain splines. A false return
    // ends this rank's loop, as no residual is needed any more.
    const auto add = [&](const unsigned int     c,
                         const LocalField<dim> &field,
                         LocalSystem<dim>      &local) {
      for (const auto &term : terms)
        term->add(c, field, GrowthAt::current, local);
      update_extremes(local, space.grid_cells()[c].number, evaluation);
      energies[0] += local.energy;
      energies[1] += local.energy_magnitude;
      return !local.inverted;
    };
    const auto add_pairs = [&](const std::vector<double> &values,
                               std::vector<double>       &residual,
                               std::vector<double>       *of_sizes) {
      if (pairs == nullptr)
        return;
      const TimerOutput::Scope section(timer, "contact");
      PairTerm::Sums           sums{residual, of_sizes};
      pairs->add_residual(values, sums);
      energies[0] += sums.energy;
      energies[1] += sums.energy_magnitude;
    };
    const std::vector<double> sums = assembly.residual(
      u, system, add, magnitudes != nullptr ? &sizes : nullptr, add_pairs);
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
  std::pair<double, double>
  MomentumBalance<dim>::gain(const Enclosure<dim> &enclosure,
                             const Vector         &u,
                             Vector               &derivative,
                             Vector               *magnitudes) const
  {
    const TimerOutput::Scope section(timer, "residual");
    LocalSystem<dim>         system(wanted(magnitudes));
    std::vector<double>      sizes;
    // The volume and its magnitude on this rank; then over all ranks.
    double     volumes[2] = {0., 0.};
    const auto add        = [&](const unsigned int     c,
                         const LocalField<dim> &field,
                         // The terms' own loop is used, though the sums mean a
                         // volume: the local "energy" is what the enclosure
                         // gains, the "residual" its derivative by u,
                         // doc/theory.md (4.8h).
                         LocalSystem<dim> &local) {
      enclosure.gain.add(c, field, GrowthAt::current, local);
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
  void
  MomentumBalance<dim>::add_content(const Enclosure<dim> &enclosure,
                                    const Vector         &u,
                                    Evaluation           &evaluation,
                                    Vector               &R,
                                    Vector               *magnitudes) const
  {
    // With b = dV/du the content adds the energy and the force -p b of
    // doc/theory.md (4.8i). It needs the volume of all ranks before it can say
    // its pressure; so the volume takes a loop over the boundary points of its
    // own.
    Vector b, sizes;
    const auto [gained, magnitude] =
      gain(enclosure, u, b, magnitudes != nullptr ? &sizes : nullptr);
    const double V        = enclosure.volume + gained;
    const double pressure = enclosure.content.pressure(V);
    if (magnitudes != nullptr)
      magnitudes->add(std::abs(pressure), sizes);
    evaluation.energy += enclosure.content.energy(V, enclosure.volume);
    // The content has no volume left: the state counts as inverted, and R is
    // left alone.
    if (!std::isfinite(evaluation.energy))
      return;
    evaluation.energy_magnitude += std::abs(pressure) * magnitude;
    R.add(-pressure, b);
  }

  template <int dim>
  const BlockMatrix &
  MomentumBalance<dim>::tangent(const Vector &u, const GrowthAt growth)
  {
    // The first call of a step makes the sparsity pattern. Lumens come first,
    // since the pressure of each at u, a sum over all ranks, multiplies the
    // second derivative of its volume in each grid cell; its dense part p' b bᵀ
    // of doc/theory.md (4.8i) is kept beside the matrix. Then the terms add
    // their tangents grid cell by grid cell. Where the volumetric strain is a
    // mean over a grid cell, each tangent leaves a linearisation that the next
    // one reads (section 2.4). So the order of calls matters, and a first
    // tangent, which is asked for with the growth of t, forgets the former
    // ones.
    if (!assembly.has_pattern() || has_new_links)
      {
        const TimerOutput::Scope section(timer, "sparsity pattern");
        if (pairs != nullptr)
          assembly.make_pattern(has_energy(), pairs->links());
        else
          assembly.make_pattern(has_energy());
        has_new_links = false;
      }
    // A later turn of the step starts in equilibrium with the new growth.
    const GrowthAt      at = goes_on ? GrowthAt::current : growth;
    std::vector<double> pressures;
    of_contents.clear();
    for (const Enclosure<dim> *const enclosure : enclosures)
      {
        Vector       b;
        const double V = enclosure->volume + gain(*enclosure, u, b).first;
        pressures.push_back(enclosure->content.pressure(V));
        of_contents.push_back({std::move(b), enclosure->content.stiffness(V)});
      }
    const TimerOutput::Scope section(timer, "tangent");
    if (growth == GrowthAt::previous)
      linearisations.clear();
    LocalSystem<dim> of_gain(LocalSystem<dim>::tangent);
    const auto       add = [&](const unsigned int     c,
                         const LocalField<dim> &field,
                         LocalSystem<dim>      &local) {
      local.last = !linearisations.empty() && !linearisations[c].empty() ?
                           &linearisations[c] :
                           nullptr;
      // Single precision is enough where the matrix is far from singular.
      // Hardly anything resists extended splines, and some motions of thin
      // tissue: there rounding to seven digits would let them drift.
      const auto &grid_cell = space.grid_cells()[c];
      local.in_single =
        dim == 3 && grid_cell.weights.empty() && !grid_cell.thin;
      for (const auto &term : terms)
        term->add(c, field, at, local);
      // The sparse part of a lumen's tangent: -p times the second derivative of
      // the gained volume.
      for (std::size_t l = 0; l < pressures.size(); ++l)
        if (pressures[l] != 0.)
          {
            of_gain.clear();
            enclosures[l]->gain.add(c, field, at, of_gain);
            for (std::size_t k = 0; k < local.matrix.size(); ++k)
              local.matrix[k] -= pressures[l] * of_gain.matrix[k];
          }
      // Only terms with a mean volumetric strain leave one; others take no
      // memory for it.
      if (!local.linearisations.empty())
        {
          linearisations.resize(space.grid_cells().size());
          linearisations[c] = local.linearisations;
        }
    };
    LocalSystem<dim> system(LocalSystem<dim>::tangent);
    if (pairs == nullptr)
      return assembly.matrix(u, system, add);
    return assembly.matrix(u,
                           system,
                           add,
                           [&](const std::vector<double> &values,
                               const auto                &add_link) {
                             const TimerOutput::Scope section(timer, "contact");
                             pairs->add_tangent(values, add_link);
                           });
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
    result.symmetric  = has_energy();
    result.null_space = std::move(null_space);
    // E h^(dim-2) is the size of an entry of the tangent, doc/theory.md (2.5):
    // W/h² times E, with W = h^dim.
    result.typical_entry =
      youngs_modulus * std::pow(space.box().spacing(), dim - 2);
    // A sum of doubles does not overflow where cells are many.
    result.costly = Utilities::MPI::sum(1. * n_cells, comm) >=
                    least_cells_a_spline * space.n_unknowns();
    // With the reference BLAS MUMPS takes 12 s for 11,016 unknowns in 3-D and
    // goes with the square of their number; in 2-D it takes 3 s for 44,656.
    if (dim == 3)
      result.most_to_factorise = 20000;
    return result;
  }



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

    /** The point with another number of coordinates: further ones are 0. */
    template <int dim, int former>
    Point<dim>
    with_dimension(const Point<former> &x)
    {
      Point<dim> result;
      for (int d = 0; d < std::min(dim, former); ++d)
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
      return with_dimension<3>(space.box().corner(space.box().index(number)) +
                               space.box().spacing() * Tensor<1, dim>(xi));
    };
    if (system.smallest_J.value < evaluation.smallest_J.value)
      evaluation.smallest_J = {system.smallest_J.value,
                               place(system.smallest_J.place)};
    if (system.largest_gap.value > evaluation.largest_gap.value)
      evaluation.largest_gap = {system.largest_gap.value,
                                place(system.largest_gap.place)};
  }

  template <int dim>
  Extreme<dim>
  MomentumBalance<dim>::largest_gap(const Evaluation &evaluation) const
  {
    const Extreme gap =
      best_of_ranks(evaluation.largest_gap, std::greater<double>(), comm);
    return {gap.value, with_dimension<dim>(gap.place)};
  }

  template <int dim>
  Equilibrium::Extreme
  MomentumBalance<dim>::smallest_J(const Evaluation &evaluation) const
  {
    return best_of_ranks(evaluation.smallest_J, std::less<double>(), comm);
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
    return with_dimension<dim>(
      best_of_ranks({largest, with_dimension<3>(place)},
                    std::greater<double>(),
                    comm)
        .place);
  }

  template <int dim>
  std::string
  MomentumBalance<dim>::describe(const Vector &u) const
  {
    Vector             R(u);
    const Evaluation   evaluation = residual(u, R);
    const Extreme      J          = smallest_J(evaluation);
    const auto         gap        = largest_gap(evaluation);
    const Point<dim>   place      = with_dimension<dim>(J.place);
    std::ostringstream text;
    if (J.value > 0.)
      text << "The smallest J_e is " << J.value << ", at (" << place << ") um";
    else
      text << "The tissue is inverted at (" << place << ") um";
    text << ", the largest unbalanced force acts near (" << place_of_largest(R)
         << ") um";
    if (gap.value >= 0.)
      text << ", and the largest gap of a fixed point is " << gap.value
           << " um, at (" << gap.place << ") um";
    if (const double way = u.linfty_norm(); way > space.box().spacing())
      text << ". The attempt has moved the tissue by up to " << way
           << " um, near (" << place_of_largest(u) << ") um";
    return text.str();
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace Morula
