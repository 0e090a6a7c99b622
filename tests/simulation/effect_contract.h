// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_simulation_effect_contract_h
#define morula_tests_simulation_effect_contract_h

#include <morula/effects/part_of_step.h>
#include <morula/simulation/simulation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <list>
#include <map>
#include <random>
#include <set>

#include "output/scratch_directory.h"

namespace Morula
{
  struct ProbeKeys : public EffectKeys
  {
    Key<bool> look{"Look", false, "Whether derivatives are looked at."};

    bool
    is_on() const override
    {
      return look;
    }

    using Keys::list;
    KeyList
    list() override
    {
      return {&look};
    }
  };

  /** Where a step has found its equilibrium, expects that the residual is the
   *  derivative of the energy, if all terms have one, and the tangent that of
   *  the residual. */
  template <int dim>
  class DerivativesOfStep : public PartOfStep<dim>
  {
  public:
    using Vector = Equilibrium::Vector;

    void
    begin(MomentumBalance<dim> &of_step, const Vector &) override
    {
      balance = &of_step;
    }

    bool
    renew(const Vector &equilibrium) override
    {
      // Away from the equilibrium, where the energy has a derivative that is
      // not 0. The grid spacing is 2 µm.
      const Vector along = random(equilibrium);
      Vector       at(equilibrium);
      const double eps = 1e-5;
      Vector       R(at), ahead(at), behind(at), expected(at);
      const auto   shifted = [&](const double by, Vector &residual) {
        Vector u(at);
        u.add(by, along);
        return balance->residual(u, residual).energy;
      };
      at.add(0.01, random(equilibrium));
      balance->residual(at, R);
      const double dE =
        (shifted(eps, ahead) - shifted(-eps, behind)) / (2. * eps);
      if (balance->linear_problem(1., {}, 1).symmetric)
        {
          EXPECT_NEAR(dE, R * along, 1e-6 * R.l2_norm() * along.l2_norm());
        }

      balance->tangent(at, GrowthAt::current).vmult(expected, along);
      add_rank_ones(expected, balance->rank_ones(), along);
      ahead -= behind;
      ahead *= 1. / (2. * eps);
      const double size = expected.linfty_norm();
      ahead -= expected;
      EXPECT_LE(ahead.linfty_norm(), 1e-5 * size);
      return false;
    }

    std::string
    unfinished() const override
    {
      return "";
    }

  private:
    /** Components in [-1, 1], µm. */
    Vector
    random(const Vector &like)
    {
      std::uniform_real_distribution<double> uniform(-1., 1.);
      Vector                                 v(like);
      for (const auto i : v.locally_owned_elements())
        v(i) = uniform(generator);
      return v;
    }

    MomentumBalance<dim> *balance = nullptr;
    std::mt19937          generator;
  };

  /** A condition that does nothing, so that it has a part of each step. */
  template <int dim>
  class Probe : public BoundaryCondition<dim>
  {
  public:
    using Parameters = ProbeKeys;

    explicit Probe(const Parameters &) {}

    SurfaceCondition
    kind() const override
    {
      return SurfaceCondition::loaded;
    }

    bool
    acts_on(const Point<dim> &, const Tensor<1, dim> &) const override
    {
      return true;
    }

    std::vector<std::unique_ptr<PartOfStep<dim>>>
    parts_of_step(const AttemptAtStep<dim> &) const override
    {
      std::vector<std::unique_ptr<PartOfStep<dim>>> list;
      list.push_back(std::make_unique<DerivativesOfStep<dim>>());
      return list;
    }
  };

  /** What runs are compared by. */
  struct Outcome
  {
    /** Positions and columns of the cells of all ranks, by id. */
    std::map<types::particle_index, std::vector<double>> cells;
    /** The rows of statistics.csv, without wall_seconds. */
    std::vector<std::vector<std::string>> rows;
    /** Columns of cells and of statistics.csv, and sections of timings.csv. */
    std::set<std::string> names;

    bool
    operator==(const Outcome &other) const
    {
      return cells == other.cells && rows == other.rows && names == other.names;
    }
  };

  /** The words of a file of comma-separated values, row by row. */
  inline std::vector<std::vector<std::string>>
  words_of(const std::string &path)
  {
    std::vector<std::vector<std::string>> rows;
    std::ifstream                         in(path);
    for (std::string line; std::getline(in, line);)
      rows.push_back(Utilities::split_string_list(line, ','));
    return rows;
  }

  /** An effect of a catalogue, in 2-D or 3-D; whether ranks can change it. */
  struct EffectCase
  {
    const Catalogue    *catalogue;
    std::string         name;
    Catalogue::Settings example;
    int                 dim;
    bool                on_ranks;
  };

  inline std::ostream &
  operator<<(std::ostream &out, const EffectCase &effect)
  {
    return out << effect.name << ", " << effect.dim << "-D";
  }

