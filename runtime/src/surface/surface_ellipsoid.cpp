// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_drive.hpp"
#include "surface/surface_round.hpp"

FDCG_SURFACE_KIND(ellipsoid, FDCG_SURFACE_ELLIPSOID, Ellipsoid, Ellipsoid)
