// SPDX-License-Identifier: Apache-2.0
// Public structs that callers fill in start with `uint32_t struct_bytes`, the caller's sizeof. Rule: fields are only appended,
// in multiples of 8 bytes, and a field missing in the caller's header has its default. So a program built against an older
// header works with a newer library; the reverse is refused where parameters are checked.
#pragma once

#include <stddef.h>
#include <string.h>

#include "base/message.hpp"
#include "fdcg/fdcg.h"

namespace fdcg {

inline constexpr uint32_t kSmallestStruct = 8;  // struct_bytes itself and the field beside it

// `given` where it is whole; else its fields over the defaults, in *room. Init: void(Struct*, uint32_t struct_bytes).
template <class Struct, class Init>
inline const Struct& in_full(const Struct& given, Struct* room, Init init) {
  if (given.struct_bytes == sizeof(Struct)) return given;
  init(room, uint32_t{sizeof(Struct)});
  memcpy(static_cast<void*>(room), &given, given.struct_bytes < sizeof(Struct) ? given.struct_bytes : sizeof(Struct));
  room->struct_bytes = sizeof(Struct);
  return *room;
}

// Writes the defaults' first `struct_bytes` bytes over *to, which may be null; what lies beyond the library's own struct is
// left as it is: such a struct is refused where it is checked.
template <class Struct>
inline void fill_defaults(Struct* to, const Struct& defaults, uint32_t struct_bytes) {
  static_assert(offsetof(Struct, struct_bytes) == 0);
  if (to == nullptr) return;
  const uint32_t known = struct_bytes < sizeof(Struct) ? struct_bytes : uint32_t{sizeof(Struct)};
  memcpy(static_cast<void*>(to), &defaults, known);
  if (known < sizeof struct_bytes) {
    memcpy(static_cast<void*>(to), &struct_bytes, known);
  } else {
    to->struct_bytes = struct_bytes;
  }
}

// `what` names the struct and how to start from its defaults.
inline fdcg_status check_struct_bytes(uint32_t struct_bytes, uint64_t library_bytes, const char* name, const char* remedy,
                                      fdcg_error* error) {
  if (struct_bytes >= kSmallestStruct && struct_bytes <= library_bytes && struct_bytes % 8 == 0) return FDCG_OK;
  return Message(error, FDCG_E_ARGUMENT)
      .say(name, ".struct_bytes is ", struct_bytes, ", allowed are multiples of 8 up to this library's ", library_bytes,
           struct_bytes > library_bytes ? "; the library is older than the header: update it" : remedy);
}

}  // namespace fdcg
