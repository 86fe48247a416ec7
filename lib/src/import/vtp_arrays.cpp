// SPDX-License-Identifier: Apache-2.0
#include "import/vtp_arrays.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <new>
#include <vector>

#include "import/soup_reader.hpp"

namespace fdcg::bake::vtp {
namespace {

constexpr std::size_t kFreeBytes = std::size_t{1} << 18, kEachByte = 100;
constexpr const char* kAgain = "; fetch or export the file again";

struct Type {
  std::string_view name;
  Block::Kind kind;
  std::size_t width;
};
constexpr std::array kTypes = {Type{"Float32", Block::Kind::real, 4}, Type{"Float64", Block::Kind::real, 8},
                               Type{"Int8", Block::Kind::whole, 1},   Type{"UInt8", Block::Kind::natural, 1},
                               Type{"Int16", Block::Kind::whole, 2},  Type{"UInt16", Block::Kind::natural, 2},
                               Type{"Int32", Block::Kind::whole, 4},  Type{"UInt32", Block::Kind::natural, 4},
                               Type{"Int64", Block::Kind::whole, 8},  Type{"UInt64", Block::Kind::natural, 8}};

std::uint64_t load_bits(std::string_view bytes, bool is_big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[is_big_endian ? i : bytes.size() - 1 - i]);
  return value;
}

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

}  // namespace

// Bytes from the file, in their order.
class Arrays::Source {
 public:
  Source(std::string_view text, bool is_raw) : text_(text), is_raw_(is_raw) {}

  // The most that can follow.
  [[nodiscard]] std::uint64_t at_most() const { return waiting_.size() + text_.size(); }

  // False: there are not so many.
  bool take(std::size_t count, std::string& out) {
    if (is_raw_) {
      if (count > text_.size()) return false;
      out.assign(text_.substr(0, count));
      text_.remove_prefix(count);
      return true;
    }
    while (waiting_.size() < count && decode_group()) {
    }
    if (waiting_.size() < count) return false;
    out = waiting_.substr(0, count);
    waiting_.erase(0, count);
    return true;
  }

 private:
  // Four characters, of which the last ones may be filled up: then what follows begins anew, as writers do behind a header.
  bool decode_group() {
    std::uint32_t bits = 0;
    int characters = 0, filled = 0;
    while (characters < 4 && !text_.empty()) {
      const char c = text_.front();
      const int value = base64_value(c);
      if (value < 0 && c != '=' && c != ' ' && c != '\n' && c != '\r' && c != '\t') return false;
      text_.remove_prefix(1);
      if (value < 0 && c != '=') continue;
      if (c == '=') ++filled;
      if (c != '=' && filled > 0) return false;
      bits = bits << 6 | static_cast<std::uint32_t>(std::max(value, 0));
      ++characters;
    }
    if (characters < 4 || filled > 2) return false;
    for (int i = 0; i < 3 - filled; ++i)
      waiting_ += static_cast<char>(bits >> (16 - 8 * i) & 0xFF);
    return true;
  }

  std::string_view text_;
  bool is_raw_;
  std::string waiting_;
};

double Block::real(std::size_t i) const {
  if (kind_ == Kind::natural) return static_cast<double>(bits(i));
  if (kind_ == Kind::whole) return static_cast<double>(whole(i));
  return width_ == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits(i))))
                     : std::bit_cast<double>(bits(i));
}

std::int64_t Block::whole(std::size_t i) const {
  const std::uint64_t value = bits(i);
  if (kind_ == Kind::natural)
    return static_cast<std::int64_t>(std::min<std::uint64_t>(value, std::numeric_limits<std::int64_t>::max()));
  const unsigned shift = static_cast<unsigned>(64 - 8 * width_);
  return static_cast<std::int64_t>(value << shift) >> shift;
}

std::uint64_t Block::bits(std::size_t i) const {
  return load_bits(std::string_view(bytes_).substr(i * width_, width_), is_big_endian_);
}

// What is appended may be raw bytes, which are no XML: the file's XML ends with the tag before them.
Arrays::Arrays(std::string_view bytes) : room_(kFreeBytes + kEachByte * bytes.size()) {
  const std::size_t tag = bytes.find("<AppendedData"), end = tag == std::string_view::npos ? tag : bytes.find('>', tag);
  const bool is_appended = end != std::string_view::npos && bytes[end - 1] != '/';
  if (is_appended) {
    head_ = std::string(bytes.substr(0, end + 1)) + "</AppendedData></VTKFile>";
    const std::size_t start = bytes.find_first_not_of(" \t\r\n", end + 1);
    if (start == std::string_view::npos || bytes[start] != '_')
      throw xml::Refusal{"is truncated: no underscore begins its appended data; fetch or export the file again"};
    appended_ = bytes.substr(start + 1);
  }
  file_.emplace(is_appended ? std::string_view(head_) : bytes);
  const xml::Node root = file_->root();
  is_big_endian_ = xml::attribute(root, "byte_order") == "BigEndian";
  word_bytes_ = xml::attribute(root, "header_type") == "UInt64" ? 8 : 4;
  compressor_ = xml::attribute(root, "compressor");
  const xml::Node appended = xml::child(root, "AppendedData");
  const std::string_view encoding = xml::attribute(appended, "encoding");
  is_appended_raw_ = encoding == "raw";
  if (is_appended && encoding != "raw" && encoding != "base64")
    file_->fail(appended, "has the encoding '" + readable_name(encoding) + "'; there are raw and base64" + kAgain);
}

