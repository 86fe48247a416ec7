// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace fdcg::bake {

// An array whose items have no value at first: each is written before it is read. Large arrays are so touched for the first
// time by the threads that fill them, and only once.
template <class Item>
class RawArray {
  static_assert(std::is_trivially_default_constructible_v<Item> && std::is_trivially_destructible_v<Item>);

 public:
  RawArray() = default;
  explicit RawArray(std::size_t size) : items_(std::make_unique_for_overwrite<Item[]>(size)), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Item* data() { return items_.get(); }
  [[nodiscard]] const Item* data() const { return items_.get(); }
  Item& operator[](std::size_t i) { return items_[i]; }
  const Item& operator[](std::size_t i) const { return items_[i]; }
  [[nodiscard]] const Item* begin() const { return data(); }
  [[nodiscard]] const Item* end() const { return data() + size_; }

 private:
  std::unique_ptr<Item[]> items_;
  std::size_t size_ = 0;
};

}  // namespace fdcg::bake
