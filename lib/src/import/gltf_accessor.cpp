// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_accessor.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

namespace fdcg::bake::gltf {
namespace {

std::string accessor_place(Index accessor) {
  return "accessors[" + std::to_string(accessor) + "]";
}

// glTF is little-endian on every machine.
std::uint32_t load(const char* bytes, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  return value;
}

double load_scalar(Component type, bool is_normalized, const char* bytes) {
  const std::uint32_t bits = load(bytes, size_of(type));
  switch (type) {
    case Component::f32:
      return std::bit_cast<float>(bits);
    case Component::u8:
      return is_normalized ? bits / 255.0 : bits;
    case Component::u16:
      return is_normalized ? bits / 65535.0 : bits;
    case Component::i8: {
      const auto value = static_cast<std::int8_t>(bits);
      return is_normalized ? std::max(value / 127.0, -1.0) : value;
    }
    case Component::i16: {
      const auto value = static_cast<std::int16_t>(bits);
      return is_normalized ? std::max(value / 32767.0, -1.0) : value;
    }
    case Component::u32:
      return bits;
  }
  return 0;
}

// The values of a run, after checking that the view contains all of them. `stride` 0: tightly packed.
Strided resolve(const Document& document, const Run& run, std::uint64_t count, Component type, unsigned components,
                const std::string& place, bool uses_stride, Buffers& buffers) {
  const std::string_view bytes = buffers.view(run.view);
  const std::size_t size = size_of(type) * components;
  const std::uint64_t given = uses_stride ? document.views[run.view].stride : 0;
  if (given != 0 && given < size) {
    throw Refusal{"bufferViews[" + std::to_string(run.view) + "].byteStride is " + std::to_string(given) + ", less than the " +
                  std::to_string(size) + " bytes of a value of " + place};
  }
  const std::uint64_t stride = given != 0 ? given : size;
  const std::uint64_t left = run.offset <= bytes.size() ? bytes.size() - run.offset : 0;
  const std::uint64_t there = left >= size ? (left - size) / stride + 1 : 0;
  if (count > there) {
    throw Refusal{"truncated: " + place + " promises " + std::to_string(count) + " values of " + std::to_string(size) +
                  " bytes, bufferViews[" + std::to_string(run.view) + "] holds " + std::to_string(there) + " from byte " +
                  std::to_string(run.offset) + " on; fetch or export the file again"};
  }
  Strided result;
  result.stride = static_cast<std::size_t>(stride);
  result.count = count;
  result.type = type;
  result.first = count > 0 ? bytes.data() + run.offset : nullptr;
  return result;
}

// The replacement values of a sparse accessor.
struct Replacement {
  std::vector<std::uint32_t> places;
  Strided values;
};

Replacement resolve_sparse(const Document& document, Index index, Buffers& buffers) {
  const Accessor& accessor = document.accessors[index];
  Replacement result;
  if (!accessor.sparse) return result;
  const Sparse& sparse = *accessor.sparse;
  const std::string place = accessor_place(index) + ".sparse";
  const Strided places =
      resolve(document, sparse.indices, sparse.count, sparse.index_type, 1, place + ".indices", false, buffers);
  result.values =
      resolve(document, sparse.values, sparse.count, accessor.type, accessor.components, place + ".values", false, buffers);
  result.values.is_normalized = accessor.is_normalized;
  result.places.reserve(static_cast<std::size_t>(sparse.count));
  for (std::uint64_t i = 0; i < sparse.count; ++i) {
    const std::uint32_t at = load(places.first + i * places.stride, size_of(places.type));
    if (at >= accessor.count || (i > 0 && at <= result.places.back())) {
      throw Refusal{place + ".indices: value " + std::to_string(i) + " is " + std::to_string(at) +
                    ", neither above the one before it nor below the accessor's count " + std::to_string(accessor.count)};
    }
    result.places.push_back(at);
  }
  return result;
}

Strided resolve_base(const Document& document, Index index, Buffers& buffers) {
  const Accessor& accessor = document.accessors[index];
  Strided base;
  if (accessor.run) {
    base = resolve(document, *accessor.run, accessor.count, accessor.type, accessor.components, accessor_place(index), true,
                   buffers);
  }
  base.count = accessor.count;
  base.type = accessor.type;
  base.is_normalized = accessor.is_normalized;
  return base;
}

}  // namespace

Positions::Positions(const Document& document, Index accessor, Buffers& buffers)
    : base_(resolve_base(document, accessor, buffers)) {
  Replacement replacement = resolve_sparse(document, accessor, buffers);
  values_ = replacement.values;
  replaced_ = std::move(replacement.places);
}

Vec3 Positions::at(const Strided& values, std::uint64_t i) {
  if (values.first == nullptr) return {0, 0, 0};
  const char* bytes = values.first + i * values.stride;
  const std::size_t size = size_of(values.type);
  return {load_scalar(values.type, values.is_normalized, bytes), load_scalar(values.type, values.is_normalized, bytes + size),
          load_scalar(values.type, values.is_normalized, bytes + 2 * size)};
}

Attribute::Attribute(const Document& document, Index accessor, Buffers& buffers)
    : base_(resolve_base(document, accessor, buffers)), components_(std::min(document.accessors[accessor].components, 4u)) {
  Replacement replacement = resolve_sparse(document, accessor, buffers);
  values_ = replacement.values;
  replaced_ = std::move(replacement.places);
}

std::array<double, 4> Attribute::at(std::uint64_t i) const {
  const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), i);
  const bool is_replaced = found != replaced_.end() && *found == i;
  const Strided& values = is_replaced ? values_ : base_;
  const std::uint64_t place = is_replaced ? static_cast<std::uint64_t>(found - replaced_.begin()) : i;
  std::array<double, 4> result = {1, 1, 1, 1};
  for (unsigned k = 0; k < components_; ++k) {
    const char* const bytes =
        values.first == nullptr ? nullptr : values.first + place * values.stride + k * size_of(values.type);
    result[k] = bytes == nullptr ? 0 : load_scalar(values.type, values.is_normalized, bytes);
  }
  return result;
}

Indices::Indices(const Document& document, Index accessor, Buffers& buffers)
    : base_(resolve_base(document, accessor, buffers)) {
  Replacement replacement = resolve_sparse(document, accessor, buffers);
  replaced_ = std::move(replacement.places);
  for (std::size_t i = 0; i < replaced_.size(); ++i)
    values_.push_back(load(replacement.values.first + i * replacement.values.stride, size_of(base_.type)));
}

std::uint32_t Indices::at(std::uint64_t i) const {
  if (is_plain_) return static_cast<std::uint32_t>(i);
  if (!replaced_.empty()) {
    const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), i);
    if (found != replaced_.end() && *found == i) return values_[static_cast<std::size_t>(found - replaced_.begin())];
  }
  return base_.first == nullptr ? 0 : load(base_.first + i * base_.stride, size_of(base_.type));
}

}  // namespace fdcg::bake::gltf
