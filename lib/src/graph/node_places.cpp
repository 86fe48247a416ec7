// SPDX-License-Identifier: Apache-2.0
#include "graph/node_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/vec3.hpp"
#include "graph/source_corners.hpp"

namespace fdcg::bake {
namespace {

constexpr double kTexelShare = 1.0 / 64;        // what a linear function may be off by
constexpr double kCoordinateSpacing = 0x1p-22;  // of texture coordinates, which are floats: four of their roundings
constexpr double kSamePlace = 1e-3;             // of a triangle's longest side: a corner so near is its source's

using Place = std::array<double, 2>;

Place on_image(const HeightImage& image, const std::array<float, 2>& uv) {
  const double u = double{uv[0]}, v = double{uv[1]};
  const auto& p = image.placing;
  return {p[0] * u + p[1] * v + p[2], p[3] * u + p[4] * v + p[5]};
}

// image_k = at_middle[k] + per_unit[k] . (x - middle)
struct Linear {
  Vec3 middle;
  Place at_middle{};
  std::array<Vec3, 2> per_unit{};

  [[nodiscard]] double operator()(const Vec3& x, std::size_t k) const { return at_middle[k] + dot(per_unit[k], x - middle); }
};

class Placer {
 public:
  Placer(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face, const Triangulation& cut)
      : look_(soup.appearance),
        uv_(look_.height_uv.empty() ? look_.uv : look_.height_uv),
        soup_(soup),
        cut_(cut),
        corners_(soup, source_face, cut) {
    image_.resize(cut.mesh.face_count());
    place_.resize(cut.mesh.corners.size());
    for (std::uint32_t t = 0; t < image_.size(); ++t)
      image_[t] = read(t);
  }

  [[nodiscard]] std::uint32_t image_of(std::uint32_t triangle) const { return image_[triangle]; }
  [[nodiscard]] const Vec3& point(std::uint32_t slot) const { return cut_.mesh.points[+cut_.mesh.corners[slot]]; }

  // Through the three corners.
  [[nodiscard]] Linear of_triangle(std::uint32_t t) const {
    const Vec3 a = point(3 * t), along = point(3 * t + 1) - a, across = point(3 * t + 2) - a, normal = cross(along, across);
    Linear linear;
    linear.middle = a;
    linear.at_middle = place_[3 * t];
    for (std::size_t k = 0; k < 2; ++k) {
      const double first = place_[3 * t + 1][k] - place_[3 * t][k], second = place_[3 * t + 2][k] - place_[3 * t][k];
      linear.per_unit[k] = (1 / squared_length(normal)) * (first * cross(across, normal) + second * cross(normal, along));
    }
    return linear;
  }

  // Nearest to all corners of these triangles, in a plane; false: it is off by more than it may be.
  bool fit(const std::vector<std::uint32_t>& triangles, const Vec3& normal, Linear& linear) const {
    const Vec3 side = std::fabs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 across = cross(normal, side), a = (1 / length(across)) * across, b = cross(normal, a);
    const double weight = 1.0 / (3 * static_cast<double>(triangles.size()));
    linear = {};
    for_slots(triangles, [&](std::uint32_t slot) {
      linear.middle = linear.middle + weight * point(slot);
      for (std::size_t k = 0; k < 2; ++k)
        linear.at_middle[k] += weight * place_[slot][k];
    });
    double aa = 0, ab = 0, bb = 0;
    Place a_of{}, b_of{};
    for_slots(triangles, [&](std::uint32_t slot) {
      const Vec3 off = point(slot) - linear.middle;
      const double x = dot(a, off), y = dot(b, off);
      aa += x * x, ab += x * y, bb += y * y;
      for (std::size_t k = 0; k < 2; ++k) {
        a_of[k] += x * (place_[slot][k] - linear.at_middle[k]);
        b_of[k] += y * (place_[slot][k] - linear.at_middle[k]);
      }
    });
    const double scale = 1 / (aa * bb - ab * ab);
    for (std::size_t k = 0; k < 2; ++k)
      linear.per_unit[k] = scale * ((bb * a_of[k] - ab * b_of[k]) * a + (aa * b_of[k] - ab * a_of[k]) * b);
    bool is_near = true;
    for_slots(triangles, [&](std::uint32_t slot) { is_near = is_near && agrees(linear, slot); });
    return is_near;
  }

  // As the file has it. Beyond its numbers' range: flat.
  [[nodiscard]] fdcg_node_place record(const Linear& linear, std::uint32_t image) const {
    constexpr double kFarthestImage = 1e6, kSteepestImage = 1e12;  // fdcg_get_heights
    fdcg_node_place place = kFlatPlace;
    for (std::size_t k = 0; k < 2; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const double exact = component(linear.per_unit[k], axis);
        if (!(std::fabs(exact) < kSteepestImage / 2)) return kFlatPlace;
        place.per_unit[k][axis] = static_cast<float>(exact) + 0.0f;
      }
      const Vec3 rounded = {double{place.per_unit[k][0]}, double{place.per_unit[k][1]}, double{place.per_unit[k][2]}};
      double at = linear.at_middle[k];
      const HeightImage::Wrap wrap = look_.images[image].wrap[k];
      if (wrap == HeightImage::Wrap::repeat) at -= std::floor(at);
      if (wrap == HeightImage::Wrap::mirror) at -= 2 * std::floor(at / 2);
      place.offset[k] = at - dot(rounded, linear.middle);
      if (!(std::fabs(place.offset[k]) <= kFarthestImage)) return kFlatPlace;
    }
    place.map = image;
    return place;
  }

