// SPDX-License-Identifier: Apache-2.0
// The values of accessors, read in place and checked against their bytes before anything is allocated for them.
#pragma once

#include <cstdint>
#include <vector>

#include "import/gltf_buffers.hpp"
#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

// Values of `components` scalars each, `stride` bytes apart.
struct Strided {
  const char* first = nullptr;  // null: all zeros
  std::size_t stride = 0;
  std::uint64_t count = 0;
  Component type = Component::f32;
  bool is_normalized = false;
};

// Positions in the mesh's own frame, exactly as the file has them.
class Positions {
 public:
  // Checks all preconditions of at(). Throws Refusal.
  Positions(const Document& document, Index accessor, Buffers& buffers);

  [[nodiscard]] std::uint64_t count() const { return base_.count; }
  [[nodiscard]] Component type() const { return base_.type; }
  [[nodiscard]] bool is_normalized() const { return base_.is_normalized; }

  // Calls use(point) for the points in order.
  template <class Use>
  void for_each(const Use& use) const {
    std::size_t next = 0;  // replacement
    for (std::uint64_t i = 0; i < base_.count; ++i) {
      if (next < replaced_.size() && replaced_[next] == i) {
        use(at(values_, next++));
      } else {
        use(at(base_, i));
      }
    }
  }

 private:
  static Vec3 at(const Strided& values, std::uint64_t i);

  Strided base_, values_;
  std::vector<std::uint32_t> replaced_;  // ascending; of a sparse accessor
};

// Values of up to four components, read in any order: texture coordinates, colours.
class Attribute {
 public:
  Attribute(const Document& document, Index accessor, Buffers& buffers);

  [[nodiscard]] std::uint64_t count() const { return base_.count; }
  [[nodiscard]] unsigned components() const { return components_; }
  // Below count(); components that are not there are 1.
  [[nodiscard]] std::array<double, 4> at(std::uint64_t i) const;

 private:
  Strided base_, values_;
  unsigned components_;
  std::vector<std::uint32_t> replaced_;  // ascending; of a sparse accessor
};

// Vertex numbers.
class Indices {
 public:
  Indices(const Document& document, Index accessor, Buffers& buffers);
  explicit Indices(std::uint64_t count) : is_plain_(true) { base_.count = count; }  // 0, 1, 2, ...

  [[nodiscard]] std::uint64_t count() const { return base_.count; }
  [[nodiscard]] std::uint32_t at(std::uint64_t i) const;

 private:
  Strided base_;
  bool is_plain_ = false;
  std::vector<std::uint32_t> replaced_, values_;  // of a sparse accessor: replaced_ ascending
};

}  // namespace fdcg::bake::gltf
