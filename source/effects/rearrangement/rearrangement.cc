// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/state/neighbour_columns.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <sstream>

namespace Morula
{
  namespace
  {
    bool
    relaxes(const SceneKeys &scene)
    {
      return scene.keys<RelaxationParameters>().is_on();
    }


    /** Section "Rearrangement". */
    struct RearrangementParameters : public EffectKeys
    {
      ExpressionKey diffusion{
        {this, "Rearrangement/Diffusion"},
        "0",
        "Diffusion coefficient of a cell among equal ones, which exchanges its "
        "place with neighbours; of two that differ the harmonic mean counts. "
        "An expression; 0: the cell keeps its place. Units: um^2/day.",
        Evaluated::step,
        not_negative("um^2/day", "0 lets the cell keep its place.")};

      Key<double> energy{
        {this, "Rearrangement/Fluctuation energy"},
        0.,
        "T in the probability 1/(1 + exp(E/T)) that an exchange is made which "
        "changes the energy of adhesion (Cell types/NAME/Tension) by E; 0: "
        "never one that raises it. In 3-D times um. Units: kPa um^2.",
        {0.}};

      /** q */
      Key<double> shear_released{
        {this, "Rearrangement/Shear released"},
        1.,
        "Part of the elastic shear that each exchange takes from both places: "
        "1 is a liquid as long as cells exchange places.",
        {0.},
        {[](const double q) { return q <= 1.; },
         "a number from 0 to 1",
         "1 releases all shear at the two places."}};

      ExpressionKey drive{
        {this, "Rearrangement/Drive"},
        "0; 0; 0",
        "Force with which a cell looks for exchanges along it; none acts on "
        "the tissue. An expression. In 3-D times um. Units: kPa um.",
        Evaluated::step,
        3};

      EffectFacts
      facts() const override
      {
        EffectFacts facts{&diffusion};
        facts.exchanges_places = diffusion.is_changed();
        facts.releases_shear   = facts.exchanges_places && shear_released > 0.;
        return facts;
      }
      void
      check(const SceneKeys &scene, Review &review) const override
      {
        if (!is_on())
          return;
        if (energy == 0. && !drive.is_default())
          energy.refuse("a value > 0, as " + drive.path() + " is set",
                        "A drive is followed at the rate D f/T.");
        if (scene.volumes_differ() &&
            scene.material.volumetric_form() != VolumetricStrain::pooled)
          scene.material.volumetric_strain.refuse(
            "pooled, as " + diffusion.path() +
              " is set and the cells' volumes may differ",
            "A place keeps its space when another cell comes to it, so that a "
            "larger cell is squeezed there until its grid cell shares the pressure "
            "out: set it to pooled, and " +
              scene.material.energy_per.path() + " = grown volume.");
        if (scene.grid.points_per_cell > 1)
          scene.grid.points_per_cell.refuse(
            "1, as " + diffusion.path() + " is set",
            "Exchanges of places are not made for cells of several points.");
        if (const auto &found_by = scene.keys<NeighbourParameters>().found_by;
            found_by != "facets")
          found_by.refuse("facets, as " + diffusion.path() + " is set",
                          "The rates of exchange follow from the facets.");
        // A cell takes part in k = 2 d D/a² exchanges per day, among equal
        // cells with the largest D that is a plain number.
        if (const auto D = diffusion.largest_number(scene.dimension);
            D && *D > 0.)
          if (const double a = scene.tissue.cell_spacing,
              k              = 2. * scene.dimension * *D / (a * a),
              attempts       = k * scene.time.step;
              attempts > 1.)
            {
              std::ostringstream why, remedy;
              why << "each cell tries to change its place " << attempts
                  << " times in a step of " << scene.time.step
                  << " day. The places themselves move between steps only.";
              remedy << "Let Time/Step be at most " << 1. / k << " day.";
              review.warn(diffusion.path(),
                          diffusion.text() + " um^2/day",
                          why.str(),
                          remedy.str());
            }
        if (shear_released == 0. && !relaxes(scene))
          review.warn(
            shear_released.path(),
            "0",
            "cells pass through a solid that holds its shear for ever.",
            "Set it to 1, or set Material/Relaxation time.");
        if (shear_released > 0. && relaxes(scene))
          review.warn(shear_released.path(),
                      shear_released.text(),
                      "the shear relaxes twice, by exchanges and by "
                      "Material/Relaxation time.",
                      "Use one of the two.");
      }
    };


    /** Cells exchange their places with neighbours: doc/theory.md,
     * section 12.3.
     */
    template <int dim>
    class Rearrangement : public StepEffect<dim>
    {
    public:
      using Parameters = RearrangementParameters;

      /** @throws InputError for expressions that cannot be parsed */
      Rearrangement(const Parameters         &parameters,
                    const EffectSetting<dim> &setting)
        : diffusion(setting.state.use(parameters.diffusion))
        , drive(setting.state.use(parameters.drive))
        , energy(setting.tensions, parameters.energy)
        , shear_released(parameters.shear_released)
        , random_seed(setting.random_seed)
        , slack(setting.slack)
        , death_time(setting.columns.template find<double>("death_time"))
        , neighbours(setting.neighbours)
      {}

