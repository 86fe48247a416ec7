// SPDX-License-Identifier: Apache-2.0
// Binary PLY bodies. Two layouts cover nearly all files and have fast paths: vertices whose x, y, z have one type, and faces
// with one list of 32-bit indices, most of them triangles. Everything else is read value by value.
#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "import/import_ply.hpp"
#include "import/ply_extras.hpp"

namespace fdcg::bake::ply {
namespace {

template <std::unsigned_integral T>
T swapped(T value) {
  T result = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    result = static_cast<T>(result << 8 | (value & 0xFF));
    value = static_cast<T>(value >> 8);
  }
  return result;
}

template <class T, bool kSwap>
T load(const char* bytes) {
  using Bits = std::conditional_t<
      sizeof(T) == 1, std::uint8_t,
      std::conditional_t<sizeof(T) == 2, std::uint16_t, std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;
  Bits bits{};
  std::memcpy(&bits, bytes, sizeof bits);
  if constexpr (kSwap && sizeof(T) > 1) bits = swapped(bits);
  return std::bit_cast<T>(bits);
}

// Any scalar; each of the types is exact in a double.
template <bool kSwap>
double load_scalar(Scalar type, const char* bytes) {
  switch (type) {
    case Scalar::i8:
      return load<std::int8_t, kSwap>(bytes);
    case Scalar::u8:
      return load<std::uint8_t, kSwap>(bytes);
    case Scalar::i16:
      return load<std::int16_t, kSwap>(bytes);
    case Scalar::u16:
      return load<std::uint16_t, kSwap>(bytes);
    case Scalar::i32:
      return load<std::int32_t, kSwap>(bytes);
    case Scalar::u32:
      return load<std::uint32_t, kSwap>(bytes);
    case Scalar::f32:
      return load<float, kSwap>(bytes);
    case Scalar::f64:
      return load<double, kSwap>(bytes);
  }
  return 0;
}

template <bool kSwap>
class BinaryBody : SoupReader {
 public:
  BinaryBody(const MeshText& input, const Header& header)
      : SoupReader(input, Format::ply),
        header_(header),
        p_(input.bytes.data() + header.body_offset),
        end_(input.bytes.data() + input.bytes.size()) {}

  Result<PolygonSoup> read() {
    bool is_read = true;
    for (const ElementKind& element : header_.elements)
      is_read = is_read && read_element(element);
    extras_.spread(soup_);
    return result(is_read && check_end());
  }

 private:
  static constexpr std::size_t kBlock =
      512;  // rows turned at a time, in the first-level cache, so that no memory is zeroed first

  [[nodiscard]] std::size_t left() const { return static_cast<std::size_t>(end_ - p_); }
  [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(p_ - input_.bytes.data()); }

  // Checks that the file has the minimum number of bytes of the element before anything is reserved or read.
  bool read_element(const ElementKind& element) {
    const std::size_t row_bytes = element.least_bytes();
    if (row_bytes == 0) return true;
    if (element.kind == Kind::other) ignore(ignored_name(element), element.count);
    const std::uint64_t possible = left() / row_bytes;
    if (element.count > possible) {
      return fail("truncated: byte " + std::to_string(offset()) + ": the header promises " + std::to_string(element.count) +
                  " rows of element '" + element.name.substr(0, 32) + "' of " + (element.has_lists() ? "at least " : "") +
                  std::to_string(row_bytes) + " bytes, the " + std::to_string(left()) + " bytes left hold " +
                  std::to_string(possible) + "; fetch or export it again");
    }
    if (element.kind == Kind::vertex) {
      soup_.points.reserve(static_cast<std::size_t>(element.count));
      if (!element.has_lists()) return read_fixed_vertices(element);
    } else if (!element.has_lists()) {
      p_ += element.count * row_bytes;
      return true;
    } else if (element.kind == Kind::face) {
      return read_faces(element);
    }
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (!read_row(element, row)) return false;
      advance(offset());
    }
    return true;
  }

  // ---- vertices whose rows all have the same size: the bytes are known to be present

