// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_effects_fate_lives_h
#define morula_tests_effects_fate_lives_h

#include "effects/small_tissue.h"


namespace Morula
{
  /** A scene of these lines. */
  inline Scene
  scene_of(const std::vector<std::string> &settings)
  {
    const TemporaryFile file("lives.prm", "");
    return Scene::read(file.path, settings);
  }

  /** Some settings, and more, which win. */
  inline std::vector<std::string>
  with(std::vector<std::string> settings, const std::vector<std::string> &more)
  {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
  }

  /** All that becomes of cells in a scene. */
  template <int dim = 2>
  CellDevelopment<dim>
  development_of(const Scene &scene)
  {
    SceneEffects<dim> effects = effects_of<dim>(scene);
    return {std::move(effects.development),
            effects.columns,
            effects.state,
            TissueMaterial(scene.material),
            scene.random_seed};
  }

  /** A founder, or some, that do not move. */
  class Alone
  {
  public:
    explicit Alone(const std::vector<std::string> &settings,
                   const std::vector<Point<2>>    &positions = {{3., 4.}})
      : development(development_of(scene_of(settings)))
      , tissue(GridParameters(), development.columns(), MPI_COMM_WORLD)
    {
      tissue.place(founders(positions, 100., development, some_deformation<2>),
                   PointList<2>());
    }

    /** Takes it from @p t0 to @p t1, day. */
    DevelopmentOfStep<2>
    live(const double t0, const double t1)
    {
      auto of_step = development.of_step(tissue, t0, t1, past);
      past         = {t0, t1};
      development.commit(tissue, of_step, t0, t1);
      return of_step;
    }

    /** The same: what befalls it. */
    std::vector<CellEvent>
    step(const double t0, const double t1)
    {
      return live(t0, t1).events;
    }

    CellView<2, const double>
    cell() const
    {
      return tissue.cells()[0];
    }

    const CellDevelopment<2> development;
    Tissue<2>                tissue;
    PastStep                 past = {};
  };

  /** What became of some founders without mechanics. */
  struct Lives
  {
    /** Cells of each type at the end. */
    std::array<double, 2>  numbers = {{0., 0.}};
    std::vector<CellEvent> events;
    std::vector<double>    births; // times
  };

  /** Whether the same has come about in steps of other lengths. */
  inline void
  expect_same(const Lives &a, const Lives &b, const double tolerance = 1e-12)
  {
    ASSERT_EQ(a.events.size(), b.events.size());
    for (std::size_t i = 0; i < a.events.size(); ++i)
      {
        EXPECT_NEAR(a.events[i].time, b.events[i].time, tolerance);
        EXPECT_EQ(a.events[i].kind, b.events[i].kind);
        EXPECT_EQ(a.events[i].to, b.events[i].to);
      }
    ASSERT_EQ(a.births.size(), b.births.size());
    for (std::size_t i = 0; i < a.births.size(); ++i)
      EXPECT_NEAR(a.births[i], b.births[i], tolerance);
    EXPECT_EQ(a.numbers, b.numbers);
  }

  /** Lets founders live until @p end, in steps of this length, days. */
  inline Lives
  lead(const Scene       &scene,
       const unsigned int n_founders,
       const double       end,
       const double       step)
  {
    const CellDevelopment<2> development = development_of(scene);
    std::vector<Point<2>>    positions;
    for (unsigned int i = 0; i < n_founders; ++i)
      positions.emplace_back(20. * i, 0.);
    Tissue<2> tissue(GridParameters(), development.columns(), MPI_COMM_WORLD);
    tissue.place(founders(positions,
                          100.,
                          development,
                          [](const Point<2> &) {
                            return Tensor<2, 2>(unit_symmetric_tensor<2>());
                          }),
                 PointList<2>());
    types::particle_index next_id = n_founders;
    Lives                 lives;
    const auto note = [&lives](const std::vector<CellEvent> &events) {
      lives.events.insert(lives.events.end(), events.begin(), events.end());
    };
    PastStep           past;
    const unsigned int n_steps = std::lround(end / step);
    for (unsigned int n = 0; n < n_steps; ++n)
      {
        const double t0 = n * step, t1 = (n + 1) * step;
        const auto   of_step = development.of_step(tissue, t0, t1, past);
        development.commit(tissue, of_step, t0, t1);
        past = {t0, t1};
        note(of_step.events);
        while (development.divides())
          {
            const auto due = cells_due(tissue, development, t1);
            if (due.empty())
              break;
            for (const auto &birth :
                 divide(tissue, development, due, t1, next_id, lives.events))
              lives.births.push_back(birth.time);
          }
        if (development.is_mortal())
          note(remove_dead_cells(tissue, development, t1));
      }
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      if (development.state().type.exists())
        ++lives.numbers[tissue.cells()[p].get(development.state().type)];
    std::sort(lives.events.begin(),
              lives.events.end(),
              [](const CellEvent &a, const CellEvent &b) {
                return a.time < b.time;
              });
    std::sort(lives.births.begin(), lives.births.end());
    return lives;
  }
} // namespace Morula

#endif
