// SPDX-License-Identifier: Apache-2.0
// Findings that are known: those of an earlier report, by their fingerprints.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

// How often each fingerprint was found under a rule of a file.
using Fingerprints = std::unordered_map<std::uint64_t, std::uint64_t>;

struct BaselineFile {
  std::string path;
  std::map<std::string, Fingerprints> rules;
};

// A JSON report with every finding listed: one that --full wrote, or one short enough.
class Baseline {
 public:
  // Keeps the fingerprints only. Fails (3) where the file cannot be read or is no such report, (2) where it lacks findings.
  static bake::Result<Baseline> read(const std::string& path);

  // For each mesh of a run its file of the baseline, or null: the one of the same path; of those left over the one of the same
  // file name, if there is but one; then of the same name without its ending; then, if one mesh and one file are left, these.
  [[nodiscard]] std::vector<const BaselineFile*> files_for(const std::vector<std::string>& meshes) const;

  [[nodiscard]] const std::vector<BaselineFile>& files() const { return files_; }

 private:
  std::vector<BaselineFile> files_;
};

}  // namespace fdcg::tools
