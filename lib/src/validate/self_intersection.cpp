// SPDX-License-Identifier: Apache-2.0
#include "validate/self_intersection.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "base/parallel.hpp"
#include "base/vec3.hpp"
#include "exact/triangle_filter.hpp"
#include "topology/face_triangles.hpp"
#include "validate/box_pairs.hpp"
#include "validate/hub_boxes.hpp"
#include "validate/simple_stars.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kGrain = 4096;

// The pairs found so far by one thread, or by all. On triangle meshes each pair is found once; with polygons possibly several
// times (once per pair of triangles), so pairs are kept until duplicates are removed.
class Gathered {
 public:
  Gathered(std::size_t max_listed, bool is_plain) : max_listed_(max_listed), is_plain_(is_plain) {}

  void add(FaceId a, FaceId b, Contact contact) {
    ++added_;
    found_.listed.push_back({std::min(a, b), std::max(a, b), contact, {}});
    if (!is_plain_) return;
    count(contact);
    if (max_listed_ < kAllElements / 2 && found_.listed.size() >= 2 * max_listed_ + kSlack) shorten();
  }
  // Pairs of triangles.
  [[nodiscard]] std::uint64_t added() const { return added_; }
  [[nodiscard]] bool is_full() const { return added_ >= kMostMeetingPairs; }
  void add(const Gathered& other) {
    added_ += other.added_;
    found_.crossing += other.found_.crossing;
    found_.touching += other.found_.touching;
    found_.listed.insert(found_.listed.end(), other.found_.listed.begin(), other.found_.listed.end());
    if (is_plain_) shorten();
  }
  SelfIntersections finish() {
    std::vector<MeetingFaces>& pairs = found_.listed;
    std::sort(pairs.begin(), pairs.end(), is_before);
    if (!is_plain_) {
      const auto is_same = [](const MeetingFaces& p, const MeetingFaces& q) { return p.a == q.a && p.b == q.b; };
      pairs.erase(std::unique(pairs.begin(), pairs.end(), is_same), pairs.end());
      for (const MeetingFaces& pair : pairs)
        count(pair.contact);
    }
    pairs.resize(std::min(pairs.size(), max_listed_));
    found_.has_more = is_full();
    return std::move(found_);
  }

 private:
  static constexpr std::size_t kSlack = 1024;  // extra pairs kept, so that removing duplicates is rare

  // Of equal pairs the one that crosses comes first.
  static bool is_before(const MeetingFaces& p, const MeetingFaces& q) {
    return std::tie(p.a, p.b, q.contact) < std::tie(q.a, q.b, p.contact);
  }
  void count(Contact contact) { ++(contact == Contact::crossing ? found_.crossing : found_.touching); }
  void shorten() {
    if (found_.listed.size() <= max_listed_) return;
    const auto end = found_.listed.begin() + static_cast<std::ptrdiff_t>(max_listed_);
    std::nth_element(found_.listed.begin(), end, found_.listed.end(), is_before);
    found_.listed.erase(end, found_.listed.end());
  }

  std::size_t max_listed_;
  bool is_plain_;
  std::uint64_t added_ = 0;
  SelfIntersections found_;
};

using Numbers = std::vector<std::uint32_t>;  // of triangles

// The corners of a triangle where stars are simple: two triangles that share one have nothing else in common. In place of each
// other corner stands a number that no other triangle has; the fourth number is there for the size.
struct StarCorners {
  std::array<std::uint32_t, 4> vertex;
};

bool share_a_corner(const StarCorners& a, const StarCorners& b) {
  unsigned shared = 0;  // without a branch: which corner it is can hardly be foretold
  for (std::size_t turn = 0; turn < 3; ++turn) {
    for (std::size_t i = 0; i < 3; ++i)
      shared |= static_cast<unsigned>(a.vertex[i] == b.vertex[(i + turn) % 3]);
  }
  return shared != 0;
}

