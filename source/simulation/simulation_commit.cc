// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/divide.h>
#include <morula/effects/fate/removal.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/simulation/redistribution.h>
#include <morula/simulation/simulation.h>
#include <morula/simulation/step_checks.h>

#include <deal.II/base/mpi.templates.h>

#include <limits>
#include <set>
#include <sstream>

// How the tissue changes at the end of a step.

namespace Morula
{
  namespace
  {
    /** The largest displacement (µm) and step deformation |f| of points. */
    struct Motion
    {
      double u = std::numeric_limits<double>::infinity();
      double f = std::numeric_limits<double>::infinity();
    };

    /** New positions of points in order, and how they moved. */
    template <int dim>
    struct Moved
    {
      std::vector<Point<dim>>       positions; // µm
      std::vector<PointMotion<dim>> motions;
      Motion                        largest; // over all ranks
    };

    /**
     * Moves the points of a store with the displacement, none farther than the
     * limit: equations (6), (9) of the paper for cells and boundary points, and
     * f for equations (7), (10). Collective.
     */
    template <int dim>
    Moved<dim>
    moved(const PointStore<dim>        &store,
          const DisplacementField<dim> &displacement,
          const FindMotions             find_motions,
          const Motion                 &limit,
          const MPI_Comm                comm)
    {
      // The positions are clipped to the limit here, while F is not: the caller
      // decides with the motions whether a point deforms. The largest motions
      // are those of all ranks, as they are the limit for other points. Nothing
      // is written yet.
      Moved<dim> result;
      result.motions = point_motions(store, displacement, find_motions);
      result.positions.reserve(store.size());
      Motion largest{0., 0.};
      for (unsigned int p = 0; p < store.size(); ++p)
        {
          const auto &[u, f] = result.motions[p];
          const double size  = u.norm();
          result.positions.push_back(store.position(p) +
                                     (size > limit.u ? limit.u / size * u : u));
          largest.u = std::max(largest.u, size);
          largest.f = std::max(largest.f, f.norm());
        }
      result.largest = {Utilities::MPI::max(largest.u, comm),
                        Utilities::MPI::max(largest.f, comm)};
      return result;
    }

    using Rows = std::vector<double>;

    /** The rows of all cells of this rank, one after the other. */
    template <int dim>
    Rows
    rows_of(const Tissue<dim> &tissue)
    {
      Rows rows;
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        rows.insert(rows.end(),
                    tissue.cells()[p].row().begin(),
                    tissue.cells()[p].row().end());
      return rows;
    }

    template <int dim>
    void
    set_rows(Tissue<dim> &tissue, const Rows &rows)
    {
      auto next = rows.begin();
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        {
          const auto row = tissue.cell(p).row();
          std::copy(next, next + row.size(), row.begin());
          next += row.size();
        }
    }


    /**
     * The strain of a step that displaces a cell against its neighbours:
     * doc/theory.md (6.11). F_g must be that of the end of the step.
     * @param p       the cell's place in @p of_step
     * @param f       of the step
     * @param flows   whether its shear is a flow, whatever its own one
     */
    template <int dim>
    double
    displacing_strain(const CellView<dim, const double> &cell,
                      const unsigned int                 p,
                      const Tensor<2, dim>              &f,
                      const DevelopmentOfStep<dim>      &of_step,
                      const bool                         flows)
    {
      double strain = 0.;
      if (of_step.present)
        strain = std::abs(std::log(determinant(cell.growth()) /
                                   determinant(of_step.previous[p])));
      if (flows ||
          (!of_step.relaxation.empty() && of_step.relaxation[p].kept < 1.))
        strain += deviator(symmetrize(f)).norm();
      return strain;
    }

    /** Whether some cells were killed by a condition in this step and are gone
     *  already. Local to the rank. */
    bool
    cuts(const std::vector<CellEvent> &events)
    {
      std::set<types::particle_index> killed;
      for (const CellEvent &event : events)
        if (event.at_once)
          killed.insert(event.id);
      return std::any_of(events.begin(), events.end(), [&](const auto &event) {
        return event.kind == CellEvent::removal && killed.count(event.id) > 0;
      });
    }
  } // namespace

  template <int dim>
  void
  Simulation<dim>::settle_equations(const SplineSpace<dim> &space)
  {
    if (std::any_of(model.equations.begin(),
                    model.equations.end(),
                    [](const auto &named) {
                      return named.effect->is_steady();
                    }))
      begun.rows = rows_of(tissue);
    solve_equations([&](EquationInRun<dim> &equation) {
      equation.settle(tissue, space, time_steps.time());
    });
  }

  template <int dim>
  void
  Simulation<dim>::stop_if_asked()
  {
    // received() is collective and gives all ranks the same number, so that
    // they write the snapshot together. Up to move() the tissue is that at t,
    // and a resumed run repeats the step from there.
    const int signal = signals->received();
    if (signal == 0)
      return;
    if (!begun.rows.empty())
      set_rows(tissue, begun.rows);
    files->write_snapshot(
      snapshot_of(tissue, begun.time_steps, begun.run_state), timer);
    files->write_timings(timer);
    throw StoppedBySignal(signal, time_steps.time());
  }

