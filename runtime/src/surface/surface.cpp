// SPDX-License-Identifier: Apache-2.0
// Checks of a surface's fields. surface_step.cpp steps on it.
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "surface/surface_kinds.hpp"

namespace fdcg {
namespace {

constexpr double kLeast_m = 1e-9, kLargest_m = 1e9, kLeastSizeShare = 1e-4;

enum Field : uint32_t { kRadius = 1, kTop = 2, kTube = 4, kLength = 8, kHalf = 16 };

uint32_t fields_of(uint32_t kind) {
  static const uint32_t kFields[] = {
      0, kRadius, kRadius | kLength, kRadius | kLength, kHalf, kRadius | kTop | kLength, kRadius | kTube, kHalf};
  return kFields[kind];
}

struct Size {
  const char* name;
  double value, high;
  bool may_be_0;
};

Message& say(Message& message, const Size& size, double low) {
  message.say("surface.", size.name, " is ", size.value);
  return message.say(size.may_be_0 ? ", allowed 0 and " : ", allowed ", low, " to ", size.high);
}

fdcg_status refuse_field(const char* field, uint32_t value, const char* allowed, fdcg_error* error) {
  return Message(error, FDCG_E_ARGUMENT).say(field, " is ", value, allowed);
}

constexpr uint32_t kSizes = 7;

// Each size by itself first, so that all are finite when they are compared.
fdcg_status check_sizes(const fdcg_surface& s, fdcg_error* error) {
  const bool is_cone = s.kind == FDCG_SURFACE_CONE;  // one end may be an apex
  const Size sizes[kSizes] = {{"radius_m", s.radius_m, kLargest_m, is_cone && s.top_radius_m != 0},
                              {"top_radius_m", s.top_radius_m, kLargest_m, is_cone && s.radius_m != 0},
                              {"tube_radius_m", s.tube_radius_m, s.radius_m * (1 - kLeastSizeShare), false},
                              {"length_m", s.length_m, kLargest_m, s.kind == FDCG_SURFACE_CAPSULE},
                              {"half_m[0]", s.half_m[0], kLargest_m, false},
                              {"half_m[1]", s.half_m[1], kLargest_m, false},
                              {"half_m[2]", s.half_m[2], kLargest_m, false}};
  const Size* largest = sizes;
  for (uint32_t i = 0; i < kSizes; ++i) {
    const Size& size = sizes[i];
    const bool has = (fields_of(s.kind) >> (i < 4 ? i : 4) & 1) != 0;
    if (has ? (size.value >= kLeast_m && size.value <= size.high) || (size.may_be_0 && size.value == 0) : size.value == 0) {
      if (size.value > largest->value) largest = &size;
      continue;
    }
    Message message(error, FDCG_E_ARGUMENT);
    if (has)
      return say(message, size, kLeast_m)
          .text(is_cone && i < 2 && size.value == 0 ? " (one end may be a point, not both)" : "");
    message.say("surface.", size.name, " is ", size.value);
    return message.text(", allowed 0; a surface of this kind has none");
  }
  for (const Size& size : sizes) {
    if (size.value == 0 || size.value >= kLeastSizeShare * largest->value) continue;
    Message message(error, FDCG_E_ARGUMENT);
    say(message, size, kLeastSizeShare * largest->value).say(" (at least 1e-4 of the largest, ", largest->name);
    return message.say(", ", largest->value, ")");
  }
  return FDCG_OK;
}

}  // namespace
}  // namespace fdcg

using fdcg::Message;

extern "C" fdcg_status fdcg_check_surface(const fdcg_surface* surface, fdcg_error* error) {
  if (surface == nullptr) return Message(error, FDCG_E_ARGUMENT).text("surface: null pointer");
  if (const fdcg_status status = fdcg::check_struct_bytes(surface->struct_bytes, sizeof(fdcg_surface), "surface",
                                                          "; start from fdcg_make_sphere() or the like", error);
      status != FDCG_OK) {
    return status;
  }
  fdcg_surface room;
  const fdcg_surface& whole = fdcg::in_full(*surface, &room, fdcg::clear_surface);
  if (whole.kind > FDCG_SURFACE_ELLIPSOID)
    return fdcg::refuse_field("surface.kind", whole.kind, ", allowed are the values of fdcg_surface_kind: 0 to 7", error);
  if (!fdcg::is_linked(whole.kind)) {
    return fdcg::refuse_field(
        "surface.kind", whole.kind,
        ", which this program does not link; start from fdcg_make_sphere() or the like, or fdcg_make_surface()", error);
  }
  const bool is_plane = whole.kind == FDCG_SURFACE_PLANE;
  if (whole.is_hollow > (is_plane ? 0u : 1u)) {
    return fdcg::refuse_field("surface.is_hollow", whole.is_hollow,
                              is_plane ? ", allowed 0: turn the plane round by its pose" : ", allowed 0 and 1", error);
  }
  if (whole.reserved != 0) return fdcg::refuse_field("surface.reserved", whole.reserved, ", allowed 0", error);
  return fdcg::check_sizes(whole, error);
}
