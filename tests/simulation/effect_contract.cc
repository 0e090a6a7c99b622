// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// What must hold of every effect, the library's and those of another program:
// the residual is the derivative of the energy and the tangent that of the
// residual; where the effect is absent, it leaves no trace; on more ranks, with
// founders in another order, with x and y exchanged, resumed and killed, the
// same becomes of the cells.

#include "simulation/effect_contract.h"

#include "own_effects/own_effects.h"

using namespace Morula;

namespace
{
  std::vector<EffectCase>
  all_effects()
  {
    Catalogue catalogue;
    Own::add_effects(catalogue);
    return cases_of(catalogue);
  }
} // namespace


TEST_P(EffectContract, Holds)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1 &&
      !GetParam().on_ranks)
    GTEST_SKIP();
  check();
}


INSTANTIATE_TEST_SUITE_P(All,
                         EffectContract,
                         ::testing::ValuesIn(all_effects()),
                         contract_name);
