// SPDX-License-Identifier: Apache-2.0
// A deformable mesh's memory: laid out and filled in once. deform_move.cpp moves its corners, deform_step.cpp steps on it.
#include <string.h>

#include "base/config.hpp"
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "deform/deform_upkeep.hpp"

namespace fdcg {
namespace {

constexpr uint64_t kAlignment = 64;  // a line of the cache

// Wherever the caller's memory begins, the parts begin at a line: a corner's place in two takes twice the time.
void* at_a_line(void* memory) {
  const auto at = reinterpret_cast<uintptr_t>(memory);
  return static_cast<unsigned char*>(memory) + (kAlignment - at % kAlignment) % kAlignment;
}

// Leaves stand beside their nodes' bits in 32.
constexpr uint32_t kMostNodes = FDCG_LEAF_NODES << (32 - FDCG_LEAF_NODES);

fdcg_status check_graph(const fdcg_graph* graph, fdcg_error* error) {
  if (graph == nullptr || graph->header == nullptr)
    return refuse(error, FDCG_E_ARGUMENT, "graph: null pointer, or no graph was opened");
  const fdcg_header& header = *graph->header;
  if (header.node_bytes == 0 || header.side_count != header.node_count * uint64_t{3}) {
    return Message(error, FDCG_E_GRAPH)
        .say("the graph has ", header.node_count, " faces with ", header.side_count,
             " sides; to be deformed each must be a triangle: compile the mesh with --triangles");
  }
  if (header.largest_fan > FDCG_DEFORM_MOST_FAN) {
    return Message(error, FDCG_E_GRAPH)
        .say("a corner has ", header.largest_fan, " edges; of a mesh to be deformed at most ", FDCG_DEFORM_MOST_FAN,
             " may meet: remesh it there");
  }
  if (header.node_count > kMostNodes) {
    return Message(error, FDCG_E_GRAPH)
        .say("the graph has ", header.node_count, " triangles; at most ", kMostNodes, " can be deformed");
  }
  return FDCG_OK;
}

// Where each part stands, and how many bytes they take.
struct Layout {
  uint64_t nodes, corners, places, logs[2], connections, busy_corners, boxes, stale, loose, tight_tick, leaf_first, leaves,
      bytes;

  explicit Layout(const fdcg_header& header) : bytes(sizeof(fdcg_deform)) {
    const bool is_f64 = header.real_bytes == sizeof(double);
    const BoxTree tree(header.node_count);
    nodes = place(header.node_count, is_f64 ? node_bytes<double>(3, false) : node_bytes<float>(3, false));
    corners = place(header.corner_count, is_f64 ? sizeof(fdcg_corner_f64) : sizeof(fdcg_corner_f32));
    places = place(header.corner_count, is_f64 ? sizeof(Place<double>) : sizeof(Place<float>));
    for (uint64_t& log : logs)
      log = place(header.corner_count, is_f64 ? sizeof(Was<double>) : sizeof(Was<float>));
    connections = place(header.connection_count, sizeof(fdcg_connection));
    busy_corners = place(header.busy_count, sizeof(fdcg_busy_corner));
    boxes = place(tree.records, sizeof(fdcg_box8));
    stale = place(tree.leaves, 1);
    loose = place(tree.records, 1);
    tight_tick = place(tree.records, sizeof(uint32_t));
    leaf_first = place(header.corner_count + uint64_t{1}, sizeof(uint32_t));
    leaves = place(header.node_count * uint64_t{3}, sizeof(uint32_t));
    bytes += kAlignment - alignof(fdcg_deform);  // at_a_line
  }

