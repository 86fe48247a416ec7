// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_cone.hpp"
#include "surface/surface_drive.hpp"

FDCG_SURFACE_KIND(cylinder, FDCG_SURFACE_CYLINDER, ConeSurface, QuickCylinder)
