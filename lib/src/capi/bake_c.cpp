// SPDX-License-Identifier: Apache-2.0
// The C API of the compiler. Exceptions end here.
#include "fdcg/api.h"
#undef FDCG_INLINE
#define FDCG_INLINE static inline
#include "fdcg/fdcg.h"
#undef FDCG_INLINE
#define FDCG_INLINE FDCG_API  // symbols of what is inline in bake.h, for languages that call by name
#include "fdcg/bake.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "bake_core.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kAlignment = 64;  // of a graph
constexpr std::uint32_t kSmallestStruct = 8;

// Copies what fits, with a zero behind it.
template <std::size_t kSize>
void put(const std::string& text, char (&to)[kSize]) {
  const std::size_t length = std::min(text.size(), kSize - 1);
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
}

fdcg_status refuse(fdcg_error* error, fdcg_status status, const std::string& message) {
  if (error == nullptr) return status;
  *error = {};
  error->status = status;
  put(message, error->message);
  return status;
}

// The caller's struct over the defaults: an older one is shorter.
template <class Struct>
Struct in_full(const Struct& given, Struct defaults) {
  std::memcpy(static_cast<void*>(&defaults), &given, given.struct_bytes);
  defaults.struct_bytes = sizeof(Struct);
  return defaults;
}
template <class Struct>
bool is_size(const Struct& given) {
  return given.struct_bytes >= kSmallestStruct && given.struct_bytes <= sizeof(Struct) && given.struct_bytes % 8 == 0;
}
template <class Struct>
void fill(Struct* to, Struct from, std::uint32_t struct_bytes) {
  if (to == nullptr) return;
  from.struct_bytes = struct_bytes;
  const std::size_t known = std::min<std::size_t>(struct_bytes, sizeof(Struct));
  std::memcpy(static_cast<void*>(to), &from, known);
}

struct Input {
  const double* points;
  std::uint64_t point_count;
  const std::uint32_t* corners;
  const std::uint32_t* sides;
  std::uint64_t face_count;
};

PolygonSoup soup_of(const Input& input, double quantum) {
  PolygonSoup soup;
  soup.name = "mesh";
  soup.relative_quantum = quantum > 0 ? 0 : 0x1p-53;
  soup.points.resize(input.point_count);
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    soup.points[i] = {input.points[3 * i], input.points[3 * i + 1], input.points[3 * i + 2]};
  soup.absolute_quantum = quantum_that_counts(quantum, soup);
  soup.face_first.reserve(input.face_count + 1);
  soup.face_first.push_back(0);
  std::uint64_t corner_count = 0;
  for (std::uint64_t f = 0; f < input.face_count; ++f)
    soup.face_first.push_back(static_cast<std::uint32_t>(corner_count += input.sides != nullptr ? input.sides[f] : 3));
  soup.corners.assign(input.corners, input.corners + corner_count);
  for (std::uint32_t& corner : soup.corners) {
    if (corner >= input.point_count) corner = PolygonSoup::kInvalidVertex;
  }
  return soup;
}

// The format's numbers are 32-bit ones.
bool fits(const Input& input) {
  constexpr std::uint64_t kMost = 0xFFFFFFFEu;
  if (input.point_count > kMost || input.face_count > kMost) return false;
  std::uint64_t corner_count = 0;
  for (std::uint64_t f = 0; f < input.face_count && corner_count <= kMost; ++f)
    corner_count += input.sides != nullptr ? input.sides[f] : 3;
  return corner_count <= kMost;
}

fdcg_finding finding_of(const Issue& issue) {
  fdcg_finding finding = {};
  put(issue.rule, finding.rule);
  put(issue.message, finding.message);
  finding.severity = issue.severity == Severity::error     ? FDCG_ERROR
                     : issue.severity == Severity::warning ? FDCG_WARNING
                                                           : FDCG_NOTE;
  finding.total = issue.total;
  finding.first_face = finding.first_vertex = FDCG_NONE;
  if (!issue.elements.empty()) {
    const Element& first = issue.elements.front();
    if (!first.faces.empty()) finding.first_face = first.faces.front();
    if (!first.vertices.empty()) finding.first_vertex = first.vertices.front();
  }
  return finding;
}

CompileOptions options_of(const fdcg_bake_options& given) {
  CompileOptions options;
  options.metres_per_unit = given.metres_per_unit;
  options.precision = given.real_bytes == 4 ? Precision::f32 : Precision::f64;
  options.merge = given.merges != 0;
  options.triangles = given.triangles != 0;
  options.orient = given.orients != 0;
  options.self_intersections = given.self_intersections != 0;
  options.density_kg_per_m3 = given.density_kg_per_m3;
  options.jobs = given.threads;
  return options;
}

void* allocate_by_system(void*, std::uint64_t bytes) {
  return std::aligned_alloc(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment);
}