  bool read_fixed_vertices(const ElementKind& element) {
    std::array<std::size_t, 3> at{};
    std::array<Scalar, 3> type{};
    std::size_t row_bytes = 0;
    for (const Property& property : element.properties) {
      if (property.role != Role::none && !is_extra(property.role)) {
        const std::size_t k = static_cast<std::size_t>(property.role) - static_cast<std::size_t>(Role::x);
        at[k] = row_bytes;
        type[k] = property.value;
      }
      row_bytes += size_of(property.value);
    }
    read_fixed_extras(element, row_bytes);
    const auto all = [&type](Scalar wanted) { return type[0] == wanted && type[1] == wanted && type[2] == wanted; };
    if (all(Scalar::f32)) {
      soup_.relative_quantum = 0x1p-24;
      convert_vertices(element.count, row_bytes, [at](const char* row) -> Vec3 {
        return {load<float, kSwap>(row + at[0]), load<float, kSwap>(row + at[1]), load<float, kSwap>(row + at[2])};
      });
    } else if (all(Scalar::f64)) {
      convert_vertices(element.count, row_bytes, [at](const char* row) -> Vec3 {
        return {load<double, kSwap>(row + at[0]), load<double, kSwap>(row + at[1]), load<double, kSwap>(row + at[2])};
      });
    } else {
      convert_vertices(element.count, row_bytes, [at, type](const char* row) -> Vec3 {
        return {load_scalar<kSwap>(type[0], row + at[0]), load_scalar<kSwap>(type[1], row + at[1]),
                load_scalar<kSwap>(type[2], row + at[2])};
      });
    }
    return true;
  }

  // Of all rows, before the points are read.
  void read_fixed_extras(const ElementKind& element, std::size_t row_bytes) {
    extras_.begin(element);
    std::size_t at = 0;
    for (const Property& property : element.properties) {
      for (std::size_t row = 0; is_extra(property.role) && row < element.count; ++row)
        extras_.set(row, property, load_scalar<kSwap>(property.value, p_ + row * row_bytes + at));
      at += size_of(property.value);
    }
  }

