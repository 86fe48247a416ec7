// SPDX-License-Identifier: Apache-2.0
#include "smooth_shape.hpp"

#include <cmath>

#include "laws.hpp"

namespace fdcg::test {
namespace {

using std::cos;
using std::sin;
using std::sqrt;
constexpr long double kSize = kObject_m;
constexpr long double kPitch = 0.37L;  // of waves across the way: no multiple of a turn

class Sphere final : public SmoothShape {
 public:
  std::string name() const override { return "sphere"; }
  SurfacePoint curve(long double t) const override {
    const long double latitude = 0.9L * sin(kPitch * t);
    const SmoothPoint n = {cos(latitude) * cos(t), cos(latitude) * sin(t), sin(latitude)};
    return {n * kSize, n};
  }
  long double distance(const SmoothPoint& x) const override { return length(x) - kSize; }
  double curvature_radius_m() const override { return kObject_m; }
  PolygonSoup tessellated(int level) const override { return scaled(geodesic_sphere(2 << level), kObject_m); }
};

class Cylinder final : public SmoothShape {
 public:
  std::string name() const override { return "cylinder"; }
  SurfacePoint curve(long double t) const override {
    const SmoothPoint n = {cos(t), sin(t), 0};
    return {n * kSize + SmoothPoint{0, 0, 0.4L * kSize * sin(kPitch * t)}, n};
  }
  long double distance(const SmoothPoint& x) const override { return sqrt(x.x * x.x + x.y * x.y) - kSize; }
  double curvature_radius_m() const override { return kObject_m; }
  PolygonSoup tessellated(int level) const override { return scaled(prism(8 << level), kObject_m); }
};

class Torus final : public SmoothShape {
 public:
  std::string name() const override { return "torus"; }
  SurfacePoint curve(long double t) const override {
    const long double across = 2.6L * t;  // round the tube, inside of the ring too
    const SmoothPoint ring = {cos(t), sin(t), 0}, n = ring * cos(across) + SmoothPoint{0, 0, sin(across)};
    return {ring * kRing + n * kTube, n};
  }
  long double distance(const SmoothPoint& x) const override {
    const long double off = sqrt(x.x * x.x + x.y * x.y) - kRing;
    return sqrt(off * off + x.z * x.z) - kTube;
  }
  double curvature_radius_m() const override { return static_cast<double>(kTube); }
  PolygonSoup tessellated(int level) const override {
    return scaled(torus(8 << level, 4 << level, static_cast<double>(kTube / kRing)), static_cast<double>(kRing));
  }

 private:
  static constexpr long double kRing = kSize / 1.4L, kTube = 0.4L * kRing;
};

// Apex at z = size over a floor of the radius `size` at z = -size.
class Cone final : public SmoothShape {
 public:
  std::string name() const override { return "cone"; }
  SurfacePoint curve(long double t) const override {
    const long double z = kSize * (-0.1L + 0.3L * sin(kPitch * t)), radius = (kSize - z) / 2;
    const SmoothPoint out = {cos(t), sin(t), 0};
    return {out * radius + SmoothPoint{0, 0, z}, (out * 2 + SmoothPoint{0, 0, 1}) * (1 / sqrt(5.0L))};
  }
  long double distance(const SmoothPoint& x) const override {
    return (2 * sqrt(x.x * x.x + x.y * x.y) + x.z - kSize) / sqrt(5.0L);
  }
  double curvature_radius_m() const override { return 0.4 * kObject_m; }  // at z = 0.2 of the size
  PolygonSoup tessellated(int level) const override { return scaled(cone(8 << level), kObject_m); }
};

}  // namespace

std::vector<const SmoothShape*> smooth_shapes() {
  static const Sphere sphere;
  static const Cylinder cylinder;
  static const Torus torus;
  static const Cone cone;
  return {&sphere, &cylinder, &torus, &cone};
}

}  // namespace fdcg::test