  /** Effects that act on the surface or add forces, also in 3-D: the residual
   * of others is that of growth. Laws of a cell by itself: on one rank. */
  inline std::vector<EffectCase>
  cases_of(const Catalogue &effects)
  {
    static std::list<Catalogue> catalogues;
    catalogues.push_back(effects);
    catalogues.back().add<Probe>("probe");
    std::vector<EffectCase> list;
    const auto add = [&](const auto &kind, const bool in_3d, const bool ranks) {
      for (const auto &choice : kind)
        for (const int dim : {2, 3})
          {
            const Catalogue::Settings &example = choice.example();
            const auto                 is_of   = [&example](const int d) {
              return std::count(example.begin(),
                                example.end(),
                                "Dimension=" + std::to_string(d)) > 0;
            };
            // There may be no example, or one in the other dimension alone.
            if (!example.empty() && !is_of(5 - dim) &&
                (dim == 2 || in_3d || is_of(3)))
              list.push_back({&catalogues.back(),
                              choice.name(),
                              example,
                              dim,
                              ranks && (dim == 2 || is_of(3))});
          }
    };
    add(effects.growth_laws, false, false);
    add(effects.division_rules, false, false);
    add(effects.growth_factors, false, false);
    add(effects.flows, false, false);
    add(effects.traits, false, false);
    add(effects.fates, false, true);
    add(effects.equations, false, true);
    add(effects.step_effects, false, true);
    add(effects.forces, true, true);
    add(effects.boundary_conditions, true, true);
    add(effects.interactions, true, true);
    return list;
  }

  /** E.g. body_force_2d_12. */
  inline std::string
  contract_name(const ::testing::TestParamInfo<EffectCase> &info)
  {
    std::string name = info.param.name;
    std::replace_if(
      name.begin(),
      name.end(),
      [](const char c) { return !std::isalpha(c); },
      '_');
    return name + '_' + std::to_string(info.param.dim) + "d_" +
           std::to_string(info.index);
  }

  /** The same columns of the same cells, but for rounding. */
  inline void
  expect_near(const Outcome &a, const Outcome &b)
  {
    ASSERT_EQ(a.cells.size(), b.cells.size());
    for (const auto &[id, row] : a.cells)
      {
        const auto found = b.cells.find(id);
        ASSERT_TRUE(found != b.cells.end()) << "cell " << id;
        ASSERT_EQ(row.size(), found->second.size());
        for (std::size_t i = 0; i < row.size(); ++i)
          if (row[i] != found->second[i]) // both may be infinite
            {
              EXPECT_NEAR(row[i], found->second[i], 1e-7)
                << "number " << i << " of cell " << id;
            }
      }
  }