std::optional<Block> Arrays::block_of(const xml::Node& array) {
  const std::string_view format = xml::attribute(array, "format");
  if (!array || format == "ascii") return std::nullopt;
  if (format != "binary" && format != "appended")
    file_->fail(array, "has the format '" + readable_name(format) + "'; there are ascii, binary and appended" + kAgain);
  const std::string_view name = xml::attribute(array, "type");
  const auto* const type = std::find_if(kTypes.begin(), kTypes.end(), [name](const Type& t) { return t.name == name; });
  if (type == kTypes.end()) {
    file_->fail(array, "has numbers of the type '" + readable_name(name) +
                           "', which are not read; write Float32 or Float64, and Int32 or Int64");
  }
  Source source = source_of(array);
  std::string bytes = unpack(source, array);
  if (bytes.size() % type->width != 0) {
    file_->fail(array, "holds " + std::to_string(bytes.size()) + " bytes, not a multiple of the " +
                           std::to_string(type->width) + " of a number" + kAgain);
  }
  return Block(std::move(bytes), type->kind, type->width, is_big_endian_);
}

Arrays::Source Arrays::source_of(const xml::Node& array) const {
  if (xml::attribute(array, "format") == "binary") return {array.child_value(), false};
  const std::uint64_t offset = file_->count(array, "offset", 0);
  if (offset > appended_.size()) {
    file_->fail(array, "has offset " + std::to_string(offset) + ", and " + std::to_string(appended_.size()) +
                           " bytes are appended" + kAgain);
  }
  return {appended_.substr(static_cast<std::size_t>(offset)), is_appended_raw_};
}

std::string Arrays::take(Source& source, std::uint64_t count, const xml::Node& array) const {
  std::string bytes;
  if (count > source.at_most() || !source.take(static_cast<std::size_t>(count), bytes))
    file_->fail(array, "is truncated: it promises " + std::to_string(count) + " bytes more than it holds" + kAgain);
  return bytes;
}

std::uint64_t Arrays::take_word(Source& source, const xml::Node& array) const {
  return load_bits(take(source, word_bytes_, array), is_big_endian_);
}

void Arrays::charge(std::uint64_t bytes, const xml::Node& array) {
  if (bytes > room_ - unpacked_) {
    file_->fail(array, "unpacks to more than the " + std::to_string(room_) +
                           " bytes that all arrays of a file of this size may have; write it without compression");
  }
  unpacked_ += static_cast<std::size_t>(bytes);
}

std::string Arrays::unpack(Source& source, const xml::Node& array) {
  if (!compressor_.empty()) {
    if (compressor_ != "vtkZLibDataCompressor") {
      file_->fail(array, "is compressed with " + readable_name(compressor_) +
                             ", which is not read; write the file with zlib, without compression, or as text");
    }
    return inflate(source, array);
  }
  std::string bytes = take(source, take_word(source, array), array);
  charge(bytes.size(), array);
  return bytes;
}

// How many blocks, the size of each, of the last (0: like the others), then of each as it is packed; then the blocks.
std::string Arrays::inflate(Source& source, const xml::Node& array) {
  const std::uint64_t blocks = take_word(source, array), size = take_word(source, array), rest = take_word(source, array);
  if (blocks == 0) return {};
  if (blocks > source.at_most() / word_bytes_ || rest > size) {
    file_->fail(array, "promises " + std::to_string(blocks) + " blocks of " + std::to_string(size) + " bytes, the last of " +
                           std::to_string(rest) + ", which cannot be" + kAgain);
  }
  if (size > room_ / blocks) charge(room_ + 1, array);
  const std::uint64_t total = rest == 0 ? blocks * size : (blocks - 1) * size + rest;
  charge(total, array);
  std::vector<std::uint64_t> packed(static_cast<std::size_t>(blocks));
  for (std::uint64_t& bytes : packed)
    bytes = take_word(source, array);
  std::string result(static_cast<std::size_t>(total), '\0');
  std::size_t at = 0;
  for (std::size_t b = 0; b < packed.size(); ++b) {
    const std::string bytes = take(source, packed[b], array);
    const std::size_t wanted = std::min<std::size_t>(static_cast<std::size_t>(size), result.size() - at);
    uLongf got = wanted;
    const int status = uncompress(reinterpret_cast<Bytef*>(result.data() + at), &got,
                                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status != Z_OK || got != wanted) file_->fail(array, "has a damaged block " + std::to_string(b) + kAgain);
    at += wanted;
  }
  return result;
}

}  // namespace fdcg::bake::vtp
