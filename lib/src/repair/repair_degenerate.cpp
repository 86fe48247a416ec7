// SPDX-License-Identifier: Apache-2.0
// Removes faces without area where that does not change the surface. A little over 400 lines: all functions share one edge
// table.
//
// A face with a repeated vertex is not part of the surface (validate skips it). Consecutive equal corners and spikes are
// removed from its loop. If fewer than three corners remain, it is dropped. A polygon that is now sound is kept, unless an edge
// would get a third face. One that still repeats a vertex has an area (two lobes, or a hole with a bridge) and is left.
//
// A face with collinear corners is part of the surface: its edges connect its neighbours. Where its corners are ordered along
// its longest edge, the other edges cover that edge exactly, and the face can be removed in two cases:
//   the longest edge has no other face: the face is dropped, and the border of the surface follows the shorter edges, which is
//   the same line (left if only this face connects its neighbours at a vertex: they would then share just that point) it has
//   one other face, with an area: the inner corners are inserted into that face's edge, on which they lie exactly (a triangle
//   is split in two instead of becoming a quadrilateral, where the splitting edge does not exist yet)
// Two such triangles that share their longest edge flip it to the other diagonal, which is shorter, so that this terminates.
// All others are left.
#include <algorithm>
#include <cmath>
#include <deque>
#include <unordered_map>

#include "exact/exact.hpp"
#include "repair/repair.hpp"
#include "topology/face_geometry.hpp"

namespace fdcg::bake {
namespace {

constexpr const char* kLeaves = "that names a vertex twice and has an area all the same: a hole with a bridge, or two leaves";
constexpr const char* kThirdFace = "that would be a third face at an edge";
constexpr const char* kDisorder = "whose corners do not run along its longest edge in order";
constexpr const char* kCrowded = "whose longest edge has more than two faces";
constexpr const char* kBridge = "without which faces would hang together by a point only";
constexpr const char* kKnown = "whose neighbour across the longest edge has one of its corners already";
constexpr const char* kChained = "whose neighbour across the longest edge has no area either and is left";

using Loop = std::vector<std::uint32_t>;  // points of the soup

class DegenerateDropper {
 public:
  DegenerateDropper(Workpiece& piece, DegenerateTally& tally) : piece_(piece), tally_(tally), view_(piece) {}

  std::uint64_t run() {
    if (!find_faces()) return 0;
    find_edges();
    for (const std::uint32_t f : repeated_)
      close_up(f);
    work_off();
    while (exchange_diagonals())
      work_off();
    for (const auto& [f, waiting] : waiting_) {
      for (const std::uint32_t w : waiting)
        leave(w, kChained);
    }
    replace_faces(piece_, edits());
    return done_;
  }

 private:
  // ---- faces: those of the soup, then those that cuts have added

  [[nodiscard]] std::uint32_t first_added() const { return view_.mesh.face_count(); }
  [[nodiscard]] std::uint32_t root_of(std::uint32_t f) const { return f < first_added() ? f : added_root_[f - first_added()]; }
  [[nodiscard]] Loop loop_of(std::uint32_t f) const {
    const auto changed = changed_.find(f);
    if (changed != changed_.end()) return changed->second;
    const auto corners = piece_.soup.corners.begin();
    return {corners + piece_.soup.face_first[f], corners + piece_.soup.face_first[f + 1]};
  }
  [[nodiscard]] std::uint32_t vertex(std::uint32_t point) const { return vertex_of_point_[point]; }
  [[nodiscard]] const Vec3& position(std::uint32_t point) const { return view_.mesh.points[vertex(point)]; }

  bool find_faces() {
    const FaceGeometry geometry(view_.mesh, view_.states);
    is_flat_.assign(first_added(), false);
    for (std::uint32_t f = 0; f < first_added(); ++f) {
      if (view_.states[f] == FaceState::repeated_corner) {
        repeated_.push_back(f);
      } else if (view_.states[f] == FaceState::sound && geometry.is_degenerate(FaceId{f})) {
        queue_.push_back(f);
        is_flat_[f] = true;
      }
    }
    return !repeated_.empty() || !queue_.empty();
  }

  // ---- edges, by their end vertices: only those around faces that may be removed

  static std::uint64_t key(std::uint32_t u, std::uint32_t v) { return std::uint64_t{std::min(u, v)} << 32 | std::max(u, v); }

