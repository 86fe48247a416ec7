// SPDX-License-Identifier: Apache-2.0
// nesting_depths of patches.hpp: exact ray casting with a bounding volume hierarchy.
#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

#include "exact/exact.hpp"
#include "topology/patches.hpp"

namespace fdcg::bake {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Rays run along +x: only a box's projection onto the yz plane and its upper x matter.
struct Shadow {
  double y0 = kInfinity, y1 = -kInfinity, z0 = kInfinity, z1 = -kInfinity, x1 = -kInfinity;

  void add(const Vec3& p) {
    y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    z0 = std::min(z0, p.z), z1 = std::max(z1, p.z);
    x1 = std::max(x1, p.x);
  }
  void add(const Shadow& s) {
    y0 = std::min(y0, s.y0), y1 = std::max(y1, s.y1);
    z0 = std::min(z0, s.z0), z1 = std::max(z1, s.z1);
    x1 = std::max(x1, s.x1);
  }
  [[nodiscard]] bool may_meet_ray_from(const Vec3& p) const {
    return p.y >= y0 && p.y <= y1 && p.z >= z0 && p.z <= z1 && p.x <= x1;
  }
};

std::uint32_t interleave(std::uint32_t y, std::uint32_t z) {
  const auto spread = [](std::uint32_t v) {
    v = (v | v << 8) & 0x00FF00FFU;
    v = (v | v << 4) & 0x0F0F0F0FU;
    v = (v | v << 2) & 0x33333333U;
    return (v | v << 1) & 0x55555555U;
  };
  return spread(y) | spread(z) << 1;
}

enum class Hit { none, crossed, touched };

// On which side of the line a -> b the point p lies in the yz plane, +1 to its left. A point on the line is moved by
// (epsilon, epsilon^2), the same for every line: 0 only where a and b coincide in that plane.
int side_of(const Vec3& a, const Vec3& b, const Vec3& p) {
  const int sign = exact::orient2d(a, b, p, 0);
  if (sign != 0) return sign;
  if (a.z != b.z) return a.z > b.z ? 1 : -1;
  return b.y > a.y ? 1 : b.y < a.y ? -1 : 0;
}

// Whether p lies on the triangle, its edges and corners included. Not called for degenerate triangles, which are covered by
// their neighbours.
bool is_on(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const auto is_between = [](double x, double u, double v, double w) {
    return x >= std::min({u, v, w}) && x <= std::max({u, v, w});
  };
  if (!is_between(p.x, a.x, b.x, c.x) || !is_between(p.y, a.y, b.y, c.y) || !is_between(p.z, a.z, b.z, c.z)) return false;
  if (exact::orient3d(a, b, c, p) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int sign = exact::orient2d(a, b, c, axis);
    if (sign == 0) continue;
    return exact::orient2d(a, b, p, axis) * sign >= 0 && exact::orient2d(b, c, p, axis) * sign >= 0 &&
           exact::orient2d(c, a, p, axis) * sign >= 0;
  }
  return false;
}

Hit cast(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  if (is_on(a, b, c, p)) return Hit::touched;
  const int side = side_of(a, b, p);
  if (side == 0 || side_of(b, c, p) != side || side_of(c, a, p) != side) return Hit::none;
  return exact::orient3d(a, b, c, p) == side ? Hit::none : Hit::crossed;  // `side` is the sign of the normal's x
}

// The faces of all enclosing patches in a binary tree of boxes, in the order of a space-filling curve.
class RayTree {
 public:
  RayTree(const Mesh& mesh, const Patches& patches) : mesh_(mesh), patches_(patches) {
    sort_faces();
    std::vector<Shadow> level((faces_.size() + kLeaf - 1) / kLeaf);
    for (std::size_t i = 0; i < faces_.size(); ++i)
      level[i / kLeaf].add(shadow_of(faces_[i]));
    levels_.push_back(std::move(level));
    while (levels_.back().size() > 1) {
      const std::vector<Shadow>& below = levels_.back();
      std::vector<Shadow> above((below.size() + 1) / 2);
      for (std::size_t i = 0; i < below.size(); ++i)
        above[i / 2].add(below[i]);
      levels_.push_back(std::move(above));
    }
  }

  // The number of enclosing patches other than `own` around p; none if p lies on one and `skip_touched` is not set.
  [[nodiscard]] std::optional<std::uint32_t> depth(const Vec3& p, std::uint32_t own, bool skip_touched) {
    crossed_.clear();
    touched_.clear();
    stack_.assign(1, {levels_.size() - 1, 0});
    while (!stack_.empty()) {
      const auto [level, box] = stack_.back();
      stack_.pop_back();
      if (!levels_[level][box].may_meet_ray_from(p)) continue;
      if (level > 0) {
        stack_.emplace_back(level - 1, 2 * box);
        if (2 * box + 1 < levels_[level - 1].size()) stack_.emplace_back(level - 1, 2 * box + 1);
        continue;
      }
      for (std::size_t i = box * kLeaf; i < std::min(faces_.size(), (box + 1) * kLeaf); ++i) {
        if (!cast_at_face(faces_[i], p, own, skip_touched)) return std::nullopt;
      }
    }
    return count_odd();
  }