      void
      declare(Tables<dim> &tables) const override
      {
        tables.add_number("exchanges");
        tables.add_number("adhesion_energy");
        tables.add_number("unlike_share");
      }
      void
      settle(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override
      {
        std::vector<Occupant> cells;
        everywhere(tissue.communicator(),
                   [&]() { cells = cells_of(tissue, moment.reader); });
        const Places places = places_of(tissue, cells, neighbours);
        tell(moment, places, cells, 0., tissue.communicator());
      }
      void
      rearrange(Tissue<dim>            &tissue,
                const MomentOfRun<dim> &moment) const override
      {
        // The events run on copies of the cells, while the places stay as they
        // are. At the end the owner of each place tells the rank of the cell
        // that has come there what the place keeps: position, volume, F_e, and
        // the fields, whose amounts stay so; of others the cell brings its
        // amount. A cell comes from farther away than the places around a rank
        // reach, if it has had many exchanges; so it carries its rank and
        // number with it. The cells of this rank are moved at last, in one go.
        const MPI_Comm           comm    = tissue.communicator();
        const StateColumns<dim> &columns = moment.reader.columns;
        std::vector<Occupant>    cells;
        everywhere(comm, [&]() { cells = cells_of(tissue, moment.reader); });
        const std::size_t n_own  = cells.size();
        const Places      places = places_of(tissue, cells, neighbours);
        ExchangeRounds    rounds(
          places,
          cells,
          attempts(places, cells, random_seed, moment.t / slack, moment.dt),
          energy);
        run(rounds, places, comm);

        std::map<unsigned int, std::vector<double>> sent;
        double                                      n_exchanges = 0.;
        for (unsigned int p = 0; p < n_own; ++p)
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
            append_flat(list, place.carried_volume());
            append_flat(list, F_e);
            for (const Column<double> &field : columns.fields)
              append_flat(list, place.get(field));
          }
        take_places(tissue, sent, columns);
        tell(moment, places, rounds.occupants(), n_exchanges, comm);
      }

    private:
      /** The cells of this rank as occupants of places. @throws InputError */
      std::vector<Occupant>
      cells_of(const Tissue<dim> &tissue, const CellReader<dim> &reader) const
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
            list.push_back({cell.lineage_key(),
                            cell.type(),
                            is_dead ? 0. : cell.value(diffusion, reader.time),
                            {},
                            rank,
                            p});
            for (unsigned int d = 0; d < dim; ++d)
              list.back().drive[d] = f[d];
          }
        return list;
      }

      /** Moves this rank's cells to what their new places keep. Collective.
       *  @param kept numbers of this rank's places, by the ranks of the cells
       *         that come there */
      static void
      take_places(Tissue<dim>                                       &tissue,
                  const std::map<unsigned int, std::vector<double>> &kept,
                  const StateColumns<dim>                           &columns)
      {
        std::vector<Point<dim>> positions = tissue.cells().positions();
        const std::size_t       width =
          1 + dim + 2 + dim * dim + columns.fields.size();
        for (const auto &[rank, list] :
             send_records(kept, tissue.communicator()))
          for (std::size_t i = 0; i < list.size(); i += width)
            {
              const double      *next = &list[i];
              const unsigned int p    = static_cast<unsigned int>(next[0]);
              positions[p]            = Flat<Point<dim>>::read(next + 1);
              const double         V  = next[1 + dim];
              const Tensor<2, dim> F_e =
                Flat<Tensor<2, dim>>::read(next + 3 + dim);
              const CellView<dim, double> cell   = tissue.cell(p);
              const double                before = cell.volume();
              cell.set(
                tissue.cells().columns().deformation,
                deformation_at(F_e, V, cell.growth(), cell.initial_volume()));
              if (const auto c = tissue.cells().columns().carried; c.exists())
                cell.set(c, next[2 + dim] / V);
              for (std::size_t k = 0; k < columns.fields.size(); ++k)
                cell.set(columns.fields[k],
                         columns.carried[k] ?
                           cell.get(columns.fields[k]) * before / V :
                           next[3 + dim + dim * dim + k]);
            }
        tissue.move(positions, tissue.boundary_points().positions());
      }

      /** Writes the numbers of the step. Collective. */
      void
      tell(const MomentOfRun<dim>      &moment,
           const Places                &places,
           const std::vector<Occupant> &occupants,
           const double                 n_exchanges,
           const MPI_Comm               comm) const
      {
        // Each contact is seen from both of its cells, and counts half each
        // time.
        double sum = 0., touching = 0., unlike = 0.;
        for (unsigned int p = 0; p < places.size(); ++p)
          if (places.own[p])
            {
              const unsigned int type = occupants[p].type;
              for (unsigned int e = places.offsets[p];
                   e < places.offsets[p + 1];
                   ++e)
                {
                  const unsigned int other =
                    occupants[places.edges[e].other].type;
                  sum +=
                    0.5 * places.edges[e].area * energy.between(type, other);
                  touching += places.edges[e].area;
                  unlike += other == type ? 0. : places.edges[e].area;
                }
              sum += places.free[p] * energy.with_surface(type);
            }
        touching                    = Utilities::MPI::sum(touching, comm);
        moment.of_step["exchanges"] = Utilities::MPI::sum(n_exchanges, comm);
        moment.of_step["adhesion_energy"] = Utilities::MPI::sum(sum, comm);
        moment.of_step["unlike_share"] =
          Utilities::MPI::sum(unlike, comm) / (touching > 0. ? touching : 1.);
      }

      const Expression      diffusion, drive;
      const AdhesionEnergy  energy;
      const double          shear_released;
      const std::uint64_t   random_seed;
      const double          slack; // in proportion to Time/Step, day
      const Column<double>  death_time;
      const NeighbourSearch neighbours;
    };
  } // namespace


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


  MORULA_INSTANTIATE(with_less_shear);
  MORULA_INSTANTIATE(deformation_at);


  void
  add_rearrangement(Catalogue &catalogue)
  {
    catalogue.add_own<Rearrangement>("rearrangement",
                                     {"Rearrangement/Diffusion=1",
                                      "Material/Volumetric strain=pooled"});
  }
} // namespace Morula