 private:
  template <class Do>
  static void for_slots(const std::vector<std::uint32_t>& triangles, const Do& action) {
    for (const std::uint32_t t : triangles)
      for (std::uint32_t slot = 3 * t; slot < 3 * t + 3; ++slot)
        action(slot);
  }
  [[nodiscard]] bool agrees(const Linear& linear, std::uint32_t slot) const {
    const HeightImage& image = look_.images[image_[slot / 3]];
    const double sides[2] = {static_cast<double>(image.width), static_cast<double>(image.height)};
    for (std::size_t k = 0; k < 2; ++k) {
      const double given = place_[slot][k];
      const double allowed = std::max(kTexelShare / sides[k], kCoordinateSpacing * std::fabs(given));
      if (!(std::fabs(linear(point(slot), k) - given) <= allowed)) return false;
    }
    return true;
  }
  // The image of a triangle, and where its corners are; kNone: it is on none.
  std::uint32_t read(std::uint32_t t) {
    const std::uint32_t face = corners_.face_of(t);
    if (face == kNone || uv_.empty()) return kNone;
    std::uint16_t image = look_.all_heights;
    if (image == LookMaterial::kNoImage && face < look_.face_material.size() &&
        look_.face_material[face] < look_.materials.size())
      image = look_.materials[look_.face_material[face]].heights;
    if (image >= look_.images.size()) return kNone;
    const double side2 =
        std::max({squared_length(point(3 * t) - point(3 * t + 1)), squared_length(point(3 * t + 1) - point(3 * t + 2)),
                  squared_length(point(3 * t + 2) - point(3 * t))});
    for (std::uint32_t slot = 3 * t; slot < 3 * t + 3; ++slot) {
      const std::uint32_t corner = corners_.at(slot);
      if (corner == kNone || !std::isfinite(uv_[corner][0]) || !std::isfinite(uv_[corner][1])) return kNone;
      const Vec3 off = soup_.points[soup_.corners[corner]] - (point(slot) + cut_.mesh.origin);
      if (!(squared_length(off) <= kSamePlace * kSamePlace * side2)) return kNone;
      place_[slot] = on_image(look_.images[image], uv_[corner]);
    }
    return image;
  }

  const Appearance& look_;
  const std::vector<std::array<float, 2>>& uv_;
  const PolygonSoup& soup_;
  const Triangulation& cut_;
  SourceCorners corners_;
  std::vector<std::uint32_t> image_;
  std::vector<Place> place_;  // of each slot
};

std::vector<std::vector<std::uint32_t>> members_of(const Regions& regions) {
  std::vector<std::vector<std::uint32_t>> members(regions.list.size());
  for (std::uint32_t t = 0; t < regions.of_face.size(); ++t)
    if (regions.of_face[t] != kNone) members[regions.of_face[t]].push_back(t);
  return members;
}

void split(std::uint32_t region, const std::vector<std::uint32_t>& members, Regions& regions) {
  if (regions.list[region].whole == kNone) regions.list[region].whole = region;
  for (const std::uint32_t t : members) {
    regions.of_face[t] = static_cast<std::uint32_t>(regions.list.size());
    regions.list.push_back(regions.list[region]);
  }
}

}  // namespace

NodePlaces find_node_places(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face, const Triangulation& cut,
                            Regions& regions) {
  const Placer placer(soup, source_face, cut);
  NodePlaces places;
  places.of_face.assign(cut.mesh.face_count(), kFlatPlace);
  std::vector<std::uint8_t> is_placed(places.of_face.size(), 0);
  const std::vector<std::vector<std::uint32_t>> members = members_of(regions);
  for (std::uint32_t r = 0; r < members.size(); ++r) {
    if (members[r].empty()) continue;
    const std::uint32_t image = placer.image_of(members[r].front());
    const bool is_one =
        std::all_of(members[r].begin(), members[r].end(), [&](std::uint32_t t) { return placer.image_of(t) == image; });
    if (is_one && image == kNone) continue;
    Linear linear;
    if (!is_one || !placer.fit(members[r], regions.list[r].plane.normal, linear)) {
      split(r, members[r], regions);
      continue;
    }
    for (const std::uint32_t t : members[r]) {
      places.of_face[t] = placer.record(linear, image);
      is_placed[t] = 1;
    }
  }
  for (std::uint32_t t = 0; t < places.of_face.size(); ++t) {
    const std::uint32_t image = placer.image_of(t);
    if (image != kNone && is_placed[t] == 0) places.of_face[t] = placer.record(placer.of_triangle(t), image);
    places.on_maps += places.of_face[t].map != FDCG_NONE ? 1 : 0;
  }
  return places;
}

std::vector<fdcg_node_place> places_of_faces(const NodePlaces& places, const Merged& faces) {
  if (faces.face_of_triangle.empty()) return places.of_face;
  std::vector<fdcg_node_place> result(faces.mesh.face_count(), kFlatPlace);
  for (std::uint32_t t = 0; t < places.of_face.size(); ++t)
    if (faces.face_of_triangle[t] != kNone) result[faces.face_of_triangle[t]] = places.of_face[t];
  return result;
}

}  // namespace fdcg::bake