  void find_edges() {
    const Mesh& mesh = view_.mesh;
    vertex_of_point_.assign(piece_.soup.points.size(), kNone);
    for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
      if (mesh.corners[c] != VertexId{kNone}) vertex_of_point_[piece_.soup.corners[c]] = +mesh.corners[c];
    }
    is_asked_.assign(mesh.points.size(), false);
    const auto ask = [&](std::uint32_t f) {
      for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h)
        is_asked_[+mesh.corners[h]] = true;
    };
    std::for_each(repeated_.begin(), repeated_.end(), ask);
    std::for_each(queue_.begin(), queue_.end(), ask);
    for (std::uint32_t f = 0; f < first_added(); ++f) {
      if (view_.states[f] != FaceState::sound) continue;
      for (std::uint32_t h = mesh.face_first[f]; h < mesh.face_first[f + 1]; ++h) {
        const std::uint32_t u = +mesh.corners[h], v = +mesh.corners[+next(mesh, FaceId{f}, HalfedgeId{h})];
        if (is_asked_[u] || is_asked_[v]) faces_at_[key(u, v)].push_back(f);
      }
    }
  }

  template <class Visit>
  void for_each_edge(const Loop& loop, Visit visit) const {
    for (std::size_t i = 0; i < loop.size(); ++i)
      visit(vertex(loop[i]), vertex(loop[(i + 1) % loop.size()]));
  }
  void enter(std::uint32_t f, const Loop& loop) {
    for_each_edge(loop, [&](std::uint32_t u, std::uint32_t v) {
      if (is_asked_[u] || is_asked_[v]) faces_at_[key(u, v)].push_back(f);
    });
  }
  void remove(std::uint32_t f, const Loop& loop) {
    for_each_edge(loop, [&](std::uint32_t u, std::uint32_t v) {
      const auto entry = faces_at_.find(key(u, v));
      if (entry != faces_at_.end()) std::erase(entry->second, f);
    });
  }
  [[nodiscard]] std::size_t face_count(std::uint32_t u, std::uint32_t v) const {
    const auto entry = faces_at_.find(key(u, v));
    return entry == faces_at_.end() ? 0 : entry->second.size();
  }

  void change(std::uint32_t f, Loop loop) {
    remove(f, loop_of(f));
    enter(f, loop);
    changed_[f] = std::move(loop);
  }
  std::uint32_t add_beside(std::uint32_t f, Loop loop) {
    const std::uint32_t fresh = first_added() + static_cast<std::uint32_t>(added_root_.size());
    added_root_.push_back(root_of(f));
    enter(fresh, loop);
    changed_[fresh] = std::move(loop);
    return fresh;
  }
  void note_done(std::uint32_t f) {
    tally_.done.push_back(piece_.source_face[root_of(f)]);
    ++done_;
  }
  void leave(std::uint32_t f, const char* reason) { tally_.leave(piece_.source_face[root_of(f)], reason); }

  // Removes a face with its edges, and queues again the faces that had it across their longest edge.
  void drop(std::uint32_t f) {
    remove(f, loop_of(f));
    changed_[f].clear();
    note_done(f);
    wake(f);
  }
  void wake(std::uint32_t f) {
    const auto entry = waiting_.find(f);
    if (entry == waiting_.end()) return;
    queue_.insert(queue_.end(), entry->second.begin(), entry->second.end());
    waiting_.erase(entry);
  }

  // ---- faces with a repeated vertex

  // The loop without consecutive equal corners and spikes.
  [[nodiscard]] Loop without_spikes(const Loop& loop) const {
    Loop kept;
    for (const std::uint32_t point : loop) {
      if (!kept.empty() && vertex(kept.back()) == vertex(point)) continue;
      if (kept.size() > 1 && vertex(kept[kept.size() - 2]) == vertex(point)) {
        kept.pop_back();
        continue;
      }
      kept.push_back(point);
    }
    std::size_t first = 0;  // where the loop's end meets its start
    while (kept.size() - first >= 2) {
      const std::uint32_t a = vertex(kept[first]), z = vertex(kept.back());
      if (a == z || (kept.size() - first >= 3 && vertex(kept[kept.size() - 2]) == a)) {
        kept.pop_back();
      } else if (kept.size() - first >= 3 && vertex(kept[first + 1]) == z) {
        ++first;
      } else {
        break;
      }
    }
    kept.erase(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(first));
    return kept;
  }

