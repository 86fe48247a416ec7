// SPDX-License-Identifier: Apache-2.0
#include "import/ply_extras.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "base/srgb.hpp"

namespace fdcg::bake::ply {
namespace {

struct Name {
  std::string_view name;
  Role role;
};

// Roles of one kind: all of them, or none.
template <std::size_t kCount>
bool assign(ElementKind& vertex, const std::array<Name, kCount>& names) {
  std::array<Property*, kCount> found{};
  for (Property& property : vertex.properties) {
    for (std::size_t k = 0; k < kCount; ++k) {
      if (property.name != names[k].name) continue;
      if (found[k] != nullptr) return false;
      found[k] = &property;
    }
  }
  if (std::find(found.begin(), found.end(), nullptr) != found.end()) return false;
  for (std::size_t k = 0; k < kCount; ++k)
    found[k]->role = names[k].role;
  return true;
}

// Whole numbers are shares of the largest that their type has.
double share_in(Scalar type, double value) {
  switch (type) {
    case Scalar::u8:
      return value / 255;
    case Scalar::u16:
      return value / 65535;
    case Scalar::i8:
      return value / 127;
    case Scalar::i16:
      return value / 32767;
    default:
      return value;
  }
}

template <class Value>
void spread_to(const std::vector<Value>& of_vertices, const PolygonSoup& soup, std::vector<Value>& of_corners,
               const Value& none) {
  if (of_vertices.empty()) return;
  of_corners.resize(soup.corners.size(), none);
  for (std::size_t i = 0; i < soup.corners.size(); ++i)
    if (soup.corners[i] < of_vertices.size()) of_corners[i] = of_vertices[soup.corners[i]];
}

}  // namespace

void assign_extras(ElementKind& vertex, bool wants_normals, bool wants_appearance) {
  if (vertex.has_lists()) return;
  if (wants_normals) assign<3>(vertex, {{{"nx", Role::nx}, {"ny", Role::ny}, {"nz", Role::nz}}});
  if (!wants_appearance) return;
  if (assign<3>(vertex, {{{"red", Role::red}, {"green", Role::green}, {"blue", Role::blue}}}))
    assign<1>(vertex, {{{"alpha", Role::alpha}}});
  constexpr std::array<std::array<std::string_view, 2>, 4> kPlaces = {
      {{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texcoord_u", "texcoord_v"}}};
  for (const auto& [u, v] : kPlaces)
    if (assign<2>(vertex, {{{u, Role::u}, {v, Role::v}}})) return;
}

void VertexExtras::begin(const ElementKind& vertex) {
  const auto rows = static_cast<std::size_t>(vertex.count);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (const Property& property : vertex.properties) {
    if (property.role == Role::nx) normals_.resize(rows);
    if (property.role == Role::red) colours_.resize(rows, {1, 1, 1, 1});
    if (property.role == Role::u) uv_.resize(rows, {kNone, kNone});
  }
}

void VertexExtras::set(std::size_t row, const Property& property, double value) {
  const auto channel = static_cast<std::size_t>(property.role) - static_cast<std::size_t>(Role::red);
  switch (property.role) {
    case Role::nx:
    case Role::ny:
    case Role::nz:
      component_of(normals_[row], property.role) = value;
      break;
    case Role::red:
    case Role::green:
    case Role::blue:
      colours_[row][channel] = linear_of_srgb(share_in(property.value, value));
      break;
    case Role::alpha:
      colours_[row][channel] = share_of(share_in(property.value, value));
      break;
    case Role::u:
      uv_[row][0] = static_cast<float>(value);
      break;
    case Role::v:
      uv_[row][1] = static_cast<float>(1 - value);
      break;
    default:
      break;
  }
}

void VertexExtras::spread(PolygonSoup& soup) const {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  spread_to(normals_, soup, soup.corner_normals, Vec3{});
  spread_to(colours_, soup, soup.appearance.colours, Colour{1, 1, 1, 1});
  spread_to(uv_, soup, soup.appearance.uv, std::array<float, 2>{kNone, kNone});
}

}  // namespace fdcg::bake::ply