class Search {
 public:
  Search(const Mesh& mesh, const FaceGeometry& geometry, const SelfIntersectionOptions& options)
      : mesh_(mesh),
        options_(options),
        triangles_(mesh, geometry, options.jobs),
        all_(options.max_listed, triangles_.is_plain()) {
    std::atomic<bool> is_filtered = true;
    parallel_for(options.jobs, mesh.points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const double size = largest_component(mesh.points[v]);
        if (size > kLargestFiltered && std::isfinite(size)) is_filtered = false;
      }
    });
    is_filtered_ = is_filtered;
    find_taking_part(geometry);
    if (options.topology != nullptr && triangles_.is_plain()) stars_ = find_simple_stars(mesh, *options.topology, options.jobs);
  }

  SelfIntersections run() {
    const Numbers hubs = hubs_of(taking_part_);
    search(BoxTree(boxes(), hubs, options_.jobs), taking_part_, options_.progress);
    for_each_label(hubs, taking_part_, [this](std::uint32_t hub, const Numbers& around) { search_around(hub, around); });
    SelfIntersections result = all_.finish();
    find_points(result.listed);
    return result;
  }

 private:
  [[nodiscard]] RawArray<CellBox> boxes() const {
    const CellGrid grid(mesh_.points, options_.jobs);
    RawArray<Cell> cells(mesh_.points.size());
    parallel_for(options_.jobs, cells.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        cells[v] = std::isfinite(largest_component(mesh_.points[v])) ? grid.cell(mesh_.points[v]) : 0;
      }
    });
    RawArray<CellBox> boxes(taking_part_.size());
    parallel_for(options_.jobs, boxes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const VertexId* const corner = triangles_.corners(taking_part_[i]);
        boxes[i] = CellBox::around(cells[+corner[0]]);
        boxes[i].add(CellBox::around(cells[+corner[1]]));
        boxes[i].add(CellBox::around(cells[+corner[2]]));
      }
    });
    return boxes;
  }

  // In order; counted first, so that all threads can write them.
  void find_taking_part(const FaceGeometry& geometry) {
    const auto takes_part = [&](std::size_t t) {
      const FaceId f = triangles_.face(static_cast<std::uint32_t>(t));
      return geometry.is_finite(f) && !geometry.is_degenerate(f);
    };
    const std::size_t count = triangles_.count();
    std::vector<std::size_t> before((count + kGrain - 1) / kGrain + 1, 0);  // those of all batches before
    parallel_for(options_.jobs, count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        before[begin / kGrain + 1] += takes_part(t);
    });
    std::partial_sum(before.begin(), before.end(), before.begin());
    taking_part_.resize(before.back());
    parallel_for(options_.jobs, count, kGrain, [&](std::size_t begin, std::size_t end) {
      std::size_t at = before[begin / kGrain];
      for (std::size_t t = begin; t < end; ++t) {
        if (takes_part(t)) taking_part_[at++] = static_cast<std::uint32_t>(t);
      }
    });
  }

  // For each triangle its corner with the most triangles, if that is a hub, else kNone. Empty where there is no hub.
  [[nodiscard]] Numbers hubs_of(const Numbers& triangles) const {
    if (!stars_.is_simple.empty() && stars_.most_faces < kHubTriangles) return {};
    Numbers count(mesh_.points.size(), 0);
    std::uint32_t most = 0;
    for (const std::uint32_t t : triangles) {
      for (std::size_t i = 0; i < 3; ++i)
        most = std::max(most, ++count[+triangles_.corners(t)[i]]);
    }
    if (most < kHubTriangles) return {};
    Numbers hubs;
    for (const std::uint32_t t : triangles) {
      const VertexId* const c = triangles_.corners(t);
      const VertexId hub = *std::max_element(c, c + 3, [&](VertexId u, VertexId v) { return count[+u] < count[+v]; });
      hubs.push_back(count[+hub] >= kHubTriangles ? +hub : kNone);
    }
    return hubs;
  }

  // Calls work(label, those of `triangles` that have it).
  template <class Work>
  static void for_each_label(const Numbers& labels, const Numbers& triangles, Work work) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> labelled;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] != kNone) labelled.emplace_back(labels[i], triangles[i]);
    }
    std::sort(labelled.begin(), labelled.end());
    Numbers group;
    for (std::size_t i = 0; i < labelled.size(); ++i) {
      group.push_back(labelled[i].second);
      if (i + 1 < labelled.size() && labelled[i + 1].first == labelled[i].first) continue;
      work(labelled[i].first, group);
      group.clear();
    }
  }

  // Pairs among triangles that share the hub.
  void search_around(std::uint32_t hub, const Numbers& around) {
    // Sides at the hub (not seams) that very many triangles share: these triangles are compared by their normals.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;  // far end, place in `around`
    for (std::uint32_t i = 0; i < around.size(); ++i) {
      const ContactTriangle t = triangles_[around[i]];
      for (unsigned k = 0; k < 3; ++k) {
        const Vec3 *const from = t.corner[k], *const to = t.corner[(k + 1) % 3];
        const Vec3* const other = from == &mesh_.points[hub] ? to : to == &mesh_.points[hub] ? from : nullptr;
        if (other != nullptr && (t.seams >> k & 1u) == 0) sides.emplace_back(other - mesh_.points.data(), i);
      }
    }
    std::sort(sides.begin(), sides.end());
    Numbers far_ends(around.size(), kNone);
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
      while (end < sides.size() && sides[end].first == sides[begin].first)
        ++end;
      for (std::size_t i = begin; i < end && end - begin >= kHubTriangles; ++i)
        far_ends[sides[i].second] = sides[i].first;
    }
    search(BoxTree(boxes_around(&mesh_.points[hub], at(around)), far_ends, options_.jobs), around, {});
    for_each_label(far_ends, around, [&](std::uint32_t far_end, const Numbers& group) {
      search(BoxTree(boxes_around(&mesh_.points[hub], &mesh_.points[far_end], at(group)), {}, options_.jobs), group, {});
    });
  }
  [[nodiscard]] std::vector<ContactTriangle> at(const Numbers& numbers) const {
    std::vector<ContactTriangle> triangles;
    triangles.reserve(numbers.size());
    for (const std::uint32_t t : numbers)
      triangles.push_back(triangles_[t]);
    return triangles;
  }

  // All pairs whose boxes meet; the box that was given to the tree as number i is that of triangles[i]. The search ends with
  // the first part at which the pairs of it and of all parts before it reach the limit; what later parts have found by then is
  // left out.
  void search(const BoxTree& tree, const Numbers& triangles, const Progress& progress) {
    constexpr std::size_t kPartsAtOnce = 4;
    const std::size_t batches = (tree.part_count() + kPartsAtOnce - 1) / kPartsAtOnce;
    const RawArray<StarCorners> stars = stars_of(tree, triangles);
    std::vector<std::optional<Gathered>> finished(batches);
    std::size_t taken = 0, done = 0;
    std::atomic<bool> is_over = all_.is_full();
    std::mutex lock;
    parallel_for(options_.jobs, tree.part_count(), kPartsAtOnce, [&](std::size_t begin, std::size_t end) {
      if (is_over) return;
      Gathered found(options_.max_listed, triangles_.is_plain());
      for (std::size_t part = begin; part < end && !found.is_full(); ++part)
        search_part(tree, part, triangles, stars, is_over, found);
      const std::scoped_lock guard(lock);
      finished[begin / kPartsAtOnce] = std::move(found);
      for (; taken < batches && finished[taken] && !all_.is_full(); finished[taken++].reset())
        all_.add(*finished[taken]);
      is_over = all_.is_full();
      done += end - begin;
      if (progress) progress("self-intersection", static_cast<double>(done) / static_cast<double>(tree.part_count()));
    });
  }
  void search_part(const BoxTree& tree, std::size_t part, const Numbers& triangles, const RawArray<StarCorners>& stars,
                   const std::atomic<bool>& is_over, Gathered& found) const {
    tree.for_each_pair(part, [&](std::size_t i, std::size_t j) {
      if (stars.size() != 0 && share_a_corner(stars[i], stars[j])) return true;
      if (found.is_full() || is_over.load(std::memory_order_relaxed)) return false;
      const std::uint32_t s = triangles[tree.number(i)], t = triangles[tree.number(j)];
      const FaceId a = triangles_.face(s), b = triangles_.face(t);
      if (a == b) return true;
      const Contact contact = judge(triangles_[s], triangles_[t]);
      if (contact != Contact::none) found.add(a, b, contact);
      return true;
    });
  }
  // Of the triangles in the order of the tree; empty where nothing is known of stars, or numbers do not suffice.
  [[nodiscard]] RawArray<StarCorners> stars_of(const BoxTree& tree, const Numbers& triangles) const {
    constexpr std::uint32_t kNoVertex = std::uint32_t{1} << 31;  // and above
    if (stars_.is_simple.empty() || std::max(stars_.is_simple.size(), 3 * tree.size()) >= kNoVertex) return {};
    RawArray<StarCorners> stars(tree.size());
    parallel_for(options_.jobs, tree.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const VertexId* const corner = triangles_.corners(triangles[tree.number(i)]);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t v = +corner[k];
          stars[i].vertex[k] = stars_.is_simple[v] != 0 ? v : kNoVertex | static_cast<std::uint32_t>(3 * i + k);
        }
        stars[i].vertex[3] = stars[i].vertex[0];
      }
    });
    return stars;
  }
  [[nodiscard]] Contact judge(const ContactTriangle& s, const ContactTriangle& t) const {
    const auto is_corner_of_t = [&t](const Vec3* p) { return p == t.corner[0] || p == t.corner[1] || p == t.corner[2]; };
    if (is_corner_of_t(s.corner[0]) && is_corner_of_t(s.corner[1]) && is_corner_of_t(s.corner[2])) return Contact::crossing;
    return is_filtered_ && are_surely_apart(s, t) ? Contact::none : contact_of(s, t);
  }

  // A point for each pair: where the first triangles meet with the contact type of the faces.
  void find_points(std::vector<MeetingFaces>& pairs) const {
    const auto range = [&](FaceId f) {
      if (triangles_.is_plain()) return std::pair{+f, +f + 1};
      const auto is_before = [&](std::uint32_t t, FaceId face) { return triangles_.face(t) < face; };
      const auto first = std::lower_bound(taking_part_.begin(), taking_part_.end(), f, is_before);
      auto end = first;
      while (end != taking_part_.end() && triangles_.face(*end) == f)
        ++end;
      return std::pair{static_cast<std::uint32_t>(first - taking_part_.begin()),
                       static_cast<std::uint32_t>(end - taking_part_.begin())};
    };
    parallel_for(options_.jobs, pairs.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        pairs[i].point = point_of(pairs[i].contact, range(pairs[i].a), range(pairs[i].b));
    });
  }
  using Range = std::pair<std::uint32_t, std::uint32_t>;
  [[nodiscard]] Vec3 point_of(Contact contact, Range a, Range b) const {
    for (std::uint32_t s = a.first; s < a.second; ++s) {
      for (std::uint32_t t = b.first; t < b.second; ++t) {
        if (judge(triangles_[s], triangles_[t]) == contact) return meeting_point(triangles_[s], triangles_[t]);
      }
    }
    return {};
  }

  const Mesh& mesh_;
  const SelfIntersectionOptions& options_;
  FaceTriangles triangles_;
  Numbers taking_part_;  // ascending; of cut polygons all
  SimpleStars stars_;    // of none where not asked
  bool is_filtered_ = true;
  Gathered all_;
};

}  // namespace

SelfIntersections find_self_intersections(const Mesh& mesh, const FaceGeometry& geometry,
                                          const SelfIntersectionOptions& options) {
  return Search(mesh, geometry, options).run();
}

}  // namespace fdcg::bake
