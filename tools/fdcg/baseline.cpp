// SPDX-License-Identifier: Apache-2.0
#include "baseline.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "fdcg_commands.hpp"
#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

using Json = nlohmann::json;

// Walks through a report without keeping it. Members may come in any order.
class ReportReader {
 public:
  std::vector<BaselineFile> files;
  std::string error;    // one line; empty: none
  std::string lacking;  // the first file and rule of which findings are not listed
  bool is_report = false;

  bool null() { return leaf(); }
  bool boolean(bool) { return leaf(); }
  bool number_integer(Json::number_integer_t) { return leaf(); }
  bool number_float(Json::number_float_t, const std::string&) { return leaf(); }
  bool binary(Json::binary_t&) { return leaf(); }
  bool number_unsigned(Json::number_unsigned_t number) {
    if (is_at({"files", "", "issues", "", "total"})) total_ = number;
    return leaf();
  }
  bool string(std::string& text) {
    if (is_at({"tool"})) is_report = text == "fdcg";
    if (is_at({"files", "", "file"})) file_.path = text;
    if (is_at({"files", "", "issues", "", "rule"})) rule_ = text;
    if (is_at({"files", "", "issues", "", "elements", "", "fingerprint"})) {
      std::uint64_t fingerprint = 0;
      const char* const end = text.data() + text.size();
      const auto [stopped, code] = std::from_chars(text.data(), end, fingerprint, 16);
      if (code != std::errc{} || stopped != end || text.empty()) return stop("'" + text + "' is no fingerprint");
      ++fingerprints_[fingerprint];
      ++listed_;
    }
    return leaf();
  }
  bool start_object(std::size_t) {
    if (is_at({"files", ""})) file_ = {};
    if (is_at({"files", "", "issues", ""})) fingerprints_.clear(), rule_.clear(), total_ = listed_ = 0;
    path_.emplace_back();
    return true;
  }
  bool key(std::string& name) {
    path_.back() = name;
    return true;
  }
  bool end_object() {
    path_.pop_back();
    if (is_at({"files", "", "issues", ""})) finish_issue();
    if (is_at({"files", ""})) files.push_back(std::move(file_));
    return leaf();
  }
  bool start_array(std::size_t) {
    path_.emplace_back();  // an item has no name
    return true;
  }
  bool end_array() {
    path_.pop_back();
    return leaf();
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception& exception) {
    return stop("is no JSON: " + json::plain_complaint(exception.what()));
  }

 private:
  static bool leaf() { return true; }
  bool stop(const std::string& why) {
    error = why;
    return false;
  }
  [[nodiscard]] bool is_at(std::initializer_list<const char*> names) const {
    return path_.size() == names.size() && std::equal(names.begin(), names.end(), path_.begin());
  }
  void finish_issue() {
    // A file that could not be read has nothing that could be known.
    if (rule_ == "unreadable" || rule_ == "empty-mesh") return;
    if (listed_ < total_ && lacking.empty())
      lacking = "lists " + std::to_string(listed_) + " of the " + std::to_string(total_) + " findings of " + rule_ + " in " +
                file_.path;
    file_.rules[rule_] = std::move(fingerprints_);
    fingerprints_ = {};
  }

  std::vector<std::string> path_;  // names of the members that lead to where the reader is; empty for an item of a list
  BaselineFile file_;
  std::string rule_;
  std::uint64_t total_ = 0, listed_ = 0;
  Fingerprints fingerprints_;
};

// One name for one file, seen from the current folder.
std::string plain_path(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path whole = fs::absolute(path, error).lexically_normal();
  return path == "-" || error ? path : whole.string();
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

using FilesByPath = std::map<std::string, const BaselineFile*>;

// Gives each mesh without a file the one of `by_path` with the same name, where that is the only one on both sides, and takes
// it out.
void match_by(std::string (*name_of)(const std::string&), const std::vector<std::string>& meshes, FilesByPath& by_path,
              std::vector<const BaselineFile*>& found) {
  std::map<std::string, std::vector<std::size_t>> left;
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (found[i] == nullptr) left[name_of(meshes[i])].push_back(i);
  std::map<std::string, std::vector<FilesByPath::iterator>> files;
  for (auto file = by_path.begin(); file != by_path.end(); ++file)
    files[name_of(file->first)].push_back(file);
  for (const auto& [name, indices] : left) {
    const auto same = files.find(name);
    if (indices.size() != 1 || same == files.end() || same->second.size() != 1) continue;
    found[indices[0]] = same->second[0]->second;
    by_path.erase(same->second[0]);
  }
}

}  // namespace

bake::Result<Baseline> Baseline::read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    return bake::Failure{
        kFile, path + ": the baseline cannot be read; make it with 'fdcg validate --full " + path + " ...'", {}};
  }
  ReportReader reader;
  if (!Json::sax_parse(file, &reader)) return bake::Failure{kFile, one_line(path + ": the baseline " + reader.error), {}};
  if (!reader.is_report) {
    return bake::Failure{kFile, path + ": the baseline is no report of fdcg; make it with 'fdcg validate --full'", {}};
  }
  if (!reader.lacking.empty()) {
    return bake::Failure{
        kUsage,
        path + ": the baseline " + one_line(reader.lacking) + "; make it with 'fdcg validate --full', which lists all",
        {}};
  }
  Baseline baseline;
  baseline.files_ = std::move(reader.files);
  return baseline;
}

std::vector<const BaselineFile*> Baseline::files_for(const std::vector<std::string>& meshes) const {
  std::vector<const BaselineFile*> found(meshes.size(), nullptr);
  FilesByPath by_path;
  for (const BaselineFile& file : files_)
    by_path.emplace(plain_path(file.path), &file);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto same = by_path.find(plain_path(meshes[i]));
    if (same == by_path.end()) continue;
    found[i] = same->second;
    by_path.erase(same);
  }
  // Renamed folders: the file's own name leads back where it is the only one of that name on both sides; then the name without
  // its ending, of a mesh that was saved in another format.
  match_by(file_name, meshes, by_path, found);
  match_by(stem, meshes, by_path, found);
  const auto left = std::count(found.begin(), found.end(), nullptr);
  if (left == 1 && by_path.size() == 1) *std::find(found.begin(), found.end(), nullptr) = by_path.begin()->second;
  return found;
}

}  // namespace fdcg::tools
