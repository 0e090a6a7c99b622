// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_scene_h
#define morula_scene_scene_h

#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/output/output_parameters.h>
#include <morula/seeding/seeding.h>
#include <morula/solver/solver_parameters.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /**
   * Everything a .prm file says. Each section has a struct of keys in the room
   * it belongs to; the scene holds them all and checks them against each other.
   */
  struct Scene : public SceneKeys
  {
    /** @param catalogue effects that the scene may have, with their defaults */
    explicit Scene(const Catalogue &catalogue = Catalogue());

    /**
     * One word that sets several keys: it changes their defaults
     * (AnyKey::texts_by_method()). A key that the scene sets itself keeps
     * the scene's value. doc/accuracy-and-cost.md says why it is these keys.
     */
    Key<std::string>  method;
    Key<std::string>  output_directory; // read() fills in what is empty
    Key<unsigned int> random_seed;

    NitscheParameters nitsche;
    SolverParameters  solver;
    OutputParameters  output;

    /** The places where keys were written, "file:line: " or "-s: ", by full
     * path.
     */
    std::map<std::string, std::string> places;

    /** The file that read() has read; empty if there is none. */
    std::string file;

    /** Whether the run may delete any run that it finds in its directory. */
    bool replace = false;

    /** What started the run, for provenance.json; empty if it was no command.
     */
    std::string command_line;

    /** What to say about keys that were written by a former name, or set twice.
     */
    std::vector<std::string> renamed;

    /** All keys but those of the types of cells. */
    KeyList
    list_without_types();

    using Keys::list;
    /** All keys, in the order of --parameters. */
    KeyList
    list() override;

    /**
     * Reads a .prm file and applies "Section/Key=value" overrides, without
     * checking more than each value by itself. Keys that neither of them sets
     * have the values that `Method` gives them. Without `Output directory` the
     * run goes to `output/NAME`, after the file's name.
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
     * Makes the sections of the fields and of the types of cells.
     * @param names of them, by the paths of the keys that have them
     * @throws InputError
     */
    void
    declare_sections(const std::map<std::string, std::string> &names);

    /** Tells the keys of cells the fields and the values that types set
     *  differently. To be called when all keys have their values. */
    void
    apply_types();

    /**
     * Refuses what is wrong even without a look at the cells: numbers out of
     * range, expressions that do not parse, shapes that do not exist, values of
     * effects that were never switched on, ... See checks.h for the checks that
     * need the cells.
     * @throws InputError
     */
    void
    check() const;
  };
} // namespace Morula

#endif
