// SPDX-License-Identifier: Apache-2.0
#include "graph/box_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "base/raw_array.hpp"
#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kLeaf = 4, kWidth = 8;       // nodes of a leaf, boxes of a record
constexpr std::size_t kSmallRun = kLeaf * kWidth;  // of a box of the lowest level
static_assert(kSmallRun == 32);
constexpr std::size_t kOrderGrain = 1u << 13;

constexpr float kMost = std::numeric_limits<float>::max();

struct FloatBox {
  std::array<float, 3> low{kMost, kMost, kMost}, high{-kMost, -kMost, -kMost};

  void add(const std::array<float, 3>& from, const std::array<float, 3>& to) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], from[axis]);
      high[axis] = std::max(high[axis], to[axis]);
    }
  }
  [[nodiscard]] float side(std::size_t axis) const { return high[axis] - low[axis]; }
  [[nodiscard]] float half_surface() const { return side(0) * side(1) + side(1) * side(2) + side(2) * side(0); }
};

// Of a face's box, twice.
struct Centre {
  std::array<float, 3> at;
  std::uint32_t face;
};

// Faces in numbers of which the mesh is one long: floats tell them apart wherever it lies and however large it is.
class FaceBoxes {
 public:
  explicit FaceBoxes(const Mesh& mesh) : mesh_(mesh), low_(mesh.points.front()) {
    Vec3 high = low_;
    for (const Vec3& p : mesh.points) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double size = largest_component(high - low_);
    scale_ = size > 0 ? 1 / size : 0;
  }

  [[nodiscard]] FloatBox box(std::uint32_t f) const {
    FloatBox box;
    for (std::uint32_t h = mesh_.face_first[f]; h < mesh_.face_first[f + 1]; ++h) {
      const Vec3 p = scale_ * (mesh_.points[+mesh_.corners[h]] - low_);
      const std::array<float, 3> at = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      box.add(at, at);
    }
    return box;
  }
  [[nodiscard]] Centre centre(std::uint32_t f) const {
    const FloatBox of = box(f);
    return {{of.low[0] + of.high[0], of.low[1] + of.high[1], of.low[2] + of.high[2]}, f};
  }

 private:
  const Mesh& mesh_;
  Vec3 low_;
  double scale_;
};

// How many nodes of a run of more than a leaf come into its first part: the multiple of what a box below holds that is next to
// the middle.
std::size_t first_part(std::size_t count) {
  std::size_t below = kLeaf;
  while (below * kWidth < count)
    below *= kWidth;
  return std::max(below, (count / 2 + below / 2) / below * below);
}

// Moves the lowest `first` along the axis before the others.
void part(std::span<Centre> run, std::size_t first, std::size_t axis) {
  std::nth_element(run.begin(), run.begin() + static_cast<std::ptrdiff_t>(first), run.end(),
                   [axis](const Centre& a, const Centre& b) {
                     return a.at[axis] < b.at[axis] || (a.at[axis] == b.at[axis] && a.face < b.face);
                   });
}

std::size_t longest_axis(std::span<const Centre> run) {
  FloatBox box;
  for (const Centre& c : run)
    box.add(c.at, c.at);
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (box.side(axis) > box.side(longest)) longest = axis;
  return longest;
}

// The faces of one box of the lowest level, as bits of a word.
class SmallRun {
 public:
  SmallRun(const FaceBoxes& boxes, std::span<Centre> run) : run_(run) {
    std::sort(run.begin(), run.end(), [](const Centre& a, const Centre& b) { return a.face < b.face; });
    for (std::uint32_t i = 0; i < run.size(); ++i) {
      centres_[i] = run[i];
      boxes_[i] = boxes.box(run[i].face);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto along = std::span(along_[axis]).first(run.size());
      std::iota(along.begin(), along.end(), std::uint8_t{0});
      std::sort(along.begin(), along.end(), [&](std::uint8_t a, std::uint8_t b) {
        return std::pair(centres_[a].at[axis], a) < std::pair(centres_[b].at[axis], b);
      });
    }
  }

  void order() { order((run_.size() == kSmallRun ? 0 : 1u << run_.size()) - 1u); }

 private:
  void order(std::uint32_t faces) {
    while (std::popcount(faces) > static_cast<int>(kLeaf)) {
      const std::uint32_t first = part(faces);
      order(first);
      faces &= ~first;
    }
    for (; faces != 0; faces &= faces - 1)
      run_[ordered_++] = centres_[static_cast<std::size_t>(std::countr_zero(faces))];
  }

  // The first part along the axis that leaves the boxes with the least surface.
  [[nodiscard]] std::uint32_t part(std::uint32_t faces) const {
    const std::size_t count = static_cast<std::size_t>(std::popcount(faces)), first = first_part(count);
    std::uint32_t best = 0;
    float least = kMost;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      FloatBox parts[2];
      std::uint32_t before = 0;
      for (std::size_t i = 0, met = 0; met < count; ++i) {
        const std::uint8_t face = along_[axis][i];
        if ((faces >> face & 1u) == 0) continue;
        parts[met < first ? 0 : 1].add(boxes_[face].low, boxes_[face].high);
        if (met < first) before |= 1u << face;
        ++met;
      }
      const float surface =
          parts[0].half_surface() * static_cast<float>(first) + parts[1].half_surface() * static_cast<float>(count - first);
      if (axis == 0 || surface < least) {
        least = surface;
        best = before;
      }
    }
    return best;
  }

  std::span<Centre> run_;
  std::size_t ordered_ = 0;
  std::array<Centre, kSmallRun> centres_;  // in order of their faces
  std::array<FloatBox, kSmallRun> boxes_;
  std::array<std::array<std::uint8_t, kSmallRun>, 3> along_;  // the faces in order along each axis
};

std::size_t split(std::span<Centre> run) {
  const std::size_t first = first_part(run.size());
  part(run, first, longest_axis(run));
  return first;
}

void order(const FaceBoxes& boxes, std::span<Centre> run) {
  while (run.size() > kSmallRun) {
    const std::size_t first = split(run);
    order(boxes, run.first(first));
    run = run.subspan(first);
  }
  SmallRun(boxes, run).order();
}

// Splits into parts that threads may order side by side; of a part too small for that the second is empty.
std::vector<std::span<Centre>> split_for_threads(std::span<Centre> run, unsigned jobs) {
  std::vector<std::span<Centre>> runs{run};
  while (runs.size() < 4u * jobs && run.size() / runs.size() > kOrderGrain) {
    std::vector<std::span<Centre>> parts(2 * runs.size());
    parallel_for(jobs, runs.size(), 1, [&](std::size_t i, std::size_t) {
      const std::size_t first = runs[i].size() > kSmallRun ? split(runs[i]) : runs[i].size();
      parts[2 * i] = runs[i].first(first);
      parts[2 * i + 1] = runs[i].subspan(first);
    });
    runs = std::move(parts);
  }
  return runs;
}

}  // namespace

void order_by_boxes(const Mesh& mesh, std::span<std::uint32_t> faces, unsigned jobs) {
  const FaceBoxes boxes(mesh);
  RawArray<Centre> centres(faces.size());
  parallel_for(jobs, faces.size(), kOrderGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      centres[i] = boxes.centre(faces[i]);
  });
  const std::vector<std::span<Centre>> runs = split_for_threads({centres.data(), centres.size()}, jobs);
  parallel_for(jobs, runs.size(), 1, [&](std::size_t i, std::size_t) { order(boxes, runs[i]); });
  std::transform(centres.begin(), centres.end(), faces.begin(), [](const Centre& centre) { return centre.face; });
}

}  // namespace fdcg::bake
