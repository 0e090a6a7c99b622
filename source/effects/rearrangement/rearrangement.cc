// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/send_records.h>
#include <morula/effects/effect.h>
#include <morula/effects/rearrangement/places_of_tissue.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/particles/even_spread.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Morula
{
  template <int dim>
  Tensor<2, dim>
  with_less_shear(const Tensor<2, dim> &F_e, const double part)
  {
    // F_e = V R with V² = F_e F_eᵀ. The principal stretches λ become
    // J^(1/d) (λ/J^(1/d))^part along the same directions.
    const auto     b     = symmetrize(F_e * transpose(F_e));
    const auto     pairs = eigenvectors(b);
    const double   mean  = std::pow(determinant(F_e), 1. / dim);
    Tensor<2, dim> change;
    for (const auto &[square, direction] : pairs)
      change += std::pow(std::sqrt(square) / mean, part - 1.) *
                outer_product(direction, direction);
    return change * F_e;
  }


  template <int dim>
  Tensor<2, dim>
  deformation_at(const Tensor<2, dim> &F_e,
                 const double          V,
                 const Tensor<2, dim> &F_g,
                 const double          V0)
  {
    const Tensor<2, dim> F = F_e * F_g;
    return std::pow(V / (V0 * determinant(F)), 1. / dim) * F;
  }


  template <int dim>
  Rearrangement<dim>::Rearrangement(const Parameters         &parameters,
                                    const EffectSetting<dim> &setting)
    : diffusion(setting.state.use(parameters.diffusion))
    , drive(setting.state.use(parameters.drive))
    , energy(setting.tensions, parameters.energy)
    , shear_released(parameters.shear_released)
    , random_seed(setting.random_seed)
    , death_time(setting.columns.template find<double>("death_time"))
    , neighbours(setting.neighbours)
  {}


  template <int dim>
  void
  Rearrangement<dim>::declare(Tables<dim> &tables) const
  {
    tables.add_number("exchanges");
    tables.add_number("adhesion_energy");
    tables.add_number("unlike_share");
  }


  template <int dim>
  void
  Rearrangement<dim>::check_cell(const PresentCell<dim> &founder,
                                 const double) const
  {
    founder.value(diffusion, 0.);
    founder.vector(drive, 0.);
  }


  template <int dim>
  void
  Rearrangement<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    review_rate(diffusion, "no cell changes its place by it.", scene, review);
  }



  template <int dim>
  std::vector<Occupant>
  Rearrangement<dim>::cells_of(const Tissue<dim>     &tissue,
                               const CellReader<dim> &reader) const
  {
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(tissue.communicator());
    std::vector<Occupant> list;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const PresentCell<dim> cell = present_cell(tissue, p, reader);
        // The dead keep their place.
        const bool is_dead =
          death_time.exists() && cell.cell().get(death_time) >= 0.;
        const Tensor<1, dim> f = cell.vector(drive, reader.time);
        Occupant             one{cell.lineage_key(),
                     cell.type(),
                     is_dead ? 0. : cell.value(diffusion, reader.time),
                                 {{f[0], f[1], dim == 3 ? f[dim - 1] : 0.}},
                     rank,
                     p};
        list.push_back(one);
      }
    return list;
  }


  template <int dim>
  void
  Rearrangement<dim>::tell(const MomentOfRun<dim>      &moment,
                           const Places                &places,
                           const std::vector<Occupant> &occupants,
                           const double                 n_exchanges,
                           const MPI_Comm               comm) const
  {
    // Each contact is seen from both of its cells, and counts half each time.
    double sum = 0., touching = 0., unlike = 0.;
    for (unsigned int p = 0; p < places.size(); ++p)
      if (places.own[p])
        {
          const unsigned int type = occupants[p].type;
          for (unsigned int e = places.offsets[p]; e < places.offsets[p + 1];
               ++e)
            {
              const unsigned int other = occupants[places.edges[e].other].type;
              sum += 0.5 * places.edges[e].area * energy.between(type, other);
              touching += places.edges[e].area;
              unlike += other == type ? 0. : places.edges[e].area;
            }
          sum += places.free[p] * energy.with_surface(type);
        }
    touching                          = Utilities::MPI::sum(touching, comm);
    moment.of_step["exchanges"]       = Utilities::MPI::sum(n_exchanges, comm);
    moment.of_step["adhesion_energy"] = Utilities::MPI::sum(sum, comm);
    moment.of_step["unlike_share"] =
      Utilities::MPI::sum(unlike, comm) / (touching > 0. ? touching : 1.);
  }


  template <int dim>
  void
  Rearrangement<dim>::settle(Tissue<dim>            &tissue,
                             const MomentOfRun<dim> &moment) const
  {
    std::vector<Occupant> cells;
    everywhere(tissue.communicator(),
               [&]() { cells = cells_of(tissue, moment.reader); });
    const PlacesOfTissue around = places_of(tissue, cells, neighbours);
    tell(moment, around.places, around.occupants, 0., tissue.communicator());
  }


  template <int dim>
  void
  Rearrangement<dim>::rearrange(Tissue<dim>            &tissue,
                                const MomentOfRun<dim> &moment) const
  {
    // The events run on copies of the cells, while the places stay as they are.
    // At the end the owner of each place tells the rank of the cell that has
    // come there what the place keeps: position, volume, F_e, and the fields,
    // whose amounts stay so; of others the cell brings its amount. A cell comes
    // from farther away than the places around a rank reach, if it has had many
    // exchanges; so it carries its rank and number with it. The cells of this
    // rank are moved at last, in one go.
    const MPI_Comm           comm    = tissue.communicator();
    const StateColumns<dim> &columns = moment.reader.columns;
    const CellColumns<dim>  &of_cell = tissue.cells().columns();
    std::vector<Occupant>    cells;
    everywhere(comm, [&]() { cells = cells_of(tissue, moment.reader); });
    const PlacesOfTissue around = places_of(tissue, cells, neighbours);
    ExchangeRounds       rounds(around.places,
                          around.occupants,
                          attempts(around.places,
                                   around.occupants,
                                   random_seed,
                                   moment.t,
                                   moment.dt),
                          energy);
    run(rounds, around, comm);

    std::map<unsigned int, std::vector<double>> sent;
    double                                      n_exchanges = 0.;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const unsigned int n = rounds.n_exchanges()[p];
        n_exchanges += 0.5 * n;
        if (n == 0)
          continue;
        const auto      place = tissue.cells()[p];
        const Occupant &comes = rounds.occupants()[p];
        Tensor<2, dim>  F_e   = place.elastic_deformation();
        if (shear_released > 0.)
          F_e = with_less_shear(F_e, std::pow(1. - shear_released, n));
        std::vector<double> &list = sent[comes.rank];
        append_flat(list, comes.number);
        append_flat(list, tissue.cells().position(p));
        append_flat(list, place.volume());
        append_flat(list, F_e);
        for (const Column<double> &field : columns.fields)
          append_flat(list, place.get(field));
      }
    std::vector<Point<dim>> positions = tissue.cells().positions();
    const std::size_t width = 1 + dim + 1 + dim * dim + columns.fields.size();
    for (const auto &[rank, list] : send_records(sent, comm))
      for (std::size_t i = 0; i < list.size(); i += width)
        {
          const double      *next  = &list[i];
          const unsigned int p     = static_cast<unsigned int>(next[0]);
          positions[p]             = Flat<Point<dim>>::read(next + 1);
          const double         V   = next[1 + dim];
          const Tensor<2, dim> F_e = Flat<Tensor<2, dim>>::read(next + 2 + dim);
          const CellView<dim, double> cell   = tissue.cell(p);
          const double                before = cell.volume();
          cell.set(
            of_cell.deformation,
            deformation_at(F_e, V, cell.growth(), cell.initial_volume()));
          for (std::size_t k = 0; k < columns.fields.size(); ++k)
            cell.set(columns.fields[k],
                     columns.carried[k] ?
                       cell.get(columns.fields[k]) * before / V :
                       next[2 + dim + dim * dim + k]);
        }
    tissue.move(positions, tissue.boundary_points().positions());
    tell(moment, around.places, rounds.occupants(), n_exchanges, comm);
    spread(tissue, moment);
  }


  template <int dim>
  void
  Rearrangement<dim>::spread(Tissue<dim>            &tissue,
                             const MomentOfRun<dim> &moment) const
  {
    // Flow draws places apart one way and together another; cells that find new
    // places do not hold them there. Places that keep their shear are those of
    // a solid, and stay. At a surface the images stand for the tissue beyond:
    // without one cells would be driven out.
    if (shear_released == 0. ||
        Utilities::MPI::sum(tissue.boundary_points().size(),
                            tissue.communicator()) == 0)
      return;
    const double        area = std::pow(mean_cell_volume(tissue), 2. / dim);
    std::vector<double> parts;
    for (const Occupant &cell : cells_of(tissue, moment.reader))
      parts.push_back(std::min(1.,
                               shear_released * 2. * dim * cell.diffusion *
                                 spreading_time / area));
    spread_cells(tissue, moment.dt, parts);
  }


#define INSTANTIATE(dim)                                         \
  template class Rearrangement<dim>;                             \
  template Tensor<2, dim> deformation_at(const Tensor<2, dim> &, \
                                         const double,           \
                                         const Tensor<2, dim> &, \
                                         const double);          \
  template Tensor<2, dim> with_less_shear(const Tensor<2, dim> &, const double);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
