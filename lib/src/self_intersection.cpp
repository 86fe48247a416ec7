// SPDX-License-Identifier: Apache-2.0
#include "self_intersection.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tuple>

#include "box_pairs.hpp"
#include "face_triangles.hpp"
#include "parallel.hpp"
#include "triangle_filter.hpp"
#include "vec.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kGrain = 4096;

// What one thread has found so far, or all of them together.
class Findings {
 public:
  explicit Findings(std::size_t max_listed) : max_listed_(max_listed) {}

  void add(FaceId a, FaceId b, Contact contact) {
    ++(contact == Contact::crossing ? found_.crossing : found_.touching);
    found_.listed.push_back({std::min(a, b), std::max(a, b), contact, {}});
    if (max_listed_ < kAllElements / 2 && found_.listed.size() >= 2 * max_listed_ + kSlack) shorten();
  }
  void add(const Findings& other) {
    found_.crossing += other.found_.crossing;
    found_.touching += other.found_.touching;
    found_.listed.insert(found_.listed.end(), other.found_.listed.begin(), other.found_.listed.end());
    shorten();
  }
  SelfIntersections finish() {
    shorten();
    std::sort(found_.listed.begin(), found_.listed.end(), is_before);
    return std::move(found_);
  }

 private:
  static constexpr std::size_t kSlack = 1024;  // pairs kept beyond what is needed, so that sorting them out stays rare

  static bool is_before(const MeetingFaces& p, const MeetingFaces& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); }
  void shorten() {
    if (found_.listed.size() <= max_listed_) return;
    const auto end = found_.listed.begin() + static_cast<std::ptrdiff_t>(max_listed_);
    std::nth_element(found_.listed.begin(), end, found_.listed.end(), is_before);
    found_.listed.erase(end, found_.listed.end());
  }

  std::size_t max_listed_;
  SelfIntersections found_;
};

class Search {
 public:
  Search(const Mesh& mesh, const FaceGeometry& geometry, const SelfIntersectionOptions& options)
      : mesh_(mesh), geometry_(geometry), options_(options), triangles_(mesh, geometry, options.jobs) {
    for (const Vec3& p : mesh.points)
      is_filtered_ = is_filtered_ && !(largest_component(p) > kLargestFiltered && std::isfinite(largest_component(p)));
  }

  SelfIntersections run() {
    const BoxTree tree(boxes(), options_.jobs);
    Findings all(options_.max_listed);
    std::mutex lock;
    std::size_t done = 0;
    constexpr std::size_t kPartsAtOnce = 4;
    parallel_for(options_.jobs, tree.part_count(), kPartsAtOnce, [&](std::size_t begin, std::size_t end) {
      Findings found(options_.max_listed);
      for (std::size_t part = begin; part < end; ++part) {
        tree.for_each_pair(part, [&](std::uint32_t i, std::uint32_t j) {
          const FaceId a = faces_[i], b = faces_[j];
          const Contact contact = contact_between(a, b);
          if (contact != Contact::none) found.add(a, b, contact);
        });
      }
      const std::lock_guard<std::mutex> guard(lock);
      all.add(found);
      done += end - begin;
      if (options_.progress)
        options_.progress("self-intersection", static_cast<double>(done) / static_cast<double>(tree.part_count()));
    });
    SelfIntersections result = all.finish();
    for (MeetingFaces& pair : result.listed)
      pair.point = point_between(pair);
    return result;
  }

 private:
  std::vector<CellBox> boxes() {
    for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
      if (geometry_.is_finite(FaceId{f}) && !geometry_.is_degenerate(FaceId{f})) faces_.push_back(FaceId{f});
    }
    const CellGrid grid(mesh_.points);
    std::vector<Cell> cells(mesh_.points.size());
    parallel_for(options_.jobs, cells.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (std::isfinite(largest_component(mesh_.points[v]))) cells[v] = grid.cell(mesh_.points[v]);
      }
    });
    std::vector<CellBox> boxes(faces_.size());
    parallel_for(options_.jobs, faces_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t first = mesh_.face_first[+faces_[i]], stop = mesh_.face_first[+faces_[i] + 1];
        boxes[i] = CellBox::around(cells[+mesh_.corners[first]]);
        for (std::uint32_t h = first + 1; h < stop; ++h)
          boxes[i].add(CellBox::around(cells[+mesh_.corners[h]]));
      }
    });
    return boxes;
  }

  [[nodiscard]] Contact judge(const ContactTriangle& s, const ContactTriangle& t) const {
    return is_filtered_ && are_surely_apart(s, t) ? Contact::none : contact_of(s, t);
  }
  [[nodiscard]] Contact contact_between(FaceId a, FaceId b) const {
    Contact contact = Contact::none;
    for (std::uint32_t s = triangles_.first(a); s < triangles_.end(a); ++s) {
      for (std::uint32_t t = triangles_.first(b); t < triangles_.end(b) && contact != Contact::crossing; ++t)
        contact = std::max(contact, judge(triangles_[s], triangles_[t]));
    }
    return contact;
  }
  // Of the first of their triangles that meet in the way that they do.
  [[nodiscard]] Vec3 point_between(const MeetingFaces& pair) const {
    for (std::uint32_t s = triangles_.first(pair.a); s < triangles_.end(pair.a); ++s) {
      for (std::uint32_t t = triangles_.first(pair.b); t < triangles_.end(pair.b); ++t) {
        if (judge(triangles_[s], triangles_[t]) == pair.contact) return meeting_point(triangles_[s], triangles_[t]);
      }
    }
    return {};
  }

  const Mesh& mesh_;
  const FaceGeometry& geometry_;
  const SelfIntersectionOptions& options_;
  FaceTriangles triangles_;
  std::vector<FaceId> faces_;  // those that take part
  bool is_filtered_ = true;
};

}  // namespace

SelfIntersections find_self_intersections(const Mesh& mesh, const FaceGeometry& geometry,
                                          const SelfIntersectionOptions& options) {
  return Search(mesh, geometry, options).run();
}

}  // namespace fdcg::bake
