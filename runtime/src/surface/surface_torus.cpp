// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_torus.hpp"
#include "surface/surface_drive.hpp"

FDCG_SURFACE_KIND(torus, FDCG_SURFACE_TORUS, Torus, Torus)
