// SPDX-License-Identifier: Apache-2.0
// Bullet as a rival. It has no query for the closest point of a mesh; what it has is its quantised tree of boxes, asked for the
// triangles in a box about the hand that is as large as the last answer is far; the nearest point of each is this file's, in
// Bullet's floats. Inside is behind the nearest triangle's plane.
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include "fdcg_rival.h"
#include "rival_mesh.hpp"

namespace {

struct Body {
  std::vector<btVector3> points;
  std::vector<int> corners;
  std::unique_ptr<btTriangleIndexVertexArray> triangles;
  std::unique_ptr<btBvhTriangleMeshShape> shape;
  btVector3 last;  // answer
  bool has_last = false;
  btScalar first_reach = 0;
  double stiffness_n_per_m = 0;
};

btVector3 vector_of(const double* p) {
  return {static_cast<btScalar>(p[0]), static_cast<btScalar>(p[1]), static_cast<btScalar>(p[2])};
}

btVector3 nearest_on_segment(const btVector3& p, const btVector3& a, const btVector3& b) {
  const btVector3 along = b - a;
  const btScalar square = along.length2();
  return square > 0 ? a + along * std::clamp((p - a).dot(along) / square, btScalar(0), btScalar(1)) : a;
}

class Nearest : public btTriangleCallback {
 public:
  Nearest(const btVector3& hip, const btVector3& last) : hip_(hip), square_(SIMD_INFINITY), point_(last) {}
  void processTriangle(btVector3* corners, int, int) override {
    const btVector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const btScalar area = normal.length2();
    bool is_over = area > 0;
    for (int k = 0; k < 3 && is_over; ++k)
      is_over = (corners[(k + 1) % 3] - corners[k]).cross(normal).dot(hip_ - corners[k]) <= 0;
    if (is_over) {
      offer(hip_ - normal * ((hip_ - corners[0]).dot(normal) / area), normal);
      return;
    }
    for (int k = 0; k < 3; ++k)
      offer(nearest_on_segment(hip_, corners[k], corners[(k + 1) % 3]), normal);
  }
  [[nodiscard]] const btVector3& point() const { return point_; }
  [[nodiscard]] btScalar distance() const { return btSqrt(square_); }
  [[nodiscard]] bool is_inside() const { return (hip_ - point_).dot(normal_) < 0; }

 private:
  void offer(const btVector3& point, const btVector3& normal) {
    const btScalar square = (hip_ - point).length2();
    if (square >= square_) return;
    square_ = square;
    point_ = point;
    normal_ = normal;
  }
  btVector3 hip_;
  btScalar square_;
  btVector3 point_, normal_{0, 0, 0};
};

void* load(const fdcg_rival_mesh* mesh, double stiffness_n_per_m, char error[256]) {
  try {
    auto body = std::make_unique<Body>();
    body->stiffness_n_per_m = stiffness_n_per_m;
    body->points = fdcg::rivals::points_of(*mesh, vector_of);
    body->corners.assign(mesh->corners, mesh->corners + 3 * mesh->triangle_count);
    body->triangles = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh->triangle_count), body->corners.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh->point_count), &body->points[0][0], static_cast<int>(sizeof(btVector3)));
    body->shape = std::make_unique<btBvhTriangleMeshShape>(body->triangles.get(), true);
    constexpr btScalar kFirst = 1.f / 64;  // of the bounds
    const btVector3 size = body->shape->getLocalAabbMax() - body->shape->getLocalAabbMin();
    body->first_reach = std::max(kFirst * size.length(), SIMD_EPSILON);
    return body.release();
  } catch (const std::exception& thrown) {
    std::snprintf(error, 256, "%s", thrown.what());
    return nullptr;
  }
}

void unload(void* body) {
  delete static_cast<Body*>(body);
}

void reset(void* of) {
  static_cast<Body*>(of)->has_last = false;
}

void step(void* of, const double hip_m[3], fdcg_rival_result* result) {
  Body& body = *static_cast<Body*>(of);
  const btVector3 hip = vector_of(hip_m);
  constexpr btScalar kRounding = 1e-6f;  // the last answer itself is found again
  Nearest nearest(hip, hip);
  btScalar reach = body.has_last ? (hip - body.last).length() * (1 + kRounding) + kRounding : body.first_reach;
  for (bool is_found = false; !is_found; reach *= 2) {  // of the first tick: until the nearest in the box is within its ball
    const btVector3 half(reach, reach, reach);
    body.shape->processAllTriangles(&nearest, hip - half, hip + half);
    is_found = nearest.distance() <= reach;
  }
  body.last = nearest.point();
  body.has_last = true;
  for (int k = 0; k < 3; ++k) {
    const double offset = nearest.is_inside() ? double{nearest.point()[k]} - hip_m[k] : 0;
    result->god_object_m[k] = hip_m[k] + offset;
    result->force_n[k] = body.stiffness_n_per_m * offset;
  }
  result->is_in_contact = nearest.is_inside();
  result->reserved = 0;
}

uint64_t memory(const void* of) {
  const Body& body = *static_cast<const Body*>(of);
  return body.points.size() * sizeof(btVector3) + body.corners.size() * sizeof(int) +
         const_cast<btBvhTriangleMeshShape&>(*body.shape).getOptimizedBvh()->calculateSerializeBufferSize();
}

#define FDCG_TEXT(number) #number
#define FDCG_TEXT_OF(macro) FDCG_TEXT(macro)
constexpr fdcg_rival kRival = {
    FDCG_RIVAL_ABI, 0,    "bullet_closest", "closest_point", "f32", "Bullet " FDCG_TEXT_OF(BT_BULLET_VERSION), load, unload,
    reset,          step, memory,           nullptr};

}  // namespace

const fdcg_rival* fdcg_rival_get(uint32_t abi) {
  return abi == FDCG_RIVAL_ABI ? &kRival : nullptr;
}