  template <int dim>
  void
  Simulation<dim>::commit(
    const SplineSpace<dim>                        &space,
    const SplineSpace<dim>                        &space_of_equations,
    const typename StepEquilibrium<dim>::Solution &solution,
    const bool                                     takes_time)
  {
    // The first part only computes: the motions of cells and boundary points
    // and the check that they still fit on a grid, so that a run that gives up
    // saves the state at t. Then growth is committed, after it F (which needs
    // the new F_g where volumes are means over grid cells), then
    // equations, whose densities are diluted by the new volumes. tissue.move()
    // comes last: it sends points to the ranks that own their new grid cells
    // and sorts them, so that p means another point behind it.
    const TimerOutput::Scope     section(timer, "commit");
    const DisplacementField<dim> displacement(space, solution.u, comm);
    const FindMotions            find_motions =
      motion_kernel<dim>(model.material.material(), model.scene.solver.kernel);
    const Moved<dim> cells =
      moved(tissue.cells(), displacement, find_motions, Motion(), comm);
    const std::vector<VolumeOfStep> volumes =
      volumes_of_step(tissue,
                      space,
                      growth_of_step,
                      model.material,
                      model.scene.solver.kernel,
                      displacement);
    // The displacement is extrapolated where the surface stands off from the
    // cells. That is no reason for it to move farther, or to deform more, than
    // the cells do: doc/theory.md, section 4.6. See also
    // pull_back_detached_points().
    const Motion     limit{2. * cells.largest.u + space.box().spacing(),
                       2. * cells.largest.f};
    const Moved<dim> surface =
      moved(tissue.boundary_points(), displacement, find_motions, limit, comm);
    const std::string reason = torn_tissue_message(cells.positions,
                                                   surface.positions,
                                                   tissue.grid().box(),
                                                   comm);
    if (!reason.empty())
      {
        // The cell that moves farthest is most likely what has torn off.
        std::vector<double> farthest(1 + dim, 0.);
        for (unsigned int p = 0; p < tissue.cells().size(); ++p)
          {
            std::vector<double> row{cells.motions[p].u.norm()};
            append_flat(row, tissue.cells().position(p));
            farthest = std::max(farthest, row);
          }
        const auto all = Utilities::MPI::all_gather(comm, farthest);
        farthest       = *std::max_element(all.begin(), all.end());
        std::ostringstream text;
        text << reason << ". Cells move by up to " << farthest[0] << " um."
             << watches.around(tissue,
                               Flat<Point<dim>>::read(&farthest[1]),
                               time_steps.time());
        give_up(text.str());
      }

    const double t = time_steps.time(), t_next = time_steps.next();
    const bool   may_fail = std::any_of(model.equations.begin(),
                                      model.equations.end(),
                                      [](const auto &named) {
                                        return named.effect->is_transient();
                                      });
    // Equations are solved with the new volumes on the splines of the step, so
    // they can fail when the cells have changed already. The rows of the cells
    // are kept to go back.
    const Rows before = may_fail ? rows_of(tissue) : Rows();
    if (takes_time)
      model.development.commit(tissue, growth_of_step, t, t_next);
    const std::vector<double> missed_flow =
      deform_cells(cells.motions, volumes);
    // The concentrations are diluted before the equation is solved: a value
    // that is held at the surface would otherwise be too low by what grows in a
    // step (doc/theory.md, section 11.4).
    if (takes_time)
      solve_equations([&](EquationInRun<dim> &equation) {
        try
          {
            equation.advance(tissue, space_of_equations, t, t_next);
          }
        catch (...)
          {
            // give_up() saves the cells, which have to be those at t.
            set_rows(tissue, before);
            throw;
          }
      });
    run_state.error.flow = mean_missed(missed_flow);
    // A boundary point keeps its F where the extrapolated f is too large or
    // turns it inside out; its position has moved all the same.
    for (unsigned int p = 0; p < surface.positions.size(); ++p)
      if (surface.motions[p].f.norm() <= limit.f &&
          determinant(surface.motions[p].f) > 0.)
        tissue.boundary_point(p).deform(surface.motions[p].f);
    forces = set_forces(solution.forces, tissue);
    for (const auto &[name, number] : solution.kept)
      run_state.kept[name] = number;
    events         = std::move(growth_of_step.events);
    growth_of_step = {};
    run_state.surface_way += surface.largest.u;
    tissue.move(cells.positions, surface.positions);
  }