  void close_up(std::uint32_t f) {
    const Loop loop = without_spikes(loop_of(f));
    if (loop.size() < 3) {
      changed_[f].clear();
      note_done(f);
      return;
    }
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t point : loop)
      vertices.push_back(vertex(point));
    std::sort(vertices.begin(), vertices.end());
    if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end()) return leave(f, kLeaves);
    bool is_crowded = false;
    for_each_edge(loop, [&](std::uint32_t u, std::uint32_t v) { is_crowded |= face_count(u, v) > 1; });
    if (is_crowded) return leave(f, kThirdFace);
    enter(f, loop);
    changed_[f] = loop;
    if (is_on_line(loop)) {
      is_flat_[f] = true;
      queue_.push_back(f);  // counted when it goes
      return;
    }
    ++tally_.closed;
    note_done(f);
  }

  [[nodiscard]] bool is_on_line(const Loop& loop) const {
    const Vec3& a = position(loop[0]);
    const auto b = std::find_if(loop.begin(), loop.end(), [&](std::uint32_t p) { return position(p) != a; });
    return std::all_of(loop.begin(), loop.end(), [&](std::uint32_t p) {
      const Vec3& c = position(p);
      return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z) &&
             (b == loop.end() || exact::collinear(a, position(*b), c));
    });
  }

  // ---- faces with collinear corners

  // The loop rotated so that its longest edge runs from its last corner to its first, with all others between in order; empty
  // if that is impossible.
  [[nodiscard]] Loop along_longest_edge(const Loop& loop) const {
    const auto squared_length = [&](std::size_t i) {
      const Vec3 &a = position(loop[i]), &b = position(loop[(i + 1) % loop.size()]);
      return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y) + (b.z - a.z) * (b.z - a.z);
    };
    double longest = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
      longest = std::max(longest, squared_length(i));
    constexpr double kNearly = 1 - 0x1p-40;  // the lengths are rounded; the exact test below decides which is longest
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (!(squared_length(i) >= longest * kNearly)) continue;
      Loop turned = loop;
      std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>((i + 1) % loop.size()), turned.end());
      bool is_ordered = true;
      for (std::size_t k = 1; k + 1 < turned.size() && is_ordered; ++k)
        is_ordered = exact::dot_sign(position(turned[k]), position(turned[k - 1]), position(turned[k + 1])) < 0;
      if (is_ordered) return turned;
    }
    return {};
  }

  void work_off() {
    while (!queue_.empty()) {
      const std::uint32_t f = queue_.front();
      queue_.pop_front();
      settle(f);
    }
  }

  void settle(std::uint32_t f) {
    const Loop loop = along_longest_edge(loop_of(f));
    if (loop.empty()) return leave(f, kDisorder);
    const std::vector<std::uint32_t>& sharing = faces_at_[key(vertex(loop.front()), vertex(loop.back()))];
    if (sharing.size() > 2) return leave(f, kCrowded);
    if (sharing.size() == 1) return holds_fans_together(f, loop) ? leave(f, kBridge) : drop(f);
    const std::uint32_t neighbour = sharing[0] == f ? sharing[1] : sharing[0];
    if (neighbour < first_added() && is_flat_[neighbour]) {
      waiting_[neighbour].push_back(f);
      return;
    }
    join(f, loop, neighbour);
  }

  // Whether at some inner corner of `loop` the face is the only connection between its neighbours.
  [[nodiscard]] bool holds_fans_together(std::uint32_t f, const Loop& loop) const {
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      const std::uint32_t u = vertex(loop[k - 1]), b = vertex(loop[k]), v = vertex(loop[k + 1]);
      if (face_count(u, b) > 1 && face_count(b, v) > 1 && !is_linked(b, u, v, f)) return true;
    }
    return false;
  }

  // Whether the fan around vertex b connects edge b-u with edge b-v without face f.
  [[nodiscard]] bool is_linked(std::uint32_t b, std::uint32_t u, std::uint32_t v, std::uint32_t f) const {
    std::vector<std::uint32_t> seen{f}, edges{u};
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (edges[i] == v) return true;
      for (const std::uint32_t g : faces_at_.at(key(b, edges[i]))) {
        if (std::find(seen.begin(), seen.end(), g) != seen.end()) continue;
        seen.push_back(g);
        for_each_edge(loop_of(g), [&](std::uint32_t s, std::uint32_t t) {
          if (s == b) edges.push_back(t);
          if (t == b) edges.push_back(s);
        });
      }
    }
    return false;
  }

  // Inserts the inner corners of `loop` into the neighbour's edge, on which they lie.
  void join(std::uint32_t f, const Loop& loop, std::uint32_t neighbour) {
    Loop other = loop_of(neighbour);
    Loop between(loop.begin() + 1, loop.end() - 1);
    const auto is_between = [&](std::uint32_t point) {
      return std::any_of(between.begin(), between.end(), [&](std::uint32_t b) { return vertex(b) == vertex(point); });
    };
    if (std::any_of(other.begin(), other.end(), is_between)) return leave(f, kKnown);
    // Rotated so that the common edge runs from its last corner to its first.
    const std::uint32_t u = vertex(loop.front()), v = vertex(loop.back());
    for (std::size_t i = 0; i < other.size(); ++i) {
      const std::uint32_t start = vertex(other[i]), end = vertex(other[(i + 1) % other.size()]);
      if (!((start == u && end == v) || (start == v && end == u))) continue;
      std::rotate(other.begin(), other.begin() + static_cast<std::ptrdiff_t>((i + 1) % other.size()), other.end());
      break;
    }
    // The loop runs front .. back; so must what is inserted after the neighbour's back, if that is the loop's front.
    if (vertex(other.back()) != u) std::reverse(between.begin(), between.end());
    ++tally_.joined;
    if (other.size() == 3 && between.size() == 1 && face_count(vertex(between[0]), vertex(other[1])) == 0) {
      change(neighbour, {other[0], other[1], between[0]});
      add_beside(neighbour, {between[0], other[1], other[2]});
    } else {
      other.insert(other.end(), between.begin(), between.end());
      change(neighbour, std::move(other));
    }
    drop(f);
  }

  // Flips the common longest edge of two collinear triangles that block each other. False if there are none.
  bool exchange_diagonals() {
    bool is_any = false;
    std::vector<std::uint32_t> keys;
    for (const auto& [f, waiting] : waiting_)
      keys.push_back(f);
    std::sort(keys.begin(), keys.end());
    const auto waits = [&](std::uint32_t f, std::uint32_t other) {
      const auto entry = waiting_.find(other);
      return entry != waiting_.end() && std::find(entry->second.begin(), entry->second.end(), f) != entry->second.end();
    };
    for (const std::uint32_t f : keys) {
      const auto entry = waiting_.find(f);
      if (entry == waiting_.end()) continue;
      const auto found = std::find_if(entry->second.begin(), entry->second.end(), [&](std::uint32_t w) { return waits(f, w); });
      if (found == entry->second.end()) continue;
      const std::uint32_t other = *found;
      const Loop a = along_longest_edge(loop_of(f)), b = along_longest_edge(loop_of(other));
      if (a.size() != 3 || b.size() != 3 || vertex(a[0]) != vertex(b[2])) continue;  // wound alike
      if (position(a[1]) == position(b[1]) || face_count(vertex(a[1]), vertex(b[1])) != 0) continue;
      wake(f);
      wake(other);
      change(f, {a[0], a[1], b[1]});
      change(other, {a[1], a[2], b[1]});
      is_any = true;
    }
    return is_any;
  }

  // ---- the result

  [[nodiscard]] FaceEdits edits() const {
    std::vector<std::uint32_t> faces;
    for (const auto& [f, loop] : changed_)
      faces.push_back(f);
    // Faces that a cut added follow the face they were cut from.
    std::sort(faces.begin(), faces.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(root_of(a), a) < std::pair(root_of(b), b); });
    FaceEdits result;
    for (const std::uint32_t f : faces) {
      if (result.empty() || result.back().first != root_of(f)) result.push_back({root_of(f), {}});
      const Loop& loop = changed_.at(f);
      if (!loop.empty()) result.back().second.push_back(loop);
    }
    return result;
  }

  Workpiece& piece_;
  DegenerateTally& tally_;
  const View view_;
  std::uint64_t done_ = 0;
  std::vector<std::uint32_t> repeated_;
  std::vector<bool> is_flat_;        // of the soup's faces: collinear and otherwise sound
  std::deque<std::uint32_t> queue_;  // collinear faces to be processed
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>
      waiting_;  // for a collinear face: the faces that can only be removed after it
  std::vector<std::uint32_t> vertex_of_point_;
  std::vector<bool> is_asked_;  // of vertices: their edges are in faces_at_
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> faces_at_;
  std::unordered_map<std::uint32_t, Loop> changed_;  // empty: dropped
  std::vector<std::uint32_t> added_root_;
};

}  // namespace

std::uint64_t drop_degenerate(Workpiece& piece, DegenerateTally& tally) {
  for (std::uint64_t total = 0;;) {
    tally.left.clear();
    tally.reasons.clear();
    const std::uint64_t done = DegenerateDropper(piece, tally).run();
    total += done;
    if (done == 0 || tally.left.empty()) return total;  // else some that were left may be removable now
  }
}

RepairAction drop_degenerate_action(const Workpiece& piece, DegenerateTally& tally) {
  const std::uint64_t dropped = tally.done.size() - tally.closed;
  std::string message = counted(dropped, "face without area was", "faces without area were") + " dropped";
  if (tally.joined != 0)
    message +=
        ", of which " + std::to_string(tally.joined) + " handed the corners on their longest edge to the neighbour there";
  if (tally.closed != 0)
    message += "; " + counted(tally.closed, "polygon was", "polygons were") + " rid of a corner or spike of no extent";
  return action_of(piece, "drop-degenerate", Kind::faces, message, tally);
}

}  // namespace fdcg::bake
