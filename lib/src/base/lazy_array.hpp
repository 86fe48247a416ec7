// SPDX-License-Identifier: Apache-2.0
// An array of numbers, each with its own initial value, of which few are ever changed. Untouched entries cost address space
// only, so that a stage whose work is local does not pay for the whole mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

namespace fdcg::bake {

// `Default` gives the initial value of entry i. Cells store the exclusive or with it and so start at zero, which the operating
// system provides without touching the memory.
template <class Default>
class LazyArray {
 public:
  LazyArray() = default;
  explicit LazyArray(std::size_t count) : cells_(static_cast<std::uint32_t*>(std::calloc(count + 1, sizeof(std::uint32_t)))) {
    if (!cells_) throw std::bad_alloc();
  }
  [[nodiscard]] std::uint32_t operator[](std::size_t i) const { return cells_[i] ^ Default()(static_cast<std::uint32_t>(i)); }
  void set(std::size_t i, std::uint32_t value) { cells_[i] = value ^ Default()(static_cast<std::uint32_t>(i)); }

 private:
  struct Free {
    void operator()(std::uint32_t* memory) const { std::free(memory); }
  };
  std::unique_ptr<std::uint32_t[], Free> cells_;
};

}  // namespace fdcg::bake