  /** The longest way from a place of cells of @p a to the nearest of @p b, µm;
   *  infinite if there are not as many. */
  template <int dim>
  double
  apart(const Outcome &a, const Outcome &b, const bool exchanged = false)
  {
    double longest = a.cells.size() == b.cells.size() ?
                       0. :
                       std::numeric_limits<double>::infinity();
    for (const auto &[id, row] : a.cells)
      {
        Point<dim> x;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] = row[exchanged && d < 2 ? 1 - d : d];
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto &[other_id, other] : b.cells)
          {
            Point<dim> y;
            std::copy_n(other.begin(), dim, y.begin_raw());
            nearest = std::min(nearest, x.distance(y));
          }
        longest = std::max(longest, nearest);
      }
    return longest;
  }

  class EffectContract : public ::testing::TestWithParam<EffectCase>
  {
  protected:
    using Settings = Catalogue::Settings;
    using Observe  = std::function<void(const unsigned int)>;

    /** All that an effect has to keep. */
    void
    check()
    {
      if (GetParam().dim == 2)
        check_in<2>();
      else
        check_in<3>();
    }

  private:
    template <int dim>
    void
    check_in()
    {
      const Settings &example = GetParam().example;
      const bool first = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
      const Outcome expected = run<dim>(
        example, "whole", MPI_COMM_WORLD, false, [&](const unsigned int n) {
          // what a run leaves that is killed after its third step
          if (first && n == 3)
            std::filesystem::copy(directory / "whole", directory / "killed");
        });
      if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
        check_alone<dim>(expected);
      else if (first)
        expect_near(expected, run<dim>(example, "one", MPI_COMM_SELF));
      EXPECT_TRUE(run<dim>(example, "killed", MPI_COMM_WORLD, true) ==
                  expected);
    }

    /** What one rank is enough for. */
    template <int dim>
    void
    check_alone(const Outcome &expected)
    {
      // The same for all effects of a catalogue.
      static const Outcome without = run<dim>({}, "without", MPI_COMM_SELF);
      EXPECT_FALSE(without == expected) << "The example does nothing.";
      EXPECT_EQ(without.names.count(GetParam().name), 0u);
      // position; initial position and volume, deformation
      EXPECT_EQ(without.cells.begin()->second.size(), 2 * dim + 1 + dim * dim);

      run<dim>(with(with(GetParam().example, "Time/End time=0.2"),
                    "Boundary conditions/Probe/Look=true"),
               "derivatives",
               MPI_COMM_SELF);

      const double permuted = apart<dim>(
        changed<dim>("permuted",
                     [](SeededTissue<dim> &tissue) {
                       std::reverse(tissue.founders.positions.begin(),
                                    tissue.founders.positions.end());
                       std::reverse(tissue.founders.volumes.begin(),
                                    tissue.founders.volumes.end());
                     }),
        expected);
      const double turned =
        apart<dim>(changed<dim>("turned",
                                [](SeededTissue<dim> &tissue) {
                                  for (auto &X : tissue.founders.positions)
                                    std::swap(X[0], X[1]);
                                  for (auto &X : tissue.surface.positions)
                                    std::swap(X[0], X[1]);
                                  for (auto &N : tissue.surface.normals)
                                    std::swap(N[0], N[1]);
                                }),
                   expected,
                   true);
      if (std::max(permuted, turned) < 1e-7)
        return;
      // Cells draw by their numbers, and axes in space.
      const double other_seed =
        apart<dim>(run<dim>(with(GetParam().example, "Random seed=2"),
                            "seed",
                            MPI_COMM_SELF),
                   expected);
      EXPECT_GT(other_seed, 1e-7)
        << "Permuted or turned cells end elsewhere, by " << permuted << " and "
        << turned << " um, although nothing is drawn.";
    }

    static Settings
    with(Settings settings, const std::string &more)
    {
      settings.push_back(more);
      return settings;
    }

    /** A ball of cells of 1 µm, in four steps, with these settings. The tangent
     *  of pooled volumes is exact at an equilibrium only. */
    Scene
    scene(Settings settings, const std::string &name) const
    {
      const std::string output = directory / name;
      const Settings    ball   = {"Dimension=" + std::to_string(GetParam().dim),
                                  "Output directory=" + output,
                                  "Output/Formats=none",
                                  "Output/Snapshot interval=0.2",
                                  "Tissue/Radius=3",
                                  "Tissue/Cell spacing=1",
                                  "Material/Volumetric strain=pointwise",
                                  "Grid/Spacing=2",
                                  "Time/Step=0.1",
                                  "Time/End time=0.4",
                                  "Solver/Newton tolerance=1e-10"};
      settings.insert(settings.begin(), ball.begin(), ball.end());
      write(output + ".prm", "");
      const Scene scene =
        Scene::read(output + ".prm", settings, *GetParam().catalogue);
      scene.check();
      return scene;
    }

    template <int dim>
    Outcome
    run(
      const Settings    &settings,
      const std::string &name,
      const MPI_Comm     comm,
      const bool         resume  = false,
      const Observe     &observe = [](const unsigned int) {}) const
    {
      const Scene     of_run = scene(settings, name);
      Simulation<dim> simulation(of_run, comm, resume);
      return outcome(simulation, of_run, comm, observe);
    }

    /** The run of founders and boundary points that @p change has changed. */
    template <int dim, typename Change>
    Outcome
    changed(const std::string &name, const Change &change) const
    {
      const Scene            of_run = scene(GetParam().example, name);
      const TissueModel<dim> model(of_run);
      SeededTissue<dim>      tissue = seed_tissue(model, MPI_COMM_SELF);
      change(tissue);
      Simulation<dim> simulation(of_run, MPI_COMM_SELF, tissue);
      return outcome(simulation, of_run, MPI_COMM_SELF, [](const unsigned int) {
      });
    }

    template <int dim>
    static Outcome
    outcome(Simulation<dim> &simulation,
            const Scene     &scene,
            const MPI_Comm   comm,
            const Observe   &observe)
    {
      unsigned int n = 0;
      simulation.run([&]() { observe(n++); });
      Outcome              outcome;
      const PointList<dim> cells = simulation.state().cells().copy();
      std::map<types::particle_index, std::vector<double>> own;
      for (unsigned int p = 0; p < cells.size(); ++p)
        {
          const Point<dim>    &x   = cells.positions[p];
          const auto           row = cells.row(p);
          std::vector<double> &all = own[cells.ids[p]];
          all.assign(x.begin_raw(), x.end_raw());
          all.insert(all.end(), row.begin(), row.end());
        }
      for (const auto &part : Utilities::MPI::all_gather(comm, own))
        outcome.cells.insert(part.begin(), part.end());
      outcome.rows     = words_of(scene.output_directory + "/statistics.csv");
      const auto &head = outcome.rows.at(0);
      const auto  clock =
        std::find(head.begin(), head.end(), "wall_seconds") - head.begin();
      for (auto &row : outcome.rows)
        row.erase(row.begin() + clock);
      outcome.names.insert(head.begin(), head.end());
      for (const auto &column : simulation.state().cells().columns().entries())
        outcome.names.insert(column.name);
      for (const auto &row : words_of(scene.output_directory + "/timings.csv"))
        outcome.names.insert(row.at(0));
      return outcome;
    }

    /** The progress of runs is not printed. */
    struct Silence
    {
      ~Silence()
      {
        std::cout.rdbuf(before);
        std::cout.clear();
      }

      std::streambuf *const before = std::cout.rdbuf(nullptr);
    };

    const Silence          silence;
    const ScratchDirectory directory;
  };
} // namespace Morula

#endif
