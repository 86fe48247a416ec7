// SPDX-License-Identifier: Apache-2.0
#include "surface/surface_drive.hpp"
#include "surface/surface_round.hpp"

FDCG_SURFACE_KIND(sphere, FDCG_SURFACE_SPHERE, Sphere, Sphere)
