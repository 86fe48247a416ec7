// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_cone.hpp"
#include "surface/surface_drive.hpp"

FDCG_SURFACE_KIND(cone, FDCG_SURFACE_CONE, ConeSurface, QuickCone)