 private:
  uint64_t place(uint64_t count, uint64_t record_bytes) {
    const uint64_t at = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    bytes = at + count * record_bytes;
    return at;
  }
};

fdcg_status checked_config(const fdcg_deform_config* given, fdcg_deform_config* config, fdcg_error* error) {
  if (given == nullptr) return refuse(error, FDCG_E_ARGUMENT, "config: null pointer");
  if (const fdcg_status status =
          check_struct_bytes(given->struct_bytes, sizeof *given, "config", "; start from fdcg_make_deform_config()", error);
      status != FDCG_OK) {
    return status;
  }
  *config = in_full(*given, config, fdcg_deform_config_init);
  constexpr double kLargest = 1e90;
  if (config->reserved != 0) return Message(error, FDCG_E_ARGUMENT).say("config.reserved is ", config->reserved, ", allowed 0");
  if (config->margin_m >= 0 && config->margin_m <= kLargest) return FDCG_OK;
  return Message(error, FDCG_E_ARGUMENT)
      .say("config.margin_m is ", config->margin_m, ", allowed 0 (the default: the graph's largest side) to ", kLargest);
}

// The header as it is from now on: the graph's, with room for the corners to move.
fdcg_status widen_bounds(double margin_m, fdcg_header* header, fdcg_error* error) {
  double side = 0;
  for (int k = 0; k < 3; ++k)
    side = greater_of(side, header->bounds_max[k] - header->bounds_min[k]);
  const double margin = margin_m > 0 ? margin_m / header->metres_per_unit : side;
  const double largest = header->real_bytes == sizeof(double) ? FDCG_LARGEST_EXTENT_F64 : FDCG_LARGEST_EXTENT_F32;
  double extent = 0;
  for (int k = 0; k < 3; ++k) {
    header->bounds_min[k] -= margin;
    header->bounds_max[k] += margin;
    extent = greater_of(extent, greater_of(-header->bounds_min[k], header->bounds_max[k]));
  }
  if (!(extent <= largest)) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("config.margin_m lets vertices move to ", extent, " file units from the middle, allowed ", largest,
             "; take a smaller one");
  }
  header->extent = extent;
  header->max_deviation = 0;
  header->section_count = 0;  // there is no table behind this header
  header->flags = 0;
  return FDCG_OK;
}

template <class Real>
void copy_nodes(const fdcg_graph& graph, fdcg_deform* deform) {
  const auto* from = static_cast<const unsigned char*>(graph.nodes);
  for (uint32_t n = 0; n < graph.header->node_count; ++n)
    memcpy(deform->nodes + n * uint64_t{deform->node_bytes}, from + n * uint64_t{graph.header->node_bytes}, deform->node_bytes);
  memcpy(deform->corners, graph.corners, graph.header->corner_count * sizeof(typename Records<Real>::Corner));
  const Upkeep<Real> upkeep(*deform);
  memset(deform->places, 0, graph.header->corner_count * sizeof(Place<Real>));
  for (uint32_t c = 0; c < graph.header->corner_count; ++c)
    memcpy(upkeep.place(c).point, upkeep.corner(c).point, sizeof upkeep.place(c).point);
}

// Which leaves hold a corner's nodes, and which of their nodes those are: counted, summed up, filled in. A corner of a graph
// that is no surface may be in any number of leaves; what a move costs is bounded by them. False where that is too much.
template <class Real>
bool list_leaves(fdcg_deform* deform) {
  const Upkeep<Real> upkeep(*deform);
  const uint32_t corners = deform->header.corner_count;
  uint32_t* const first = deform->leaf_first;
  const auto for_each = [&](auto&& visit) {  // visit(corner, entry), each corner of a leaf once
    for (uint32_t leaf = 0; leaf < deform->tree.leaves; ++leaf) {
      const uint32_t begin = leaf * FDCG_LEAF_NODES, left = deform->header.node_count - begin;
      const uint32_t sides = 3 * (left < FDCG_LEAF_NODES ? left : FDCG_LEAF_NODES);
      const auto corner_at = [&](uint32_t i) { return upkeep.node(begin + i / 3).sides[i % 3].corner; };
      for (uint32_t i = 0; i < sides; ++i) {
        uint32_t nodes = 0, before = 0;
        for (uint32_t other = 0; other < sides; ++other) {
          if (corner_at(other) != corner_at(i)) continue;
          before += other < i;
          nodes |= 1u << other / 3;
        }
        if (before == 0) visit(corner_at(i), leaf << FDCG_LEAF_NODES | nodes);
      }
    }
  };
  memset(first, 0, (corners + size_t{1}) * sizeof *first);
  for_each([&](uint32_t corner, uint32_t) { ++first[corner + 1]; });
  for (uint32_t c = 0; c < corners; ++c) {
    if (first[c + 1] > FDCG_DEFORM_MOST_FAN) return false;
    first[c + 1] += first[c];
  }
  for_each([&](uint32_t corner, uint32_t entry) { deform->leaves[first[corner]++] = entry; });
  for (uint32_t c = corners; c > 0; --c)  // each now stands where the next one begins
    first[c] = first[c - 1];
  first[0] = 0;
  return true;
}

template <class Real>
void fill_boxes(fdcg_deform* deform) {
  const Upkeep<Real> upkeep(*deform);
  const BoxTree& tree = deform->tree;
  for (int level = 0; level < tree.levels; ++level) {
    for (uint32_t i = 0; i < tree.size[level]; ++i) {
      fdcg_box8& record = deform->boxes[tree.first[level] + i];
      record = {};
      memset(record.low, FDCG_MAX_SIDES, sizeof record.low);  // inside out: no box
      TreeBox boxes[FDCG_TREE_WAYS];
      const uint32_t lanes = tree.lanes(level, i);
      for (uint32_t j = 0; lanes >> j != 0; ++j) {
        const uint32_t below = i * FDCG_TREE_WAYS + j;
        bool may_shrink;
        boxes[j] = level == 0 ? upkeep.leaf_box(below, &may_shrink)
                              : around(deform->boxes[tree.first[level - 1] + below], tree.lanes(level - 1, below));
      }
      (void)set_lanes(&record, lanes, boxes);
    }
  }
}

// Every node, connection and corner normal as their corners are.
template <class Real>
void bring_all_up_to_date(fdcg_deform* deform) {
  const Upkeep<Real> upkeep(*deform);
  const fdcg_header& header = deform->header;
  for (uint32_t n = 0; n < header.node_count; ++n)
    upkeep.bring_up_to_date(n);
  memset(deform->header.connection_type_count, 0, sizeof header.connection_type_count);
  for (uint32_t c = 0; c < header.connection_count; ++c)
    ++deform->header.connection_type_count[upkeep.type(c)];
  for (uint32_t c = 0; c < header.corner_count; ++c) {
    upkeep.bring_normal_up_to_date(c);
    memcpy(upkeep.corner(c).point, upkeep.place(c).point, sizeof upkeep.place(c).point);
  }
  for (int level = 0; level < deform->tree.levels; ++level) {
    for (uint32_t i = 0; i < deform->tree.size[level]; ++i)
      upkeep.make_tight(level, i, deform->loose[deform->tree.first[level] + i]);
  }
}

void place_parts(void* memory, const Layout& layout, const fdcg_graph& graph, fdcg_deform* deform) {
  auto* const start = static_cast<unsigned char*>(memory);
  deform->nodes = start + layout.nodes;
  deform->corners = start + layout.corners;
  deform->places = start + layout.places;
  for (int parity = 0; parity < 2; ++parity)
    deform->logs[parity] = start + layout.logs[parity];
  deform->connections = reinterpret_cast<fdcg_connection*>(start + layout.connections);
  deform->boxes = reinterpret_cast<fdcg_box8*>(start + layout.boxes);
  deform->stale = start + layout.stale;
  deform->loose = start + layout.loose;
  deform->tight_tick = reinterpret_cast<uint32_t*>(start + layout.tight_tick);
  deform->leaf_first = reinterpret_cast<uint32_t*>(start + layout.leaf_first);
  deform->leaves = reinterpret_cast<uint32_t*>(start + layout.leaves);
  auto* const busy_corners = reinterpret_cast<fdcg_busy_corner*>(start + layout.busy_corners);
  for (uint32_t i = 0; i < graph.header->busy_count; ++i) {
    busy_corners[i] = graph.busy_corners[i];
    busy_corners[i].first_box = FDCG_NONE;  // no tree: its edges are few enough to be looked at one by one
  }
  memcpy(deform->connections, graph.connections, graph.header->connection_count * sizeof(fdcg_connection));
  fdcg_graph& own = deform->graph;
  own = graph;
  own.header = &deform->header;
  own.mapping = nullptr;
  own.mapping_bytes = 0;
  own.node_offsets = nullptr;
  own.edges = own.fan_boxes = nullptr;
  own.fan_runs = nullptr;
  own.fan_run_count = 0;
  own.normals = nullptr;
  own.nodes = deform->nodes;
  own.connections = deform->connections;
  own.corners = deform->corners;
  own.busy_corners = graph.header->busy_count > 0 ? busy_corners : nullptr;
  own.hierarchy = deform->boxes;
}

template <class Real>
bool fill_in(const fdcg_graph& graph, fdcg_deform* deform) {
  copy_nodes<Real>(graph, deform);
  if (!list_leaves<Real>(deform)) return false;
  fill_boxes<Real>(deform);
  memset(deform->loose, 0, deform->tree.records);
  memset(deform->tight_tick, 0, deform->tree.records * sizeof *deform->tight_tick);
  memset(deform->stale, (1 << FDCG_LEAF_NODES) - 1, deform->tree.leaves);
  bring_all_up_to_date<Real>(deform);
  return true;
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_deform_config_init(fdcg_deform_config* config, uint32_t struct_bytes) {
  fdcg::fill_defaults(config, fdcg_deform_config{}, struct_bytes);
}

extern "C" uint64_t fdcg_deform_bytes(const fdcg_graph* graph) {
  return fdcg::check_graph(graph, nullptr) == FDCG_OK ? fdcg::Layout(*graph->header).bytes : 0;
}

extern "C" fdcg_status fdcg_deform_create(void* memory, uint64_t bytes, const fdcg_graph* graph,
                                          const fdcg_deform_config* config, fdcg_deform** deform, fdcg_error* error) {
  using fdcg::Message;
  if (deform == nullptr) return fdcg::refuse(error, FDCG_E_ARGUMENT, "deform: null pointer");
  *deform = nullptr;
  fdcg_deform_config whole;
  fdcg_status status = fdcg::checked_config(config, &whole, error);
  if (status == FDCG_OK) status = fdcg::check_graph(graph, error);
  if (status != FDCG_OK) return status;
  if (memory == nullptr) return fdcg::refuse(error, FDCG_E_ARGUMENT, "memory: null pointer");
  if (reinterpret_cast<uintptr_t>(memory) % alignof(fdcg_deform) != 0)
    return fdcg::refuse(error, FDCG_E_ALIGNMENT, "memory must start at a multiple of 8 bytes; align the buffer");
  const fdcg::Layout layout(*graph->header);
  if (bytes < layout.bytes) {
    return Message(error, FDCG_E_ARGUMENT).say("memory has ", bytes, " bytes, fdcg_deform_bytes asks for ", layout.bytes);
  }
  fdcg_header header = *graph->header;
  status = fdcg::widen_bounds(whole.margin_m, &header, error);
  if (status != FDCG_OK) return status;
  void* const aligned = fdcg::at_a_line(memory);
  auto* const made = static_cast<fdcg_deform*>(aligned);
  memset(aligned, 0, sizeof *made);
  made->header = header;
  made->tree = fdcg::BoxTree(header.node_count);
  made->tick = 1;  // the corners' is 0: none has moved
  made->node_bytes =
      header.real_bytes == sizeof(double) ? fdcg::node_bytes<double>(3, false) : fdcg::node_bytes<float>(3, false);
  made->header.node_bytes = made->node_bytes;
  made->per_tree_unit = 1 / fdcg::tree_unit(header.extent);
  memcpy(made->low, header.bounds_min, sizeof made->low);
  memcpy(made->high, header.bounds_max, sizeof made->high);
  fdcg::place_parts(aligned, layout, *graph, made);
  const bool is_made = fdcg::with_real_of(header, [&](auto real) { return fdcg::fill_in<decltype(real)>(*graph, made); });
  if (!is_made)
    return fdcg::refuse(error, FDCG_E_GRAPH, "a corner has more faces than its edges allow; compile the mesh again");
  *deform = made;
  return FDCG_OK;
}

extern "C" const fdcg_graph* fdcg_deform_get_graph(fdcg_deform* deform) {
  if (deform == nullptr) return nullptr;
  fdcg::with_real_of(deform->header, [&](auto real) { fdcg::bring_all_up_to_date<decltype(real)>(deform); });
  return &deform->graph;
}