  template <class Convert>
  void convert_vertices(std::uint64_t count, std::size_t row_bytes, Convert convert) {
    std::array<Vec3, kBlock> block;
    while (count > 0) {
      const std::size_t n = static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, count));
      for (std::size_t i = 0; i < n; ++i, p_ += row_bytes)
        block[i] = convert(p_);
      soup_.points.insert(soup_.points.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(n));
      count -= n;
      advance(offset());
    }
  }

  // ---- faces

  // Where the one list of a face's row stands, if its numbers have 32 bits.
  struct TriangleRow {
    bool is_usable = false;
    std::size_t before = 0, after = 0;  // bytes of the other properties
    Scalar count = Scalar::u8;
    std::uint32_t index_limit = 0;  // indices from here on are invalid
  };

  [[nodiscard]] TriangleRow triangle_row(const ElementKind& element) const {
    TriangleRow row;
    std::size_t lists = 0;
    for (const Property& property : element.properties) {
      if (property.is_list) {
        ++lists;
        row.count = property.count;
        row.is_usable = property.role == Role::indices && (property.value == Scalar::i32 || property.value == Scalar::u32);
        constexpr std::uint64_t kNegative = std::uint64_t{1} << 31;
        const std::uint64_t limit =
            property.value == Scalar::i32 ? std::min(header_.vertex_count, kNegative) : header_.vertex_count;
        row.index_limit = static_cast<std::uint32_t>(limit);
      } else {
        (lists == 0 ? row.before : row.after) += size_of(property.value);
      }
    }
    row.is_usable = row.is_usable && lists == 1;
    return row;
  }

  bool read_faces(const ElementKind& element) {
    const auto rows = static_cast<std::size_t>(element.count);
    soup_.face_first.reserve(soup_.face_first.size() + rows);
    soup_.corners.reserve(soup_.corners.size() + std::min(rows * 3, left()));
    const TriangleRow triangle = triangle_row(element);
    for (std::uint64_t row = 0; row < element.count;) {
      std::size_t taken = 0;
      if (triangle.is_usable && element.count - row >= kBlock && soup_.corners.size() + 3 * kBlock <= kMaxCorners) {
        if (triangle.count == Scalar::u8 || triangle.count == Scalar::i8) taken = take_triangles<std::uint8_t>(triangle);
        if (triangle.count == Scalar::u32 || triangle.count == Scalar::i32) taken = take_triangles<std::uint32_t>(triangle);
      }
      // A block that contains another polygon is read face by face as a whole, so that mixed meshes cost one failed try per
      // block.
      const std::uint64_t next = taken > 0 ? row + taken : std::min<std::uint64_t>(row + kBlock, element.count);
      for (row += taken; row < next; ++row) {
        if (!read_row(element, row)) return false;
      }
      advance(offset());
    }
    return true;
  }

  // Reads kBlock faces if all of them are triangles; else reads nothing and returns 0.
  template <class Count>
  std::size_t take_triangles(const TriangleRow& row) {
    const std::size_t list_at = row.before + sizeof(Count), bytes = list_at + 12 + row.after;
    if (left() < kBlock * bytes) return 0;
    std::array<std::uint32_t, 3 * kBlock> corners;
    std::array<std::uint32_t, kBlock> ends;
    Count other = 0;
    auto end = static_cast<std::uint32_t>(soup_.corners.size());
    const char* p = p_;
    for (std::size_t i = 0; i < kBlock; ++i, p += bytes) {
      other = static_cast<Count>(other | (load<Count, kSwap>(p + row.before) ^ Count{3}));
      for (std::size_t k = 0; k < 3; ++k) {
        const auto index = load<std::uint32_t, kSwap>(p + list_at + 4 * k);
        corners[3 * i + k] = index < row.index_limit ? index : PolygonSoup::kInvalidVertex;
      }
      ends[i] = end += 3;
    }
    if (other != 0) return 0;
    p_ = p;
    soup_.corners.insert(soup_.corners.end(), corners.begin(), corners.end());
    soup_.face_first.insert(soup_.face_first.end(), ends.begin(), ends.end());
    return kBlock;
  }

  // ---- any row, value by value

  bool read_row(const ElementKind& element, std::uint64_t row) {
    Vec3 point;
    for (const Property& property : element.properties) {
      if (property.is_list) {
        if (!read_list(element, row, property)) return false;
        continue;
      }
      const std::size_t bytes = size_of(property.value);
      if (left() < bytes) return fail_end(element, row, bytes);
      if (property.role != Role::none) {
        component_of(point, property.role) = load_scalar<kSwap>(property.value, p_);
      }
      p_ += bytes;
    }
    if (element.kind == Kind::vertex) soup_.points.push_back(point);
    return true;
  }

  bool read_list(const ElementKind& element, std::uint64_t row, const Property& property) {
    const std::size_t count_bytes = size_of(property.count), value_bytes = size_of(property.value);
    if (left() < count_bytes) return fail_end(element, row, count_bytes);
    const double count = load_scalar<kSwap>(property.count, p_);
    if (!(count >= 0 && count <= 0x1p32) || count != std::floor(count)) {
      return fail("byte " + std::to_string(offset()) + ": " + row_name(element, row) + " has a list with the count " +
                  std::to_string(count) + ", not a whole number of 0 or more");
    }
    p_ += count_bytes;
    const auto n = static_cast<std::uint64_t>(count);
    if (element.kind == Kind::face && property.role == Role::indices && n > kMaxFaceCorners) return fail_big_face(n);
    if (left() / value_bytes < n) return fail_end(element, row, n * value_bytes);
    const char* const values = p_;
    p_ += n * value_bytes;
    if (property.role != Role::indices) return true;
    return element.kind == Kind::face ? add_face(property.value, values, n) : add_strips(property.value, values, n);
  }

  bool add_face(Scalar type, const char* values, std::uint64_t n) {
    for (std::uint64_t k = 0; k < n; ++k)
      soup_.corners.push_back(resolve(load_scalar<kSwap>(type, values + k * size_of(type))));
    return close_face();
  }

  bool add_strips(Scalar type, const char* values, std::uint64_t n) {
    StripDecoder strip;
    for (std::uint64_t k = 0; k < n; ++k) {
      const double number = load_scalar<kSwap>(type, values + k * size_of(type));
      if (ends_strip(number, type, header_.vertex_count)) {
        if (!strip.restart()) ignore(kShortStrips);
      } else if (strip.add(resolve(number))) {
        if (strip.is_joint()) {
          ignore(kStripJoints);
          continue;
        }
        const auto corners = strip.corners();
        soup_.corners.insert(soup_.corners.end(), corners.begin(), corners.end());
        if (!close_face()) return false;
      }
    }
    if (!strip.restart()) ignore(kShortStrips);
    return true;
  }

  [[nodiscard]] std::uint32_t resolve(double number) const {
    const bool is_known = number >= 0 && number < static_cast<double>(header_.vertex_count) && number == std::floor(number);
    return is_known ? static_cast<std::uint32_t>(number) : PolygonSoup::kInvalidVertex;
  }

  bool fail_end(const ElementKind& element, std::uint64_t row, std::uint64_t bytes) {
    return fail("truncated: byte " + std::to_string(offset()) + ": " + row_name(element, row) + " needs " +
                std::to_string(bytes) + " more bytes, the file has " + std::to_string(left()) + "; fetch or export it again");
  }

  // Zeros and ends of lines after the last row are padding; anything else would be rows that the header leaves out.
  bool check_end() {
    while (p_ != end_ && (*p_ == '\0' || *p_ == '\n' || *p_ == '\r'))
      ++p_;
    return p_ == end_ || fail("byte " + std::to_string(offset()) + ": " + std::to_string(left()) +
                              " bytes follow the last row that the header promises; correct the counts in the header");
  }

  const Header& header_;
  VertexExtras extras_;
  const char* p_;
  const char* end_;
};

}  // namespace

Result<PolygonSoup> read_binary_body(const MeshText& input, const Header& header) {
  const bool is_little = header.encoding == Encoding::little_endian;
  if (is_little == (std::endian::native == std::endian::little)) return BinaryBody<false>(input, header).read();
  return BinaryBody<true>(input, header).read();
}

}  // namespace fdcg::bake::ply