  template <int dim>
  std::vector<double>
  Simulation<dim>::deform_cells(const std::vector<PointMotion<dim>> &motions,
                                const std::vector<VolumeOfStep>     &volumes)
  {
    const double        t = time_steps.time(), t_next = time_steps.next();
    const bool          dilutes = !model.densities.empty();
    std::vector<double> missed_flow(motions.size(), 0.);
    for (unsigned int p = 0; p < motions.size(); ++p)
      {
        const CellView<dim, double> cell   = tissue.cell(p);
        const double                volume = dilutes ? cell.volume() : 0.;
        // F is carried on by doc/theory.md (1.1).
        Tensor<2, dim> F      = motions[p].f * cell.F();
        double         factor = 1.;
        // The energy knows the volume of a pool, not that of each of its cells.
        // Where volumes are pooled, det F_e of the cell becomes what its pool
        // has, and the shape is that of f F. What it carries on fades where its
        // stress does: doc/theory.md (2.9).
        if (!volumes.empty())
          {
            const double V =
              volumes[p].J_e * determinant(cell.growth()); // over V⁰
            const double kept = growth_of_step.relaxation.empty() ?
                                  1. :
                                  growth_of_step.relaxation[p].kept;
            const double c    = volumes[p].carried / cell.initial_volume();
            factor            = std::pow(V / determinant(F), 1. / dim);
            cell.set(cell.columns().carried, (V + kept * (c - V)) / V);
            cell.set(cell.columns().smoothing, volumes[p].smoothing);
          }
        F *= factor;
        cell.set(cell.columns().deformation, F);
        const Tensor<2, dim> f = factor * motions[p].f;
        // The forecast of this step's motion is compared with the motion before
        // remember_motion() overwrites what it was made from.
        missed_flow[p] =
          model.development.missed_flow(cell, p, f, growth_of_step, t, t_next);
        model.development.remember_motion(cell, f);
        if (model.redistribution.places)
          cell.set(cell.columns().step_strain,
                   displacing_strain<dim>(cell,
                                          p,
                                          motions[p].f,
                                          growth_of_step,
                                          model.redistribution.all_flows));
        if (dilutes)
          model.dilute(cell, cell.volume() / volume);
      }
    return missed_flow;
  }

  template <int dim>
  void
  Simulation<dim>::rearrange(const SplineSpace<dim> &space)
  {
    // Divisions come before deaths, so that daughters can die, and the surface
    // follows last, as both change what it has to enclose.
    divide();
    model.development.refer_anew(tissue);
    // A new surface may need the points that leave with dead cells, to know
    // which conditions its patches had.
    const PointList<dim> former = surface.before_losses(tissue);
    remove_the_dead();
    for_moments(&Moments<dim>::rearrange, time_steps.time(), row.dt);
    keep_places();
    count(space);
    if (surface.follow(tissue, space, former, time_steps.time(), row.dt))
      watches.look_at_conditions(tissue, time_steps.time());
    renew_carriers(tissue);
    for_moments(&Moments<dim>::surfaced, time_steps.time(), row.dt);
    for_moments(&Moments<dim>::after, time_steps.time(), row.dt);
  }


  template <int dim>
  void
  Simulation<dim>::keep_places()
  {
    if (!model.redistribution.places)
      return;
    const TimerOutput::Scope section(timer, "places");
    redistribute(tissue, model, time_steps.time(), surface.exists(), of_step);
  }


  template <int dim>
  void
  Simulation<dim>::divide()
  {
    row.dividing = 0;
    if (!model.development.divides())
      return;
    const TimerOutput::Scope section(timer, "division");
    // Each rank lists its own cells that are due. divide() communicates, as
    // daughters are placed between cells of other ranks and get ids in an order
    // of all ranks' events; so it is called on all ranks if any has a cell that
    // is due. A daughter that divides by size may be due again in the same
    // step: rounds go on until no cell is.
    const double t = time_steps.time();
    while (true)
      {
        const std::vector<unsigned int> due =
          cells_due(tissue, model.development, t);
        const auto n = Utilities::MPI::sum<std::uint64_t>(due.size(), comm);
        if (n == 0)
          return;
        row.dividing += n;
        const auto born = Morula::divide(
          tissue, model.development, due, t, run_state.next_id, events);
        births.insert(births.end(), born.begin(), born.end());
      }
  }

  template <int dim>
  void
  Simulation<dim>::remove_the_dead()
  {
    if (!model.development.is_mortal())
      return;
    // Boundary points of lost tissue go with it. A cut also changes what the
    // next step has to balance, so that its length is chosen anew.
    const TimerOutput::Scope section(timer, "removal");
    watches.look_at_losses(tissue, time_steps.time(), row.dt);
    const std::vector<CellEvent> removals = remove_dead_cells(tissue,
                                                              model.development,
                                                              time_steps.time(),
                                                              model.densities);
    events.insert(events.end(), removals.begin(), removals.end());
    // A surface that is made from the cells does not enclose lost ones.
    if (Utilities::MPI::logical_or(!removals.empty(), comm))
      run_state.surface_way = std::numeric_limits<double>::infinity();
    // The events are those of this rank's cells. The length of a step is the
    // same on all ranks.
    if (Utilities::MPI::logical_or(cuts(events), comm))
      time_steps.begin_anew();
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
