// SPDX-License-Identifier: Apache-2.0
// What was done before, by what it was done from: an entry's key is the hash of a mesh file's bytes, of those it refers to, of the
// options and of the program. Entries are checked by their content, so that one that is half-written, forged by a slip or changed
// since counts as none. Several processes and machines may share a folder.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fdcg::tools {

struct CacheEntry {
  int exit_code = 0;
  std::string said;    // for people: what was found; empty: nothing
  std::string body;    // members of the result's line
  std::string output;  // the bytes of the file that was written, if any
  bool has_output = false;
};

class BatchCache {
 public:
  explicit BatchCache(std::string folder) : folder_(std::move(folder)) {}

  [[nodiscard]] std::optional<CacheEntry> load(const std::string& key) const;
  // Appears whole or not at all. A cache that cannot be written costs time only: trouble() keeps the first reason.
  void store(const std::string& key, const CacheEntry& entry);
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

  // The files that a mesh with this key refers to, as it names them; empty: none, or nothing is known.
  [[nodiscard]] std::vector<std::string> references(const std::string& key) const;
  void store_references(const std::string& key, const std::vector<std::string>& files);

  // Removes what processes that were killed a day ago or longer left unfinished.
  void sweep() const;

 private:
  [[nodiscard]] std::string path_of(const std::string& key) const;
  void write(const std::string& key, const std::string& content);

  std::string folder_;
  std::string trouble_;
  unsigned long written_ = 0;
};

// Hash of the program that runs: its version, the format's, and the build. Entries of another one are not used.
std::string program_identity();

}  // namespace fdcg::tools
