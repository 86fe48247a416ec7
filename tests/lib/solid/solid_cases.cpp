// SPDX-License-Identifier: Apache-2.0
#include "solid_cases.hpp"

namespace fdcg::test {
namespace {

constexpr double kPi = 3.14159265358979323846;
using bake::Vec3;

// The bottle as an immersion: a tube that passes through its own wall. It has no inside and outside, one side only.
Vec3 klein(double u, double v) {
  const double t = 2 * kPi * u, w = 2 * kPi * v, r = 1 - 0.5 * std::cos(t);
  if (t < kPi)
    return {1.5 * std::cos(t) * (1 + std::sin(t)) + r * std::cos(t) * std::cos(w),
            4 * std::sin(t) + r * std::sin(t) * std::cos(w), r * std::sin(w)};
  return {1.5 * std::cos(t) * (1 + std::sin(t)) + r * std::cos(w + kPi), 4 * std::sin(t), r * std::sin(w)};
}

// A tube along a closed curve that crosses itself: a figure of eight, whose two arms pass through each other.
Vec3 eight(double u, double v) {
  const double t = 2 * kPi * u, w = 2 * kPi * v;
  const Vec3 at{std::sin(t), std::sin(t) * std::cos(t), 0};
  const double dx = std::cos(t), dy = std::cos(2 * t), size = std::hypot(dx, dy);
  const double r = 0.125;
  return {at.x + r * std::cos(w) * -dy / size, at.y + r * std::cos(w) * dx / size, at.z + r * std::sin(w)};
}

SolidCase boxes(const std::string& name, double volume, const std::vector<std::pair<Vec3, Vec3>>& list,
                std::uint64_t components = 1) {
  SoupMaker maker;
  for (const auto& [low, high] : list)
    maker.box(low, high);
  return {maker.take(name), volume, components == 1 ? 1e-9 : 1e-5, components};  // solids that touch are moved apart
}

SolidCase turned_boxes() {
  SoupMaker maker;
  maker.box({0, 0, 0}, {1, 1, 1});
  maker.sheet(
      4, 1,
      [](double u, double v) {  // a prism of square section, turned about its long axis
        const double t = 2 * kPi * u + 0.3;
        return Vec3{0.5 + 0.25 * std::cos(t), 0.5 + 0.25 * std::sin(t), 3 * v - 1};
      },
      true, false);
  return {maker.take("a prism through a cube, open at its ends"), 1 + 2 * 0.125, 1e-9};
}

}  // namespace

std::vector<SolidCase> solid_cases() {
  std::vector<SolidCase> cases;
  cases.push_back(boxes("two cubes that cross", 2 - 0.125, {{{0, 0, 0}, {1, 1, 1}}, {{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}}}));
  cases.push_back(boxes("a cube in a cube", 27, {{{0, 0, 0}, {3, 3, 3}}, {{1, 1, 1}, {2, 2, 2}}}));
  cases.push_back(boxes("cubes with sides in one plane", 1.5, {{{0, 0, 0}, {1, 1, 1}}, {{0.5, 0, 0}, {1.5, 1, 1}}}));
  cases.push_back(boxes("a block on a block", 1.125, {{{0, 0, 0}, {1, 1, 1}}, {{0.25, 0.25, 1}, {0.75, 0.75, 1.5}}}));
  cases.push_back(boxes("a block flush in a corner of a block", 1, {{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {0.5, 0.5, 0.5}}}));
  cases.push_back(
      boxes("three equal cubes at one place", 1, {{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {1, 1, 1}}}));
  cases.push_back(boxes("cubes that share an edge", 2, {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 0}, {2, 2, 1}}}, 2));
  cases.push_back(boxes("cubes that share a corner", 2, {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}}, 2));
  cases.push_back(boxes("decimal cubes in a row", 0.1 * 0.1 * 0.3,
                        {{{0, 0, 0}, {0.1, 0.1, 0.1}}, {{0.1, 0, 0}, {0.2, 0.1, 0.1}}, {{0.2, 0, 0}, {0.3, 0.1, 0.1}}}));
  {
    SoupMaker maker;
    maker.box({0, 0, 0}, {3, 3, 3});
    maker.box({1, 1, 1}, {2, 2, 2}, 63, true);
    cases.push_back({maker.take("a cube with a cavity"), 26, 1e-9, 2});
  }
  {
    SoupMaker maker;
    maker.box({0, 0, 0}, {1, 1, 1}, 31);
    cases.push_back({maker.take("an open box"), 1, 1e-9});
  }
  {
    SoupMaker maker;
    maker.box({0, 0, 0}, {1, 1, 1}, 63, true);
    cases.push_back({maker.take("a cube inside out"), 1, 1e-9});
  }
  {
    SoupMaker maker;
    maker.sphere({0, 0, 0}, 1, 24, [](unsigned i, unsigned j) { return i > 4 || j < 8 || j > 13; });
    cases.push_back({maker.take("a sphere with a hole"), 4.0 / 3 * kPi, 0.03});
  }
  {
    SoupMaker maker;
    maker.sphere({0, 0, 0}, 1, 16);
    maker.sphere({0.7, 0.3, 0.1}, 0.8, 14);
    maker.sphere({0.7, 0.3, -0.4}, 0.5, 14);
    cases.push_back({maker.take("three spheres that cross"), 0, -1});
  }
  {
    SoupMaker maker;
    maker.sheet(48, 16, eight, true, true);
    cases.push_back({maker.take("a tube in a figure of eight"), 0, -1});
  }
  {
    SoupMaker maker;
    maker.sheet(48, 24, klein, true, true);
    cases.push_back({maker.take("a bottle of Klein"), 0, -1});
  }
  {
    SoupMaker maker;
    maker.box({0, 0, 0}, {1, 1, 1}, 16);
    cases.push_back({maker.take("a sheet"), 0});
  }
  {
    SoupMaker maker;
    maker.box({0, 0, 0}, {1, 1, 0});
    cases.push_back({maker.take("a box without thickness"), 0});
  }
  cases.push_back(turned_boxes());
  return cases;
}

}  // namespace fdcg::test
