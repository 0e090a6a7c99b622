// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/surface/lumen_spaces.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <sstream>
#include <utility>

namespace Morula
{
  template <int dim>
  SurfaceSums<dim>
  sums_of(const std::vector<LumenPatch<dim>> &patches, const MPI_Comm comm)
  {
    // All sums take one reduction.
    std::vector<double> mine(2 * dim + 1, 0.);
    for (const LumenPatch<dim> &patch : patches)
      {
        const double a = patch.area.norm();
        mine[2 * dim] += a;
        for (unsigned int d = 0; d < dim; ++d)
          {
            mine[d] += patch.area[d];
            mine[dim + d] += a * patch.x[d];
          }
      }
    std::vector<double> all(2 * dim + 1);
    Utilities::MPI::sum(mine, comm, all);
    SurfaceSums<dim> result;
    result.area = all[2 * dim];
    for (unsigned int d = 0; d < dim; ++d)
      {
        result.area_vector[d] = all[d];
        result.center[d] = result.area > 0. ? all[dim + d] / result.area : 0.;
      }
    return result;
  }


  template <int dim>
  double
  enclosed_volume(const std::vector<LumenPatch<dim>> &patches,
                  const MPI_Comm                      comm)
  {
    // This is doc/theory.md (4.8g): seen from its middle, the volume does not
    // change where the lumen moves as a whole, though patches may leave small
    // gaps.
    const Point<dim> center = sums_of(patches, comm).center;
    double           volume = 0.;
    for (const LumenPatch<dim> &patch : patches)
      volume -= (patch.x - center) * patch.area / dim;
    return Utilities::MPI::sum(volume, comm);
  }


  template <int dim>
  std::vector<LumenPatch<dim>>
  lumen_patches(const unsigned int            space,
                const Tissue<dim>            &tissue,
                const DisplacementField<dim> *displacement)
  {
    // The same function serves the beginning of the step, with u = 0 and f =
    // I, and a displacement. Areas change by Nanson's formula, doc/theory.md
    // (1.2).
    const BoundaryPoints<dim>   &store  = tissue.boundary_points();
    const auto                   column = space_column(tissue);
    std::vector<LumenPatch<dim>> list;
    const auto                   add = [&](const unsigned int    p,
                         const Tensor<1, dim> &u,
                         const Tensor<2, dim> &f) {
      const BoundaryView<dim> point = store[p];
      if (point.get(column) == space)
        // The patch after the step stands at x_t + u with Nanson's area.
        list.push_back({store.position(p) + u,
                        determinant(f) * (point.area_vector() * invert(f))});
    };
    if (displacement == nullptr)
      for (unsigned int p = 0; p < store.size(); ++p)
        add(p, Tensor<1, dim>(), Tensor<2, dim>(unit_symmetric_tensor<dim>()));
    else
      displacement->at_points(store,
                              [&](const unsigned int       p,
                                  const LocalField<dim>   &field,
                                  const SplineValues<dim> &splines) {
                                add(p,
                                    field.value(splines),
                                    field.step_deformation(splines));
                              });
    return list;
  }


  namespace
  {
    /** The relative error of the lumen's volume at which turns end. What is
     * left after a turn also depends on Solver/Newton tolerance. */
    constexpr double volume_tolerance = 1e-8;

    /** The boundary points of this rank around a space, held ones as well, at
     *  the beginning of the step. */
    template <int dim>
    SweptVolume<dim>
    swept_volume(const unsigned int space, const AttemptAtStep<dim> &attempt)
    {
      const BoundaryPoints<dim> &store = attempt.tissue.boundary_points();
      // Held points are around the space as well: they do not move freely, but
      // they enclose it.
      const auto        column = space_column(attempt.tissue);
      const PointGroups groups =
        group_points(store, attempt.space, [&](const unsigned int p) {
          return store[p].get(column) == space;
        });
      std::vector<Tensor<1, dim>> areas;
      for (const unsigned int p : groups.points)
        areas.push_back(store[p].area_vector());
      return SweptVolume<dim>(grouped_places(store, attempt.space, groups),
                              std::move(areas));
    }

