// SPDX-License-Identifier: Apache-2.0
#include "embree_scene.hpp"

#include <limits>
#include <stdexcept>

namespace fdcg::test {

using namespace plain;

namespace {

struct Vec3f {
  float x, y, z;
  friend Vec3f operator+(const Vec3f& a, const Vec3f& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3f operator-(const Vec3f& a, const Vec3f& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3f operator*(const Vec3f& a, float s) { return {a.x * s, a.y * s, a.z * s}; }
};
float dot(const Vec3f& a, const Vec3f& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Ericson (2005), 5.1.5, in float.
Vec3f nearest_in_float(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3f ab = b - a, ac = c - a, ap = p - a;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3f bp = p - b;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const Vec3f cp = p - c;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const float scale = 1 / (va + vb + vc);
  return a + ab * (vb * scale) + ac * (vc * scale);
}

struct Search {
  const EmbreeScene* scene;
  EmbreeScene::Nearest best;
};

}  // namespace

EmbreeScene::EmbreeScene(const bake::PolygonSoup& soup) {
  device_ = rtcNewDevice("threads=1,user_threads=1");
  if (device_ == nullptr) throw std::runtime_error("Embree cannot be started");
  const auto count = [](void* sum, ssize_t bytes, bool) {
    *static_cast<std::size_t*>(sum) += static_cast<std::size_t>(bytes);
    return true;
  };
  rtcSetDeviceMemoryMonitorFunction(device_, count, &embree_bytes_);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  vertices_ = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), soup.points.size()));
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    const bake::Vec3& p = soup.points[i];
    points_.push_back({p.x, p.y, p.z});
    for (std::size_t k = 0; k < 3; ++k)
      vertices_[3 * i + k] = static_cast<float>(points_.back()[k]);
  }
  const std::size_t count_of_triangles = soup.corners.size() - 2 * soup.face_count();
  triangles_ = static_cast<Triangle*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), count_of_triangles));
  for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f], last = soup.face_first[f + 1];
    for (std::uint32_t k = first + 1; k + 1 < last; ++k) {
      const Triangle triangle = {{soup.corners[first], soup.corners[k], soup.corners[k + 1]}};
      const Point &a = points_[triangle.corner[0]], &b = points_[triangle.corner[1]], &c = points_[triangle.corner[2]];
      triangles_[faces_.size()] = triangle;
      faces_.push_back(f);
      normals_.push_back(unit(cross(b - a, c - a)));
    }
  }
  rtcSetGeometryPointQueryFunction(geometry, look);
  rtcCommitGeometry(geometry);
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error(soup.name + ": Embree refuses it");
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcSetDeviceMemoryMonitorFunction(device_, nullptr, nullptr);
  rtcReleaseDevice(device_);
}

Point EmbreeScene::corner(std::uint32_t triangle) const {
  return points_[triangles_[triangle].corner[0]];
}

double EmbreeScene::distance(std::uint32_t triangle, const Point& point) const {
  const std::uint32_t* c = triangles_[triangle].corner;
  return length(point - nearest_on_triangle(point, points_[c[0]], points_[c[1]], points_[c[2]]).point);
}

std::size_t EmbreeScene::bytes() const {
  return embree_bytes_ + normals_.size() * sizeof normals_[0];
}

bool EmbreeScene::look(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const Triangle& triangle = search.scene->triangles_[arguments->primID];
  const auto at = [&](std::size_t k) {
    const float* v = search.scene->vertices_ + 3 * std::size_t{triangle.corner[k]};
    return Vec3f{v[0], v[1], v[2]};
  };
  const Vec3f p = {arguments->query->x, arguments->query->y, arguments->query->z};
  const Vec3f q = nearest_in_float(p, at(0), at(1), at(2));
  const float d2 = dot(q - p, q - p), radius = arguments->query->radius;
  if (!(d2 < radius * radius)) return false;
  arguments->query->radius = std::sqrt(d2);
  search.best = {{q.x, q.y, q.z}, arguments->primID};
  return true;
}

EmbreeScene::Nearest EmbreeScene::nearest(const Point& point, float radius) const {
  RTCPointQuery query;
  query.x = static_cast<float>(point[0]);
  query.y = static_cast<float>(point[1]);
  query.z = static_cast<float>(point[2]);
  query.time = 0;
  query.radius = radius;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  Search search{this, {}};
  rtcPointQuery(scene_, &query, &context, nullptr, &search);
  return search.best;
}

EmbreeScene::Hit EmbreeScene::cast(const Point& from, const Point& to) const {
  RTCRayHit ray;
#if RTC_VERSION_MAJOR < 4
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
#endif
  const Point way = to - from;
  ray.ray.org_x = static_cast<float>(from[0]);
  ray.ray.org_y = static_cast<float>(from[1]);
  ray.ray.org_z = static_cast<float>(from[2]);
  ray.ray.dir_x = static_cast<float>(way[0]);
  ray.ray.dir_y = static_cast<float>(way[1]);
  ray.ray.dir_z = static_cast<float>(way[2]);
  ray.ray.tnear = 0;
  ray.ray.tfar = 1;
  ray.ray.time = 0;
  ray.ray.mask = ~0u;
  ray.ray.flags = 0;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  Hit hit;
  // a face met from behind is passed through: the ray goes on after it
  for (int behind = 0; behind < 16; ++behind) {
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.ray.tfar = 1;
#if RTC_VERSION_MAJOR < 4
    rtcIntersect1(scene_, &context, &ray);
#else
    rtcIntersect1(scene_, &ray);
#endif
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    if (plain::dot(way, normals_[ray.hit.primID]) < 0) return {ray.ray.tfar, ray.hit.primID};
    ray.ray.tnear = std::nextafter(ray.ray.tfar, 2.0f);
  }
  return hit;
}

}  // namespace fdcg::test
