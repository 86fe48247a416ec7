// SPDX-License-Identifier: Apache-2.0
// The number arrays of VTK's XML files: text, or bytes that stand in base64 in the array itself, or in base64 or raw behind all
// of the XML; compressed with zlib or not.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "import/printed_precision.hpp"
#include "import/xml_file.hpp"

namespace fdcg::bake::vtp {

// Numbers of one type, as bytes.
class Block {
 public:
  enum class Kind { whole, natural, real };

  Block(std::string bytes, Kind kind, std::size_t width, bool is_big_endian)
      : bytes_(std::move(bytes)), kind_(kind), width_(width), is_big_endian_(is_big_endian) {}
  [[nodiscard]] std::size_t size() const { return bytes_.size() / width_; }
  [[nodiscard]] bool is_real() const { return kind_ == Kind::real; }
  [[nodiscard]] double real(std::size_t i) const;
  [[nodiscard]] std::int64_t whole(std::size_t i) const;  // of kinds that are not real; beyond int64: its largest

 private:
  [[nodiscard]] std::uint64_t bits(std::size_t i) const;

  std::string bytes_;
  Kind kind_;
  std::size_t width_;
  bool is_big_endian_;
};

class Arrays {
 public:
  // All of a file, which outlives this. Throws Refusal.
  explicit Arrays(std::string_view bytes);
  Arrays(const Arrays&) = delete;
  Arrays& operator=(const Arrays&) = delete;

  [[nodiscard]] const xml::File& file() const { return *file_; }
  // Of all blocks that were read: they may unpack to 256 kB and 100 bytes for each of the file.
  [[nodiscard]] std::size_t unpacked_bytes() const { return unpacked_; }

  // Calls use(value, printed) for each number of a <DataArray>; returns how many there are.
  template <class Use>
  std::uint64_t for_each_real(const xml::Node& array, const Use& use) {
    const std::optional<Block> block = block_of(array);
    if (!block) return file_->for_each_real(array, use);
    for (std::size_t i = 0; i < block->size(); ++i)
      use(block->real(i), Printed{});
    return block->size();
  }
  // Calls use(value) for each; throws Refusal where they are no whole numbers.
  template <class Use>
  std::uint64_t for_each_whole(const xml::Node& array, const Use& use) {
    const std::optional<Block> block = block_of(array);
    if (!block) return file_->for_each_whole(array, use);
    if (block->is_real()) file_->fail(array, "has numbers of the type Float, and needs whole ones; export the file again");
    for (std::size_t i = 0; i < block->size(); ++i)
      use(block->whole(i));
    return block->size();
  }

 private:
  class Source;
  std::optional<Block> block_of(const xml::Node& array);  // none: it is text
  [[nodiscard]] Source source_of(const xml::Node& array) const;
  std::string take(Source& source, std::uint64_t count, const xml::Node& array) const;
  std::uint64_t take_word(Source& source, const xml::Node& array) const;
  std::string unpack(Source& source, const xml::Node& array);
  std::string inflate(Source& source, const xml::Node& array);
  void charge(std::uint64_t bytes, const xml::Node& array);

  std::string head_;           // the XML where something is appended
  std::string_view appended_;  // what follows the underscore
  std::optional<xml::File> file_;
  bool is_big_endian_ = false, is_appended_raw_ = false;
  std::size_t word_bytes_ = 4;  // of the counts before each block
  std::string compressor_;
  std::size_t room_, unpacked_ = 0;
};

}  // namespace fdcg::bake::vtp