    /** See lumen_pressure(). */
    template <int dim>
    class LumenPressure : public PartOfStep<dim>
    {
    public:
      LumenPressure(const AttemptAtStep<dim> &attempt,
                    const LumenContent       &content)
        : content(content)
        , attempt(attempt)
        , space{swept_volume(content.space, attempt),
                content.volume,
                content.content}
        , wanted(content.content.target)
      {}

      Enclosure<dim> *
      enclosure() override
      {
        return &space;
      }

      void
      begin(MomentumBalance<dim> &of_step, const Equilibrium::Vector &) override
      {
        balance = &of_step;
      }

      bool
      renew(const Equilibrium::Vector &u) override
      {
        // Two volumes are at hand: V, which the energy of the step counts, and
        // that of the moved points (4.8g), which has to be the wanted one. Both
        // are sums over all ranks. A gas needs no second turn, as its pressure
        // follows from V at once.
        const TimerOutput::Scope section(attempt.timer, "lumen");
        const double             V = balance->enclosed_volume(space, u);
        pressure                   = space.content.pressure(V);
        if (wanted == 0.)
          return false;
        const DisplacementField<dim> displacement(attempt.space,
                                                  u,
                                                  attempt.comm);
        const double after = enclosed_volume(lumen_patches(content.space,
                                                           attempt.tissue,
                                                           &displacement),
                                             attempt.comm);
        error              = after / wanted - 1.;
        if (std::abs(error) <= volume_tolerance)
          return false;
        // The next turn begins at the pressure of this one. Its target is a
        // volume V, so that the difference between the two volumes is taken off
        // what is wanted: doc/theory.md (4.8j).
        space.content.pressure_at_target = pressure;
        space.content.target             = wanted - (after - V);
        return true;
      }

      std::string
      unfinished() const override
      {
        std::ostringstream text;
        text << "the lumen"
             << (content.name == "lumen" ? "" : " " + content.name)
             << " does not get its volume: it still differs by " << error
             << " times " << wanted << (dim == 3 ? " um^3" : " um^2");
        return text.str();
      }

      bool
      is_exact() const override
      {
        return true;
      }

      std::optional<ForceOnPoints<dim>>
      force() const override
      {
        // The term is the gain of volume as if that were an energy; its forces
        // times minus the pressure are those of doc/theory.md (4.8i).
        return ForceOnPoints<dim>{"lumen",
                                  content.name,
                                  [number = content.space,
                                   column = space_column(attempt.tissue)](
                                    const BoundaryView<dim> &point) {
                                    return point.get(column) == number;
                                  },
                                  &space.gain,
                                  -pressure};
      }

      void
      keep(NamedNumbers &numbers) const override
      {
        numbers[content.of_pressure] = pressure;
        for (const auto &[name, number] : content.at_end)
          numbers[name] = number;
      }

    private:
      const LumenContent          content;
      const AttemptAtStep<dim>   &attempt;
      Enclosure<dim>              space;
      const double                wanted; // volume, µm^dim; 0: any
      const MomentumBalance<dim> *balance  = nullptr;
      double                      pressure = 0.; // at the last equilibrium, kPa
      double                      error    = 0.; // of the volume, relative
    };
  } // namespace


  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  lumen_pressure(const AttemptAtStep<dim> &attempt, const LumenContent &content)
  {
    return std::make_unique<LumenPressure<dim>>(attempt, content);
  }


  MORULA_INSTANTIATE(sums_of);
  MORULA_INSTANTIATE(enclosed_volume);
  MORULA_INSTANTIATE(lumen_patches);
  MORULA_INSTANTIATE(lumen_pressure);
} // namespace Morula
