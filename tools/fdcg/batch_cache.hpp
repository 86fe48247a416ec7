// SPDX-License-Identifier: Apache-2.0
// What was done before, by what it was done from: an entry's key is the hash of a mesh file's bytes, of those it refers to, of
// the options and of the program. Entries are checked by their content, so that one that is half-written, forged by a slip or
// changed since counts as none. Several processes and machines may share a folder (batch_pack.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "batch_pack.hpp"

namespace fdcg::tools {

struct CacheEntry {
  int exit_code = 0;
  std::string said;    // for people: what was found; empty: nothing
  std::string body;    // members of the result's line
  std::string output;  // the bytes of the file that was written, if any
  std::string output_sha256{};
  bool has_output = false;
};

class BatchCache {
 public:
  explicit BatchCache(std::string folder) : packs_(std::move(folder)) {}

  [[nodiscard]] std::optional<CacheEntry> load(const std::string& key) const;
  // A cache that cannot be written costs time only: trouble() keeps the first reason.
  void store(const std::string& key, const CacheEntry& entry);
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

  // The files that a mesh with this key refers to, as it names them; empty: none, or nothing is known.
  [[nodiscard]] std::vector<std::string> references(const std::string& key) const;
  void store_references(const std::string& key, const std::vector<std::string>& files);

 private:
  BatchPacks packs_;
  std::string trouble_;
};

// Hash of the program that runs: its version, the format's, and the build. Entries of another one are not used.
std::string program_identity();

}  // namespace fdcg::tools
