// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_scene_h
#define morula_scene_scene_h

#include <morula/base/method.h>
#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/forces/body_force.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/grid/grid_parameters.h>
#include <morula/mechanics/material.h>
#include <morula/output/output_parameters.h>
#include <morula/scene/catalogue.h>
#include <morula/seeding/seeding.h>
#include <morula/solver/solver_parameters.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  /** Section "Time". */
  struct TimeParameters
  {
    double       end_time      = 1.;
    double       step          = 0.05;
    double       smallest_step = 1e-4;
    unsigned int stop_at_cells = 0;

    void
    declare(ParameterHandler &prm);
  };

  /**
   * Everything a .prm file says. One section, one struct, which stands in the
   * room it belongs to; here they are put together and checked against each
   * other.
   */
  struct Scene
  {
    /** @param catalogue effects that the scene may name besides the library's
     *         own, with their defaults */
    explicit Scene(const Catalogue &catalogue = Catalogue())
      : catalogue(catalogue)
    {}

    std::string  method    = Method::by_default;
    unsigned int dimension = 3;
    std::string  output_directory; // read() fills in what is empty
    unsigned int random_seed = 1;

    TimeParameters              time;
    TissueParameters            tissue;
    GridParameters              grid;
    MaterialParameters          material;
    std::string                 growth_law = "none";
    IsotropicGrowthParameters   isotropic_growth;
    std::string                 proliferation_law = "none";
    CellCycleParameters         cell_cycle;
    BoundaryConditionParameters boundary_conditions;
    BodyForceParameters         body_force;
    SolverParameters            solver;
    OutputParameters            output;

    /** Effects that the program has added, with the values of their keys. */
    Catalogue catalogue;

    /**
     * The values of the keys as the file and the overrides wrote them, by full
     * path; what is missing has its default. parameters() repeats them, since
     * deal.II prints numbers with six digits only, and check() can tell an
     * effect that was switched off from one that was forgotten.
     */
    std::map<std::string, std::string> as_written;

    /** Where they were written, "file:line: " or "-s: ", by full path. */
    std::map<std::string, std::string> places;

    /** The file that read() read; empty without. */
    std::string file;

    /** Whether the run may delete any run that it finds in its directory. */
    bool replace = false;

    /** What to say about keys that were written by a former name. */
    std::vector<std::string> renamed;

    /** Whether an effect changes F_g without proliferation. */
    bool
    has_growth() const
    {
      return growth_law != "none";
    }

    bool
    has_proliferation() const
    {
      return proliferation_law != "none";
    }

    /** Declares every key, bound to the members. */
    void
    declare(ParameterHandler &prm);

    /**
     * Reads a .prm file and applies "Section/Key=value" overrides, without
     * Reads a .prm file and applies "Section/Key=value" overrides, without
     * checking more than each value by itself. Keys that neither of them sets
     * have the values that `Method` gives them (method.h). Without Output
     * directory it is that of the file's name, `output/NAME`.
     * @throws InputError with the key's full path, the file and the line
     */
    static Scene
    read(const std::string              &file,
         const std::vector<std::string> &overrides,
         const Catalogue                &catalogue = Catalogue());

    /** The scene of an empty file, with the same effects to choose from. */
    Scene
    with_defaults() const
    {
      return Scene(catalogue.with_defaults());
    }

    /** The message of an InputError about a value that was found wrong after
     *  the file had been read, with the place where the key stands. */
    std::string
    located(const std::string &message) const;

    /** All keys as used, as a .prm file that read() reads back exactly. */
    std::string
    parameters() const;

    /**
     * Refuses what can be seen to be wrong without cells: numbers out of
     * range, expressions that do not parse, shapes that do not exist, values
     * of effects that were never switched on, ... See scene_checks.h for the
     * checks that need the cells.
     * @throws InputError
     */
    void
    check() const;

  private:
    void
    declare_growth(ParameterHandler &prm);
    void
    declare_proliferation(ParameterHandler &prm);
  };

  /** The scene's growth law, or null. @throws InputError */
  template <int dim>
  std::unique_ptr<const GrowthLaw<dim>>
  growth_law_of(const Scene &scene);

  /** The columns that the scene's effects need in a cell. */
  template <int dim>
  CellColumns<dim>
  cell_columns_of(const Scene &scene);

  /** The scene's rule for the axes of divisions, or null where the cell cycle
   *  draws them. @throws InputError */
  template <int dim>
  std::unique_ptr<const DivisionRule<dim>>
  division_rule_of(const Scene &scene);
} // namespace Morula

#endif
