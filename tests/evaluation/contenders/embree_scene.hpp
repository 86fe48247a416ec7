// SPDX-License-Identifier: Apache-2.0
// A body in Embree, version 3 or 4: triangles in float, one thread.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fdcg/bake.hpp"
#include "point.hpp"

namespace fdcg::test {

class EmbreeScene {
 public:
  explicit EmbreeScene(const bake::PolygonSoup& soup);  // faces cut into fans of triangles, in order
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  struct Nearest {
    float point[3];
    std::uint32_t triangle = kNone;  // none within the radius
  };
  [[nodiscard]] Nearest nearest(const plain::Point& point, float radius) const;

  struct Hit {
    float part = 1;                  // of the way
    std::uint32_t triangle = kNone;  // none met
  };
  // The first triangle met from its front between two points.
  [[nodiscard]] Hit cast(const plain::Point& from, const plain::Point& to) const;

  // Unit normal, in double from the soup's points, and a point of its plane.
  [[nodiscard]] const plain::Point& normal(std::uint32_t triangle) const { return normals_[triangle]; }
  [[nodiscard]] plain::Point corner(std::uint32_t triangle) const;
  // From a point, in double.
  [[nodiscard]] double distance(std::uint32_t triangle, const plain::Point& point) const;
  [[nodiscard]] std::uint32_t face(std::uint32_t triangle) const { return faces_[triangle]; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Triangle {
    std::uint32_t corner[3];
  };
  static bool look(RTCPointQueryFunctionArguments* arguments);

  std::vector<plain::Point> normals_, points_;
  std::vector<std::uint32_t> faces_;
  Triangle* triangles_ = nullptr;  // Embree's own buffers
  float* vertices_ = nullptr;      // three each
  std::size_t embree_bytes_ = 0;   // as Embree's memory monitor counted them
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace fdcg::test