 private:
  static constexpr std::size_t kLeaf = 4;

  [[nodiscard]] Shadow shadow_of(std::uint32_t f) const {
    Shadow shadow;
    for (std::uint32_t h = mesh_.face_first[f]; h < mesh_.face_first[f + 1]; ++h)
      shadow.add(mesh_.points[+mesh_.corners[h]]);
    return shadow;
  }

  void sort_faces() {
    Shadow all;
    for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
      if (patches_.of_face[f] == kNone || !patches_.patches[patches_.of_face[f]].encloses()) continue;
      faces_.push_back(f);
      all.add(shadow_of(f));
    }
    const auto cell = [](double x, double low, double high) {
      const double t = (x - low) / (high - low);  // NaN where the mesh has no width
      return t > 0 && t < 1 ? static_cast<std::uint32_t>(t * 65535) : 0U;
    };
    std::vector<std::uint64_t> keys;
    keys.reserve(faces_.size());
    for (const std::uint32_t f : faces_) {
      const Shadow s = shadow_of(f);
      const std::uint32_t code =
          interleave(cell(s.y0 / 2 + s.y1 / 2, all.y0, all.y1), cell(s.z0 / 2 + s.z1 / 2, all.z0, all.z1));
      keys.push_back(std::uint64_t{code} << 32 | f);
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size(); ++i)
      faces_[i] = static_cast<std::uint32_t>(keys[i]);
  }

  // False if p lies on the face and skip_touched is not set.
  bool cast_at_face(std::uint32_t f, const Vec3& p, std::uint32_t own, bool skip_touched) {
    if (patches_.of_face[f] == own) return true;
    const auto point = [&](std::uint32_t h) -> const Vec3& { return mesh_.points[+mesh_.corners[h]]; };
    const std::uint32_t first = mesh_.face_first[f];
    for (std::uint32_t h = first + 1; h + 1 < mesh_.face_first[f + 1]; ++h) {
      const Hit hit = cast(point(first), point(h), point(h + 1), p);
      if (hit == Hit::touched && !skip_touched) return false;
      if (hit == Hit::touched) touched_.push_back(patches_.of_face[f]);
      if (hit == Hit::crossed) crossed_.push_back(patches_.of_face[f]);
    }
    return true;
  }

  [[nodiscard]] std::uint32_t count_odd() {
    std::sort(crossed_.begin(), crossed_.end());
    std::uint32_t depth = 0;
    for (std::size_t i = 0; i < crossed_.size();) {
      const std::size_t begin = i;
      while (i < crossed_.size() && crossed_[i] == crossed_[begin])
        ++i;
      const bool is_touched = std::find(touched_.begin(), touched_.end(), crossed_[begin]) != touched_.end();
      depth += is_touched ? 0 : (i - begin) % 2;
    }
    return depth;
  }

  const Mesh& mesh_;
  const Patches& patches_;
  std::vector<std::uint32_t> faces_;
  std::vector<std::vector<Shadow>> levels_;  // [0]: one box for every kLeaf faces
  std::vector<std::pair<std::size_t, std::size_t>> stack_;
  std::vector<std::uint32_t> crossed_;  // the patch of each crossing
  std::vector<std::uint32_t> touched_;  // patches that p lies on, where those are skipped
};

}  // namespace

std::vector<std::uint32_t> nesting_depths(const Mesh& mesh, const Patches& patches, const std::vector<std::uint32_t>& asked) {
  // Touching patches share a few vertices only; just coinciding surfaces could use up the tries.
  constexpr std::uint32_t kTries = 64;
  RayTree tree(mesh, patches);
  std::vector<std::uint32_t> position(patches.patches.size(), kNone);  // in `asked`
  for (std::uint32_t i = 0; i < asked.size(); ++i)
    position[asked[i]] = i;
  struct State {
    std::uint32_t tries = 0;
    std::optional<std::uint32_t> depth;
  };
  std::vector<State> states(asked.size());
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t own = patches.of_face[f];
    if (own == kNone || position[own] == kNone) continue;
    State& state = states[position[own]];
    for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1] && !state.depth && state.tries < kTries; ++h) {
      ++state.tries;
      state.depth = tree.depth(mesh.points[+mesh.corners[h]], own, false);
    }
  }
  std::vector<std::uint32_t> depths;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const FaceId face = patches.patches[asked[i]].first_face;
    const Vec3& p = mesh.points[+mesh.corners[mesh.face_first[+face]]];
    depths.push_back(states[i].depth ? *states[i].depth : tree.depth(p, asked[i], true).value());
  }
  return depths;
}

}  // namespace fdcg::bake
