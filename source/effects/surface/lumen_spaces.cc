// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/effects/surface/lumen_spaces.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace Morula
{
  namespace
  {
    /** How many boundary points of all ranks face a cavity and have belonged to
     *  a space, by both numbers. */
    using Votes = std::map<std::pair<unsigned int, unsigned int>, unsigned int>;

    /** Collective. */
    template <int dim>
    Votes
    votes_of(const Tissue<dim> &tissue)
    {
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      const auto                 space  = space_column(tissue);
      const auto                 cavity = points.columns().cavity;
      Votes                      own, all;
      for (unsigned int p = 0; p < points.size(); ++p)
        ++own[{points[p].get(cavity), points[p].get(space)}];
      std::vector<std::array<unsigned int, 3>> list;
      for (const auto &[numbers, n] : own)
        list.push_back({{numbers.first, numbers.second, n}});
      for (const auto &of_rank :
           Utilities::MPI::all_gather(tissue.communicator(), list))
        for (const auto &[faced, number, n] : of_rank)
          all[{faced, number}] += n;
      return all;
    }

    /** Lengths of a cell: the least thickness of tissue between two spaces, and
     *  how far its middle may be from all cells. */
    constexpr double thinnest = 0.6, emptiest = 0.9;

    using Pairs = std::set<std::pair<unsigned int, unsigned int>>;

    /** Pairs of spaces between which the tissue has a gap that the surface does
     *  not show yet. Collective. */
    template <int dim>
    Pairs
    open_to_each_other(const Tissue<dim> &tissue)
    {
      // A step in which such a gap opens must know that the content is one:
      // volumes of two have no meaning while the points between them part. The
      // surface is smoothed over max(l, h/2), l the length of the mean cell. So
      // points of two spaces that are nearer than that have no cell between
      // them if the middle is far from all cells: farther than in a row of
      // cells that touch. A row that thin has torn, too.
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      const auto                 space  = space_column(tissue);
      const auto                 cavity = points.columns().cavity;
      const double   l    = std::pow(mean_cell_volume(tissue), 1. / dim);
      const double   near = std::max(l, 0.5 * tissue.grid().box().spacing());
      PointList<dim> walls(1), cells(1);
      for (unsigned int p = 0; p < points.size(); ++p)
        if (points[p].get(cavity) > 1 && points[p].get(space) > 0)
          walls.add_value(points.id(p),
                          points.position(p),
                          double(points[p].get(space)));
      const std::size_t n_own = walls.size();
      walls.append(halo(walls, tissue.grid(), near));
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        cells.add_value(tissue.cells().id(p), tissue.cells().position(p), 0.);
      cells.append(halo(cells, tissue.grid(), 0.5 * near + l));
      const NearTree<dim> wall_tree(walls.positions),
        cell_tree(cells.positions);
      std::vector<std::array<unsigned int, 2>> own;
      for (std::size_t i = 0; i < n_own; ++i)
        for (const unsigned int j : wall_tree.within(walls.positions[i], near))
          if (const Tensor<1, dim> way =
                walls.positions[j] - walls.positions[i];
              walls.row(i)[0] < walls.row(j)[0] &&
              (way.norm() < thinnest * l ||
               cell_tree.within(walls.positions[i] + 0.5 * way, emptiest * l)
                 .empty()))
            own.push_back({{static_cast<unsigned int>(walls.row(i)[0]),
                            static_cast<unsigned int>(walls.row(j)[0])}});
      Pairs all;
      for (const auto &of_rank :
           Utilities::MPI::all_gather(tissue.communicator(), own))
        for (const auto &[a, b] : of_rank)
          all.insert({a, b});
      return all;
    }
  } // namespace


  std::string
  number_of_space(const unsigned int space, const std::string &what)
  {
    return number_of_spaces + std::to_string(space) + "/" + what;
  }


  std::vector<LumenSpace>
  kept_spaces(const NamedNumbers &kept, const unsigned int n_lumens)
  {
    std::vector<LumenSpace> spaces(kept.at(number_of_spaces));
    for (unsigned int s = 0; s < spaces.size(); ++s)
      {
        const auto number = [&](const std::string &what) {
          return kept.at(number_of_space(s, what));
        };
        for (unsigned int l = 0; l < n_lumens; ++l)
          spaces[s].held.push_back(number(std::to_string(l)));
        spaces[s].pressure = number("pressure");
        spaces[s].together = number("together") != 0.;
      }
    return spaces;
  }


  void
  keep_spaces(const std::vector<LumenSpace> &spaces, NamedNumbers &kept)
  {
    kept[number_of_spaces] = spaces.size();
    for (unsigned int s = 0; s < spaces.size(); ++s)
      {
        for (unsigned int l = 0; l < spaces[s].held.size(); ++l)
          kept[number_of_space(s, std::to_string(l))] = spaces[s].held[l];
        kept[number_of_space(s, "pressure")] = spaces[s].pressure;
        kept[number_of_space(s, "together")] = spaces[s].together;
      }
  }


  template <int dim>
  SpacesOfSurface
  find_spaces(const std::vector<bool> &together, Tissue<dim> &tissue)
  {
    // Each space has a main cavity, that of most of its points. The owner of a
    // cavity is, of the spaces whose main one it is, that with the most points
    // there: the others have merged with it. A cavity that is nobody's main one
    // has split off from the space of most of its points. Outside of all
    // cavities the numbers end, but for points of other bodies than that which
    // has the cavity: these stand in it.
    constexpr unsigned int    unknown = 0, outside = 1;
    const unsigned int        n     = together.size();
    const Votes               votes = votes_of(tissue);
    std::vector<unsigned int> main(n + 1, outside), most(n + 1, 0);
    for (const auto &[numbers, count] : votes)
      if (const auto [faced, space] = numbers; count > most[space])
        {
          main[space] = faced;
          most[space] = count;
        }
    // Of each cavity: whether it is main to the space, its points, the space.
    std::map<unsigned int, std::array<unsigned int, 3>> owners;
    for (const auto &[numbers, count] : votes)
      if (const auto [faced, space] = numbers; faced > outside)
        owners[faced] =
          std::max(owners[faced],
                   {{space > 0 && main[space] == faced, count, space}});

    SpacesOfSurface result;
    result.n_cavities.assign(n, 0);
    for (auto &[faced, owner] : owners)
      {
        auto &[is_main, count, space] = owner;
        if (space > 0 && !is_main && main[space] == outside)
          space = 0;
        if (space == 0)
          continue;
        ++result.n_cavities[space - 1];
        if (is_main || main[space] == unknown || together[space - 1])
          continue;
        result.split_from.push_back(space);
        space = n + result.split_from.size();
      }
    for (unsigned int space = 1; space <= n; ++space)
      {
        result.has_opened.push_back(most[space] > 0 && main[space] == outside);
        result.into.push_back(main[space] == unknown ? space :
                              main[space] == outside ? 0 :
                                                       owners[main[space]][2]);
      }

    const BoundaryColumns<dim> &columns = tissue.boundary_points().columns();
    const auto column = space_column(tissue), cavity = columns.cavity;
    for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
      {
        const auto         point = tissue.boundary_point(p);
        const unsigned int faced = point.get(cavity), space = point.get(column);
        const unsigned int body =
          columns.body.exists() ? point.get(columns.body) : 0;
        if (faced > outside)
          point.set(column, owners[faced][2]);
        else if (faced == outside && space > 0 &&
                 (main[space] <= outside || main[space] >> 16 == body))
          point.set(column, 0);
        else if (faced == outside && space > 0)
          point.set(column, owners[main[space]][2]);
      }
    return result;
  }


  template <int dim>
  void
  join_spaces(SpacesOfSurface &found, Tissue<dim> &tissue)
  {
    const unsigned int n = found.into.size();
    if (n < 2)
      return;

    // Spaces that have a gap between them are one from now on, also while the
    // surface shows two cavities.
    const auto column = space_column(tissue);
    for (auto [a, b] : open_to_each_other(tissue))
      {
        for (unsigned int *const space : {&a, &b})
          while (*space <= n && found.into[*space - 1] != *space)
            *space = found.into[*space - 1];
        if (a == b || std::max(a, b) > n)
          continue;
        found.into[b - 1] = a;
        found.joined.push_back(a);
        for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
          if (const auto point = tissue.boundary_point(p);
              point.get(column) == b)
            point.set(column, a);
      }
    for (unsigned int &space : found.into)
      while (space > 0 && found.into[space - 1] != space)
        space = found.into[space - 1];
  }


  MORULA_INSTANTIATE(find_spaces);
  MORULA_INSTANTIATE(join_spaces);


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
