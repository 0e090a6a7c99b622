// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_solver_room_h
#define morula_tests_solver_room_h

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/solver/block_cholesky.h>
#include <morula/solver/condition_estimate.h>
#include <morula/solver/conjugate_gradients.h>
#include <morula/solver/linear_solver.h>
#include <morula/solver/newton.h>
#include <morula/solver/preconditioner.h>
#include <morula/solver/proximal_path.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/vector.h>

#ifdef DEAL_II_WITH_PETSC
#  include <petscksp.h>
#endif

#include "common/body_on_grid.h"
#include "common/coupled_rows.h"
#include "common/linear_problem.h"
#include "common/materials.h"
#include "common/tests.h"
#include "solver/springs.h"

using namespace Morula;

#endif
