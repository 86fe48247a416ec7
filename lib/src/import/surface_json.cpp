// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <string>

#include "fdcg/physics.hpp"

namespace fdcg::bake {
namespace {

std::string shortest_number(double value) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace

std::string surface_json(const StatedShape& shape) {
  std::string text = R"({"kind":")" + shape.kind + '"';
  if (shape.radius_m > 0 || shape.kind == "cone") text += R"(,"radius_m":)" + shortest_number(shape.radius_m);
  if (shape.kind == "cone") text += R"(,"top_radius_m":)" + shortest_number(shape.top_radius_m);
  if (shape.length_m > 0) text += R"(,"length_m":)" + shortest_number(shape.length_m);
  if (shape.kind == "box" || shape.kind == "ellipsoid")
    text += R"(,"half_m":[)" + shortest_number(shape.half_m[0]) + ',' + shortest_number(shape.half_m[1]) + ',' +
            shortest_number(shape.half_m[2]) + ']';
  return text + '}';
}

}  // namespace fdcg::bake
