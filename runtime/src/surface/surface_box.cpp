// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_box.hpp"
#include "surface/surface_drive.hpp"

FDCG_SURFACE_KIND(box, FDCG_SURFACE_BOX, BoxSurface, BoxSurface)
