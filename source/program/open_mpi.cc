// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/open_mpi.h>

#include <algorithm>
#include <cstdlib>
#include <initializer_list>

namespace Morula
{
  namespace
  {
    /** Whether mpiexec or a batch system has started this process. */
    bool
    is_launched()
    {
      const std::initializer_list<const char *> variables = {
        "OMPI_COMM_WORLD_SIZE",
        "PMIX_RANK",
        "PMI_RANK",
        "PMI_FD",
        "SLURM_PROCID"};
      return std::any_of(variables.begin(),
                         variables.end(),
                         [](const char *variable) {
                           return std::getenv(variable) != nullptr;
                         });
    }
  } // namespace

  void
  set_up_open_mpi()
  {
    // The number of a component is that of the ROMIO which the version of Open
    // MPI contains; a name that it does not know is ignored. The last argument
    // 0 leaves what the user has set.
    for (const char *variable :
         {"OMPI_MCA_io_romio321_priority", "OMPI_MCA_io_romio341_priority"})
      setenv(variable, "100", 0);
    setenv("HWLOC_COMPONENTS", "-gl", 0);
    // What follows is for one rank that starts itself. Ranks of a launcher need
    // the daemon and the directories to find each other.
    if (is_launched())
      return;
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
    setenv("OMPI_MCA_pml", "ob1", 0);
  }
} // namespace Morula
