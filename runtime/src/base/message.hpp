// SPDX-License-Identifier: Apache-2.0
// Builds the line of an fdcg_error, piece by piece, in the caller's memory: no heap, no stdio. Truncated where it would not
// fit. Out of line and cold: there are many refusals, rarely executed, and their text is most of the code of loading. Without
// FDCG_WITH_MESSAGES the line is that of fdcg_status_text, and none of the words below is in the library.
#pragma once

#include "base/config.hpp"
#include "fdcg/fdcg.h"

namespace fdcg {

#if FDCG_WITH_MESSAGES

class Message {
 public:
  // `error` may be null: then nothing is written.
  [[gnu::cold]] Message(fdcg_error* error, fdcg_status status, uint64_t offset = 0);
  [[gnu::cold]] Message& text(const char* words);
  // At most `limit` bytes of a text from the caller or a file.
  [[gnu::cold]] Message& quoted(const char* words, int limit);
  [[gnu::cold]] Message& number(uint64_t value);
  // Six decimals, with a power of ten where the number is very large or small: enough to see what is wrong with a setting.
  [[gnu::cold]] Message& real(double value);
  // Pieces in their order: a text, a whole number, a real number.
  template <class... Pieces>
  [[gnu::always_inline]] inline Message& say(Pieces... pieces) {
    return (add(pieces), ..., *this);
  }
  operator fdcg_status() const { return status_; }  // NOLINT(google-explicit-constructor): `return Message(...).say(...)`

 private:
  [[gnu::always_inline]] inline void add(const char* words) { text(words); }
  [[gnu::always_inline]] inline void add(char* words) { text(words); }
  template <class Number>
  [[gnu::always_inline]] inline void add(Number value) {
    constexpr bool kIsReal = static_cast<Number>(0.5) != 0;
    if constexpr (kIsReal) {
      real(value);
    } else {
      number(static_cast<uint64_t>(value));
    }
  }
  void put(char c);

  fdcg_error* error_;
  fdcg_status status_;
  uint32_t used_ = 0;
};

[[gnu::cold]] fdcg_status refuse(fdcg_error* error, fdcg_status status, const char* what);
// FDCG_E_ARGUMENT: `what`; or a field's value out of its range.
[[gnu::cold]] fdcg_status refuse(fdcg_error* error, const char* what);
[[gnu::cold]] fdcg_status refuse(fdcg_error* error, const char* field, double value, double low, double high);

#else

// One call of few arguments, without the words that its callers would have to bring. Returns the status.
[[gnu::cold]] fdcg_status refuse_silently(fdcg_error* error, fdcg_status status);
[[gnu::cold]] fdcg_status refuse_silently_at(uint64_t offset, fdcg_error* error, fdcg_status status);

class Message {
 public:
  Message(fdcg_error* error, fdcg_status status) : status_(refuse_silently(error, status)) {}
  Message(fdcg_error* error, fdcg_status status, uint64_t offset) : status_(refuse_silently_at(offset, error, status)) {}
  Message& text(const char*) { return *this; }
  Message& quoted(const char*, int) { return *this; }
  Message& number(uint64_t) { return *this; }
  Message& real(double) { return *this; }
  template <class... Pieces>
  Message& say(Pieces...) {
    return *this;
  }
  operator fdcg_status() const { return status_; }  // NOLINT(google-explicit-constructor): as above

 private:
  fdcg_status status_;
};

inline fdcg_status refuse(fdcg_error* error, fdcg_status status, const char*) {
  return refuse_silently(error, status);
}
inline fdcg_status refuse(fdcg_error* error, const char*) {
  return refuse_silently(error, FDCG_E_ARGUMENT);
}
inline fdcg_status refuse(fdcg_error* error, const char*, double, double, double) {
  return refuse_silently(error, FDCG_E_ARGUMENT);
}

#endif

}  // namespace fdcg
