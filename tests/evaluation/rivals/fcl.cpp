// SPDX-License-Identifier: Apache-2.0
// The Flexible Collision Library as a rival: the closest point of a mesh, by its distance query between a tree of boxes and a
// ball of no size. Inside is behind the nearest triangle's plane.
#include <fcl/config.h>
#include <fcl/fcl.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include "fdcg_rival.h"
#include "rival_mesh.hpp"

namespace {

using Mesh = fcl::BVHModel<fcl::OBBRSSd>;

struct Body {
  Mesh mesh;
  fcl::Sphered hand{0};
  fcl::DistanceRequestd request{true};
  std::vector<fcl::Vector3d> normals;  // of triangles; their length is any
  double stiffness_n_per_m = 0;
};

void* load(const fdcg_rival_mesh* mesh, double stiffness_n_per_m, char error[256]) {
  try {
    auto body = std::make_unique<Body>();
    const auto points = fdcg::rivals::points_of(*mesh, [](const double* p) { return fcl::Vector3d(p[0], p[1], p[2]); });
    const auto triangles =
        fdcg::rivals::triangles_of(*mesh, [](const std::uint32_t* c) { return fcl::Triangle(c[0], c[1], c[2]); });
    for (const fcl::Triangle& t : triangles)
      body->normals.push_back((points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]));
    const bool is_built = body->mesh.beginModel() == fcl::BVH_OK && body->mesh.addSubModel(points, triangles) == fcl::BVH_OK &&
                          body->mesh.endModel() == fcl::BVH_OK;
    if (!is_built) {
      std::snprintf(error, 256, "FCL does not build a tree of it");
      return nullptr;
    }
    body->stiffness_n_per_m = stiffness_n_per_m;
    return body.release();
  } catch (const std::exception& thrown) {
    std::snprintf(error, 256, "%s", thrown.what());
    return nullptr;
  }
}

void unload(void* body) {
  delete static_cast<Body*>(body);
}

void reset(void*) {}  // a closest point remembers nothing

void step(void* of, const double hip_m[3], fdcg_rival_result* result) {
  const Body& body = *static_cast<const Body*>(of);
  const Eigen::Map<const fcl::Vector3d> hip(hip_m);
  fcl::DistanceResultd found;
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.translation() = hip;
  fcl::distance(&body.mesh, fcl::Transform3d::Identity(), &body.hand, pose, body.request, found);
  // on the surface, where FCL says of two bodies that meet nothing but that, no force is felt
  const bool is_inside = found.min_distance > 0 && found.b1 >= 0 &&
                         (hip - found.nearest_points[0]).dot(body.normals[static_cast<std::size_t>(found.b1)]) < 0;
  for (int k = 0; k < 3; ++k) {
    const double offset = is_inside ? found.nearest_points[0][k] - hip[k] : 0;
    result->god_object_m[k] = hip[k] + offset;
    result->force_n[k] = body.stiffness_n_per_m * offset;
  }
  result->is_in_contact = is_inside;
  result->reserved = 0;
}

uint64_t memory(const void* of) {
  const Body& body = *static_cast<const Body*>(of);
  const auto bytes = [](int count, std::size_t size) { return static_cast<std::uint64_t>(count) * size; };
  return bytes(body.mesh.getNumBVs(), sizeof(fcl::BVNode<fcl::OBBRSSd>)) +
         bytes(body.mesh.num_tris, sizeof(fcl::Triangle) + sizeof(unsigned) + sizeof(fcl::Vector3d)) +  // and index, normal
         bytes(body.mesh.num_vertices, sizeof(fcl::Vector3d));
}

constexpr fdcg_rival kRival = {FDCG_RIVAL_ABI, 0,     "fcl_closest", "closest_point", "f64",  "FCL " FCL_VERSION, load,
                               unload,         reset, step,          memory,          nullptr};

}  // namespace

const fdcg_rival* fdcg_rival_get(uint32_t abi) {
  return abi == FDCG_RIVAL_ABI ? &kRival : nullptr;
}