fdcg_status compile_for_c(const Input& input, const fdcg_bake_options& given, fdcg_finding* findings,
                          std::uint32_t finding_capacity, fdcg_baked* baked, fdcg_error* error) {
  CompileOptions options = options_of(given);
  const fdcg_allocate allocate = given.allocate != nullptr ? given.allocate : allocate_by_system;
  void* bytes = nullptr;
  bool has_memory = true;
  options.allocate = [&](std::size_t count) -> std::span<std::byte> {
    bytes = allocate(given.context, count);
    has_memory = bytes != nullptr && reinterpret_cast<std::uintptr_t>(bytes) % kAlignment == 0;
    if (!has_memory) return {};
    std::memset(bytes, 0, count);
    return {static_cast<std::byte*>(bytes), count};
  };
  PolygonSoup soup = soup_of(input, given.quantum);
  const Result<Compiled> compiled = compile_by(soup, options, nullptr, &soup);
  if (!has_memory)
    return refuse(error, FDCG_E_MEMORY, bytes == nullptr ? "allocate: there is no memory" : "allocate: not a multiple of 64");
  if (!compiled) return refuse(error, FDCG_E_ARGUMENT, compiled.error().message);
  baked->finding_count = static_cast<std::uint32_t>(compiled->report.issues.size());
  for (std::uint32_t i = 0; i < baked->finding_count && i < finding_capacity; ++i)
    findings[i] = finding_of(compiled->report.issues[i]);
  baked->merged_faces = compiled->merged_faces;
  baked->split_faces = compiled->split_faces;
  baked->flipped_faces = compiled->flipped_faces;
  if (!compiled->report.passes()) {
    const std::string first = baked->finding_count > 0 ? ": " + compiled->report.issues[0].message : std::string();
    return refuse(error, FDCG_E_MESH, "the mesh has errors" + first);
  }
  baked->bytes = compiled->placed.data();
  baked->byte_count = compiled->placed.size();
  return FDCG_OK;
}

}  // namespace
}  // namespace fdcg::bake

extern "C" void fdcg_bake_options_init(fdcg_bake_options* options, uint32_t struct_bytes) {
  fdcg_bake_options defaults = {};
  defaults.real_bytes = 8;
  defaults.metres_per_unit = 1;
  defaults.merges = 1;
  fdcg::bake::fill(options, defaults, struct_bytes);
}

extern "C" void fdcg_baked_init(fdcg_baked* baked, uint32_t struct_bytes) {
  fdcg::bake::fill(baked, fdcg_baked{}, struct_bytes);
}

extern "C" fdcg_status fdcg_bake(const double* points, uint64_t point_count, const uint32_t* corners, const uint32_t* sides,
                                 uint64_t face_count, const fdcg_bake_options* options, fdcg_finding* findings,
                                 uint32_t finding_capacity, fdcg_baked* baked, fdcg_error* error) {
  using namespace fdcg::bake;
  if ((points == nullptr && point_count > 0) || (corners == nullptr && face_count > 0) || options == nullptr ||
      baked == nullptr || (findings == nullptr && finding_capacity > 0)) {
    return refuse(error, FDCG_E_ARGUMENT, "points, corners, options, findings or baked: null pointer");
  }
  if (!is_size(*baked)) return refuse(error, FDCG_E_ARGUMENT, "baked.struct_bytes: start from fdcg_make_baked()");
  if (!is_size(*options)) return refuse(error, FDCG_E_ARGUMENT, "options.struct_bytes: start from fdcg_make_bake_options()");
  const std::uint32_t baked_bytes = baked->struct_bytes;
  fdcg_bake_options defaults;
  fdcg_bake_options_init(&defaults, sizeof defaults);
  const fdcg_bake_options whole = in_full(*options, defaults);
  if (whole.real_bytes != 8 && whole.real_bytes != 4)
    return refuse(error, FDCG_E_ARGUMENT, "options.real_bytes: allowed 8 and 4");
  if (!(whole.quantum >= 0 && whole.quantum <= 1e60))
    return refuse(error, FDCG_E_ARGUMENT, "options.quantum: allowed 0 to 1e60");
  if (whole.reserved != 0) return refuse(error, FDCG_E_ARGUMENT, "options.reserved: allowed 0");
  const Input input = {points, point_count, corners, sides, face_count};
  if (!fits(input)) return refuse(error, FDCG_E_ARGUMENT, "points, faces or corners: more than 2^32 - 2");
  fdcg_baked result = {};
  fdcg_status status;
  try {
    status = compile_for_c(input, whole, findings, finding_capacity, &result, error);
  } catch (const std::bad_alloc&) {
    status = refuse(error, FDCG_E_MEMORY, "there is no memory left");
  } catch (const std::exception& fault) {
    status = refuse(error, FDCG_E_ARGUMENT, std::string("a fault of the compiler: ") + fault.what());
  }
  fill(baked, result, baked_bytes);
  return status;
}

extern "C" void fdcg_baked_free(fdcg_baked* baked) {
  if (baked == nullptr) return;
  std::free(baked->bytes);
  fdcg_baked_init(baked, baked->struct_bytes);
}
