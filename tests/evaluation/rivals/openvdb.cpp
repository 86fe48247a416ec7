// SPDX-License-Identifier: Apache-2.0
// A signed distance grid on OpenVDB as a rival: 128 voxels along the longest side, baked by its own mesh converter, read by its
// box stencil: the distance is trilinear, its gradient the direction.
#include <openvdb/math/Stencils.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/version.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include "fdcg_rival.h"
#include "rival_mesh.hpp"

namespace {

constexpr double kVoxels = 128;
constexpr double kDeepest_m = 4e-3;   // a HIP is no deeper, and beyond it the grid holds one value
constexpr float kOutside_voxels = 2;  // free space: trilinear on both sides of the surface, no more

struct Body {
  openvdb::FloatGrid::Ptr grid;
  std::unique_ptr<openvdb::math::BoxStencil<openvdb::FloatGrid>> stencil;
  double voxel_m = 0, stiffness_n_per_m = 0;
};

void* load(const fdcg_rival_mesh* mesh, double stiffness_n_per_m, char error[256]) {
  try {
    openvdb::initialize();
    auto body = std::make_unique<Body>();
    body->stiffness_n_per_m = stiffness_n_per_m;
    const auto point = [&](std::uint64_t i) { return openvdb::Vec3d(mesh->points_m + 3 * i); };
    openvdb::Vec3d low = point(0), high = low;
    for (std::uint64_t i = 1; i < mesh->point_count; ++i)
      low = openvdb::math::minComponent(low, point(i)), high = openvdb::math::maxComponent(high, point(i));
    const openvdb::Vec3d size = high - low;
    body->voxel_m = std::max({size.x(), size.y(), size.z()}) / kVoxels;
    const auto transform = openvdb::math::Transform::createLinearTransform(body->voxel_m);
    transform->postTranslate(low);
    const auto points = fdcg::rivals::points_of(
        *mesh, [&](const double* p) { return openvdb::Vec3s(transform->worldToIndex(openvdb::Vec3d(p))); });
    const auto triangles = fdcg::rivals::triangles_of(*mesh, [](const std::uint32_t* c) { return openvdb::Vec3I(c); });
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(points, triangles);
    const auto inside_voxels = static_cast<float>(kDeepest_m / body->voxel_m);
    tbb::task_arena(1).execute([&] {  // one thread, as all bake
      body->grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, kOutside_voxels, inside_voxels);
    });
    body->stencil = std::make_unique<openvdb::math::BoxStencil<openvdb::FloatGrid>>(*body->grid);
    return body.release();
  } catch (const std::exception& thrown) {
    std::snprintf(error, 256, "%s", thrown.what());
    return nullptr;
  }
}

void unload(void* body) {
  delete static_cast<Body*>(body);
}

void reset(void*) {}  // a grid remembers nothing

void step(void* of, const double hip_m[3], fdcg_rival_result* result) {
  Body& body = *static_cast<Body*>(of);
  const openvdb::Vec3d at = body.grid->transform().worldToIndex(openvdb::Vec3d(hip_m));
  const openvdb::Vec3f place(at);
  body.stencil->moveTo(openvdb::Coord::floor(at));
  const double distance_m = body.stencil->interpolation(place);
  openvdb::Vec3f gradient(0);
  if (distance_m < 0) {
    gradient = body.stencil->gradient(place);
    if (!gradient.normalize()) gradient.setZero();
  }
  for (int k = 0; k < 3; ++k) {
    const double offset = distance_m < 0 ? -distance_m * static_cast<double>(gradient[k]) : 0;
    result->god_object_m[k] = hip_m[k] + offset;
    result->force_n[k] = body.stiffness_n_per_m * offset;
  }
  result->is_in_contact = distance_m < 0;
  result->reserved = 0;
}

uint64_t memory(const void* body) {
  return static_cast<const Body*>(body)->grid->memUsage();
}

constexpr fdcg_rival kRival = {
    FDCG_RIVAL_ABI, 0,     "openvdb_128", "distance_grid", "f32",  "OpenVDB " OPENVDB_LIBRARY_VERSION_STRING, load,
    unload,         reset, step,          memory,          nullptr};

}  // namespace

const fdcg_rival* fdcg_rival_get(uint32_t abi) {
  return abi == FDCG_RIVAL_ABI ? &kRival : nullptr;
}
