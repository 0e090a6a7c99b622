// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_effects_room_h
#define morula_tests_effects_room_h

#include <morula/effects/contact/contact_pairs.h>
#include <morula/effects/division/directions.h>
#include <morula/effects/division/divide.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/fate/removal.h>
#include <morula/effects/fields/field_equation.h>
#include <morula/effects/fields/fields.h>
#include <morula/effects/forces/body_force.h>
#include <morula/effects/forces/type_tension.h>
#include <morula/effects/growth/contraction.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/obstacles/body.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/state/state_columns.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/surface/loads.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/effects/volumes_of_step.h>
#include <morula/mechanics/relaxation.h>
#include <morula/particles/detached_points.h>
#include <morula/scene/tissue_model.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/physics/transformations.h>

#include <bitset>

#include "common/diagonal.h"
#include "common/finite_differences.h"
#include "common/materials.h"
#include "common/own_law.h"
#include "common/polygons.h"
#include "common/temporary_file.h"
#include "common/tests.h"

using namespace Morula;

#include "effects/division/dividing_tissue.h"
#include "effects/fate/lives.h"
#include "effects/lone_cell.h"
#include "effects/samples.h"
#include "effects/small_tissue.h"

#endif
