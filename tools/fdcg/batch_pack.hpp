// SPDX-License-Identifier: Apache-2.0
// Texts by the hash that they are asked by, in few files: a file for each text would cost more than the work on a small mesh.
// Each process that writes appends to a pack of its own, and to an index beside it; nothing that another one wrote is changed,
// so that processes and machines may share a folder without locks. Each text is kept with a hash of it and of its key: one that
// is cut, altered or not what the index says counts as none.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace fdcg::tools {

struct PackedText {
  std::string text, bytes;
};

class BatchPacks {
 public:
  // Reads the indices that are there: 48 bytes a text. What others append later is not seen.
  explicit BatchPacks(std::string folder);

  // `key`: 64 hexadecimal digits. Where several were put, one that is whole.
  [[nodiscard]] std::optional<PackedText> get(const std::string& key) const;
  // Why it cannot be written, or nothing. `sha256`: of `bytes`, in hexadecimal digits; empty where there are none.
  std::string put(const std::string& key, const std::string& text, const std::string& bytes = {},
                  const std::string& sha256 = {});

 private:
  using Key = std::array<char, 32>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  struct Place {
    std::uint32_t pack = 0;
    std::uint64_t offset = 0, bytes = 0;
  };
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Closer>;

  static Key binary(const std::string& key);
  void read_index(const std::string& pack);
  std::string begin_pack();

  std::string folder_;
  std::vector<std::string> packs_;  // without .pack
  std::unordered_multimap<Key, Place, KeyHash> places_;
  File pack_, index_;  // of this process; null until something is put
  std::uint64_t written_ = 0;
};

}  // namespace fdcg::tools
