// SPDX-License-Identifier: Apache-2.0
#include "graph/box_order.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <tuple>
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

FloatBox box_of(std::span<const Centre> run) {
  FloatBox box;
  for (const Centre& c : run)
    box.add(c.at, c.at);
  return box;
}

// Moves the `first` lowest along the box's longest side before the others. By counting in bins, without a branch that could not
// be predicted, down to the bin that is split itself. `scratch`: as long as the run.
void part(std::span<Centre> run, std::size_t first, std::span<Centre> scratch) {
  constexpr std::size_t kBins = 128, kWorthBins = 2 * kBins;
  const FloatBox box = box_of(run);
  std::size_t axis = 0;
  for (std::size_t other = 1; other < 3; ++other)
    if (box.side(other) > box.side(axis)) axis = other;
  const float from = box.low[axis], per_length = static_cast<float>(kBins) / box.side(axis);
  if (run.size() < kWorthBins || !(per_length < kMost)) return part(run, first, axis);
  const auto bin_of = [&](const Centre& c) {
    return std::min(static_cast<std::uint32_t>((c.at[axis] - from) * per_length), static_cast<std::uint32_t>(kBins - 1));
  };
  std::array<std::uint32_t, kBins> counts{};
  for (const Centre& c : run)
    ++counts[bin_of(c)];
  std::uint32_t cut = 0;
  std::size_t below = 0;
  for (; below + counts[cut] <= first; ++cut)
    below += counts[cut];
  std::array<std::size_t, 3> next = {0, below, below + counts[cut]};  // of those in lower bins, in this one, in higher ones
  for (const Centre& c : run) {
    const std::uint32_t bin = bin_of(c);
    scratch[next[static_cast<std::size_t>(bin >= cut) + static_cast<std::size_t>(bin > cut)]++] = c;
  }
  std::copy_n(scratch.begin(), run.size(), run.begin());
  part(run.subspan(below, counts[cut]), first - below, axis);
}

// The faces of one box of the lowest level.
class SmallRun {
 public:
  SmallRun(const FaceBoxes& boxes, std::span<Centre> run) : run_(run) {
    std::sort(run.begin(), run.end(), [](const Centre& a, const Centre& b) { return a.face < b.face; });
    for (std::uint32_t i = 0; i < run.size(); ++i) {
      centres_[i] = run[i];
      boxes_[i] = boxes.box(run[i].face);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      sort_along(axis);
  }

  void order() { order(0, run_.size()); }

 private:
  // By counting, for each, what comes before it: without a branch that could not be predicted.
  void sort_along(std::size_t axis) {
    const std::size_t count = run_.size();
    std::array<float, kSmallRun> at;
    for (std::size_t i = 0; i < kSmallRun; ++i)
      at[i] = i < count ? centres_[i].at[axis] : kMost;
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint32_t before = 0;
      for (std::uint32_t j = 0; j < kSmallRun; ++j)
        before += static_cast<std::uint32_t>(at[j] < at[i]) |
                  (static_cast<std::uint32_t>(at[j] == at[i]) & static_cast<std::uint32_t>(j < i));
      along_[axis][before] = static_cast<std::uint8_t>(i);
    }
  }

  // Those at `begin` and after along each axis: the same ones.
  void order(std::size_t begin, std::size_t count) {
    while (count > kLeaf) {
      const std::size_t first = first_part(count);
      part(begin, count, first);
      order(begin, first);
      begin += first;
      count -= first;
    }
    const auto leaf = along_[0].begin() + static_cast<std::ptrdiff_t>(begin);
    std::sort(leaf, leaf + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = begin; i < begin + count; ++i)
      run_[i] = centres_[along_[0][i]];
  }

  // Those of the first part before the others along every axis, each part in its order. It is cut along the axis that leaves
  // the boxes with the least surface.
  void part(std::size_t begin, std::size_t count, std::size_t first) {
    std::size_t best = 0;
    std::array<float, 3> surface;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t cut = begin + first, end = begin + count;
      surface[axis] = half_surface(axis, begin, cut) * static_cast<float>(first) +
                      half_surface(axis, cut, end) * static_cast<float>(count - first);
      if (surface[axis] < surface[best]) best = axis;
    }
    std::uint32_t is_first = 0;
    for (std::size_t i = begin; i < begin + first; ++i)
      is_first |= 1u << along_[best][i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis == best) continue;
      std::array<std::uint8_t, kSmallRun> parted;
      std::array<std::size_t, 2> next = {0, first};
      for (std::size_t i = begin; i < begin + count; ++i)
        parted[next[1 - (is_first >> along_[axis][i] & 1u)]++] = along_[axis][i];
      std::copy_n(parted.begin(), count, along_[axis].begin() + static_cast<std::ptrdiff_t>(begin));
    }
  }
  [[nodiscard]] float half_surface(std::size_t axis, std::size_t begin, std::size_t end) const {
    FloatBox box;
    for (std::size_t i = begin; i < end; ++i)
      box.add(boxes_[along_[axis][i]].low, boxes_[along_[axis][i]].high);
    return box.half_surface();
  }

  std::span<Centre> run_;
  std::array<Centre, kSmallRun> centres_;  // in order of their faces
  std::array<FloatBox, kSmallRun> boxes_;
  std::array<std::array<std::uint8_t, kSmallRun>, 3> along_;  // the faces in order along each axis
};

// A run of faces, and as much memory to move them about.
struct Run {
  std::span<Centre> faces, scratch;

  [[nodiscard]] std::pair<Run, Run> split_at(std::size_t first) const {
    return {{faces.first(first), scratch.first(first)}, {faces.subspan(first), scratch.subspan(first)}};
  }
};

std::pair<Run, Run> split(const Run& run) {
  const std::size_t first = first_part(run.faces.size());
  part(run.faces, first, run.scratch);
  return run.split_at(first);
}

void order(const FaceBoxes& boxes, Run run) {
  while (run.faces.size() > kSmallRun) {
    const auto [before, after] = split(run);
    order(boxes, before);
    run = after;
  }
  SmallRun(boxes, run.faces).order();
}

// Splits into parts that threads may order side by side; of a part too small for that the second is empty.
std::vector<Run> split_for_threads(Run run, unsigned jobs) {
  std::vector<Run> runs{run};
  while (runs.size() < 4u * jobs && run.faces.size() / runs.size() > kOrderGrain) {
    std::vector<Run> parts(2 * runs.size());
    parallel_for(jobs, runs.size(), 1, [&](std::size_t i, std::size_t) {
      std::tie(parts[2 * i], parts[2 * i + 1]) =
          runs[i].faces.size() > kSmallRun ? split(runs[i]) : runs[i].split_at(runs[i].faces.size());
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
  RawArray<Centre> scratch(faces.size());
  const std::vector<Run> runs = split_for_threads({{centres.data(), centres.size()}, {scratch.data(), scratch.size()}}, jobs);
  parallel_for(jobs, runs.size(), 1, [&](std::size_t i, std::size_t) { order(boxes, runs[i]); });
  std::transform(centres.begin(), centres.end(), faces.begin(), [](const Centre& centre) { return centre.face; });
}

}  // namespace fdcg::bake
