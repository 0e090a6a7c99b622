// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/effects/surface/carriers.h>
#include <morula/effects/surface/lumen_pressure.h>

#include <cmath>
#include <sstream>
#include <utility>

namespace Morula
{
  namespace
  {
    /** The relative error of the lumen's volume at which turns end. What is
     * left after a turn also depends on Solver/Newton tolerance. */
    constexpr double volume_tolerance = 1e-8;

    /** Compression modulus of the content whose pressure is being found, over
     *  Young's modulus of the tissue: doc/theory.md (4.8j). */
    constexpr double relative_modulus = 100.;

    /** The boundary points of this rank around the lumen, held ones as well, at
     *  the beginning of the step, and its volume then. Collective. */
    template <int dim>
    Enclosure<dim>
    enclosure_of(const Lumen<dim> &lumen, const AttemptAtStep<dim> &attempt)
    {
      const BoundaryPoints<dim> &store = attempt.tissue.boundary_points();
      // Held points are around the lumen as well: they do not move freely, but
      // they enclose it.
      const PointGroups groups =
        group_points(store, attempt.space, [&](const unsigned int p) {
          return lumen.acts_on(store[p].seed_position(),
                               store[p].initial_normal());
        });
      std::vector<Tensor<1, dim>> areas;
      for (const unsigned int p : groups.points)
        areas.push_back(store[p].area_vector());
      return {SweptVolume<dim>(grouped_places(store, attempt.space, groups),
                               std::move(areas)),
              enclosed_volume(lumen_patches(lumen, attempt.tissue),
                              attempt.comm),
              EnclosedContent()};
    }

    /** The lumen's content before the pressure of the step is known.
     *  @param volume at its beginning, µm^dim
     *  @throws InputError */
    template <int dim>
    EnclosedContent
    content_of(const Lumen<dim>         &lumen,
               const AttemptAtStep<dim> &attempt,
               const double              volume)
    {
      // A gas has p = p₀V₀/V, which needs only the product. Where the volume is
      // given the content is that of a compressible fluid, doc/theory.md
      // (4.8j), which begins with the pressure of the step before: a good guess
      // saves turns.
      const double    at_start = attempt.kept.at("lumen_at_start");
      EnclosedContent content;
      if (!lumen.keeps_volume())
        {
          content.gas = lumen.pressure(attempt.t_next) * at_start;
          return content;
        }
      content.target             = lumen.volume(attempt.t_next, at_start);
      content.pressure_at_target = attempt.kept.at("lumen_pressure");
      content.stiffness_at_target =
        relative_modulus * attempt.typical_stiffness / volume;
      return content;
    }
  } // namespace


  template <int dim>
  std::vector<LumenPatch<dim>>
  lumen_patches(const Lumen<dim>             &lumen,
                const Tissue<dim>            &tissue,
                const DisplacementField<dim> *displacement)
  {
    // The same function serves the beginning of the step, with u = 0 and f = I,
    // and a displacement. Areas change by Nanson's formula, doc/theory.md
    // (1.2).
    const BoundaryPoints<dim>   &store = tissue.boundary_points();
    std::vector<LumenPatch<dim>> list;
    const auto                   add = [&](const unsigned int    p,
                         const Tensor<1, dim> &u,
                         const Tensor<2, dim> &f) {
      const BoundaryView<dim> point = store[p];
      if (lumen.acts_on(point.seed_position(), point.initial_normal()))
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


  template <int dim>
  LumenPressure<dim>::LumenPressure(const Lumen<dim>         &lumen,
                                    const AttemptAtStep<dim> &attempt)
    : lumen(lumen)
    , attempt(attempt)
    , space(enclosure_of(lumen, attempt))
  {
    // All ranks have found the volume together. The content may need
    // expressions, which can fail on one rank.
    everywhere(attempt.comm, [&]() {
      space.content = content_of(lumen, attempt, space.volume);
    });
    wanted = space.content.target;
  }


  template <int dim>
  void
  LumenPressure<dim>::begin(MomentumBalance<dim> &of_step,
                            const Equilibrium::Vector &)
  {
    balance = &of_step;
  }


  template <int dim>
  bool
  LumenPressure<dim>::renew(const Equilibrium::Vector &u)
  {
    // Two volumes are at hand: V, which the energy of the step counts, and that
    // of the moved points (4.8g), which has to be the wanted one. Both are sums
    // over all ranks. A gas needs no second turn, as its pressure follows from
    // V at once.
    const TimerOutput::Scope section(attempt.timer, "lumen");
    const double             V = balance->enclosed_volume(u);
    pressure                   = space.content.pressure(V);
    if (!lumen.keeps_volume())
      return false;
    const DisplacementField<dim> displacement(attempt.space, u, attempt.comm);
    const double                 after =
      enclosed_volume(lumen_patches(lumen, attempt.tissue, &displacement),
                      attempt.comm);
    error = after / wanted - 1.;
    if (std::abs(error) <= volume_tolerance)
      return false;
    // The next turn begins at the pressure of this one. Its target is a volume
    // V, so that the difference between the two volumes is taken off what is
    // wanted: doc/theory.md (4.8j).
    space.content.pressure_at_target = pressure;
    space.content.target             = wanted - (after - V);
    return true;
  }


  template <int dim>
  std::string
  LumenPressure<dim>::unfinished() const
  {
    std::ostringstream text;
    text << "the lumen does not get its volume: it still differs by " << error
         << " times " << wanted << (dim == 3 ? " um^3" : " um^2");
    return text.str();
  }


  template <int dim>
  std::optional<ForceOnPoints<dim>>
  LumenPressure<dim>::force() const
  {
    // The term is the gain of volume as if that were an energy; its forces
    // times minus the pressure are those of doc/theory.md (4.8i).
    return ForceOnPoints<dim>{"lumen",
                              "lumen",
                              [this](const BoundaryView<dim> &point) {
                                return lumen.acts_on(point.seed_position(),
                                                     point.initial_normal());
                              },
                              &space.gain,
                              -pressure};
  }


  template <int dim>
  void
  LumenPressure<dim>::keep(NamedNumbers &numbers) const
  {
    numbers["lumen_pressure"] = pressure;
  }


  MORULA_INSTANTIATE(lumen_patches);
  template class LumenPressure<2>;
  template class LumenPressure<3>;
} // namespace Morula
