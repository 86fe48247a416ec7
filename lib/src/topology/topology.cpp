// SPDX-License-Identifier: Apache-2.0
#include "topology/topology.hpp"

#include <algorithm>
#include <cstddef>
#include <future>
#include <memory>

#include "base/parallel.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kFacesAtOnce = 16'384;
constexpr std::size_t kWorthTwoThreads = 100'000;  // corners, some milliseconds; a thread costs a tenth of one
constexpr std::size_t kMostPasses = 4;             // more threads would read more than they save

bool all_triangles(const Mesh& mesh) {
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_first[f + 1] != 3 * (f + 1)) return false;
  }
  return true;
}

// Calls visit(slot, vertex, next vertex) for every half-edge of every sound face, in slot order.
template <class Visit>
void for_each_halfedge(const Mesh& mesh, const std::vector<FaceState>& states, Visit visit) {
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (states[f] != FaceState::sound) continue;
    const std::uint32_t first = mesh.face_first[f];
    const std::uint32_t last = mesh.face_first[f + 1] - 1;
    for (std::uint32_t h = first; h < last; ++h)
      visit(h, +mesh.corners[h], +mesh.corners[h + 1]);
    visit(last, +mesh.corners[last], +mesh.corners[first]);
  }
}

void sort_bucket(std::uint64_t* begin, std::uint64_t* end) {
  constexpr std::ptrdiff_t kInsertionSortBelow = 24;  // most vertices have about three edges in their bucket
  if (end - begin >= kInsertionSortBelow) {
    std::sort(begin, end);
    return;
  }
  if (begin == end) return;  // of no edge; null where there are none at all
  for (std::uint64_t* i = begin + 1; i < end; ++i) {
    const std::uint64_t key = *i;
    std::uint64_t* hole = i;
    for (; hole > begin && hole[-1] > key; --hole)
      *hole = hole[-1];
    *hole = key;
  }
}

// One bucket: keys (larger vertex, slot), sorted, so that the half-edges of an edge stand together in slot order.
void pair_bucket(const Mesh& mesh, const std::uint64_t* begin, const std::uint64_t* end, std::vector<HalfedgeId>& twin) {
  const auto slot = [](std::uint64_t key) { return static_cast<std::uint32_t>(key); };
  while (begin < end) {
    const std::uint64_t* stop = begin + 1;
    while (stop < end && *stop >> 32 == *begin >> 32)
      ++stop;
    const std::uint32_t a = slot(begin[0]);
    if (stop - begin == 1) {
      twin[a] = Topology::kBoundary;
    } else if (stop - begin == 2) {
      const std::uint32_t b = slot(begin[1]);
      const bool same_way = mesh.corners[a] == mesh.corners[b];
      twin[a] = same_way ? Topology::kSameWay : HalfedgeId{b};
      twin[b] = same_way ? Topology::kSameWay : HalfedgeId{a};
    } else {
      for (const std::uint64_t* i = begin; i < stop; ++i)
        twin[slot(*i)] = Topology::kNonManifold;
    }
    begin = stop;
  }
}

}  // namespace

std::vector<FaceState> face_states(const Mesh& mesh, unsigned jobs) {
  std::vector<FaceState> states(mesh.face_count(), FaceState::sound);
  parallel_for(jobs, mesh.face_count(), kFacesAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<VertexId> sorted;  // only polygons need it
    for (std::size_t f = begin; f < end; ++f) {
      const VertexId* corner = mesh.corners.data() + mesh.face_first[f];
      const std::uint32_t count = mesh.face_first[f + 1] - mesh.face_first[f];
      if (std::find(corner, corner + count, VertexId{kNone}) != corner + count) {
        states[f] = FaceState::invalid_corner;
      } else if (count < 3) {
        states[f] = FaceState::repeated_corner;
      } else if (count == 3) {
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) states[f] = FaceState::repeated_corner;
      } else {
        sorted.assign(corner, corner + count);
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) states[f] = FaceState::repeated_corner;
      }
    }
  });
  return states;
}

Topology pair_halfedges(const Mesh& mesh, const std::vector<FaceState>& states, unsigned jobs) {
  Topology topology;
  const bool is_small = mesh.corners.size() < kWorthTwoThreads;
  const auto fill_twins = [&] { topology.twin.assign(mesh.corners.size(), Topology::kSkipped); };
  const auto side = is_small || jobs < 2 ? std::launch::deferred : std::launch::async;
  std::future<void> twins = std::async(side, fill_twins);  // the system's zeroing of new memory takes as long as the counting
  if (!all_triangles(mesh)) {
    topology.face_of.resize(mesh.corners.size());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
      std::fill(topology.face_of.begin() + mesh.face_first[f], topology.face_of.begin() + mesh.face_first[f + 1], FaceId{f});
    }
  }

  // A counting sort by the smaller vertex. Each thread owns a range of vertices and reads all the faces: sequential reading is
  // cheap beside the scattered writes.
  const std::size_t vertices = mesh.points.size();
  const std::size_t ranges = is_small ? 1 : std::min<std::size_t>(jobs, kMostPasses), width = vertices / ranges + 1;
  std::vector<std::uint32_t> first(vertices + 1, 0);  // where the bucket of each vertex starts; later where it ends
  const auto for_each_range = [&](auto work) {
    parallel_for(jobs, ranges, 1, [&](std::size_t range, std::size_t) {
      work(static_cast<std::uint32_t>(std::min(vertices, range * width)),
           static_cast<std::uint32_t>(std::min(vertices, (range + 1) * width)));
    });
  };
  for_each_range([&](std::uint32_t low, std::uint32_t high) {
    for_each_halfedge(mesh, states, [&](std::uint32_t, std::uint32_t u, std::uint32_t v) {
      const std::uint32_t least = std::min(u, v);
      if (least - low < high - low) ++first[least];
    });
  });
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : first) {
    const std::uint32_t count = entry;
    entry = sum;
    sum += count;
  }
  const auto keys = std::make_unique_for_overwrite<std::uint64_t[]>(sum);  // each is written before it is read
  twins.get();
  for_each_range([&](std::uint32_t low, std::uint32_t high) {
    std::uint32_t begin = first[low];
    for_each_halfedge(mesh, states, [&](std::uint32_t slot, std::uint32_t u, std::uint32_t v) {
      const std::uint32_t least = std::min(u, v);
      if (least - low < high - low) keys[first[least]++] = std::uint64_t{std::max(u, v)} << 32 | slot;
    });
    for (std::uint32_t v = low; v < high; ++v) {
      sort_bucket(keys.get() + begin, keys.get() + first[v]);
      pair_bucket(mesh, keys.get() + begin, keys.get() + first[v], topology.twin);
      begin = first[v];
    }
  });
  return topology;
}

Topology pair_halfedges(const Mesh& mesh) {
  return pair_halfedges(mesh, face_states(mesh));
}

}  // namespace fdcg::bake
