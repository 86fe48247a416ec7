// SPDX-License-Identifier: Apache-2.0
#include "batch_plan.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "../common/program.hpp"
#include "../common/terminal.hpp"
#include "fdcg/fdcg.h"
#include "fdcg/results.hpp"
#include "mesh_list.hpp"
#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;
using json::Value;

constexpr std::size_t kLongestManifest = std::size_t{1} << 30;
constexpr int kMostMeshes = 10'000'000, kMostRules = 1000, kMostOptions = 100;
constexpr std::size_t kLongestPath = 4000;

std::string shown_scale(const bake::Vec3& scale) {
  return shown_number(scale.x) + "," + shown_number(scale.y) + "," + shown_number(scale.z);
}

// Without what can be left out: "./a//b/../c" is "a/c". A name that ends in "/" is a folder, and stays one.
std::string plain(const std::string& path) {
  return path == "-" ? "./-" : fs::path(path).lexically_normal().string();
}

// Why it cannot be read, or nothing. A list of millions of meshes is long.
std::string read_manifest(const std::string& manifest, std::string& text) {
  if (manifest != "-") {  // that it is there, and no folder
    std::string start;
    if (std::string trouble = json::read_text_file(manifest, 0, &start); !trouble.empty() && start.empty()) return trouble;
  }
  std::ifstream file;
  if (manifest != "-") file.open(manifest, std::ios::binary);
  std::ostringstream all;
  all << (manifest == "-" ? std::cin.rdbuf() : file.rdbuf());
  text = std::move(all).str();
  return {};
}

// What the manifests say, one after the other.
class ManifestReader {
 public:
  std::vector<std::string> entries;  // in the order of their first coming
  std::vector<BatchRule> rules;
  std::vector<std::string> notes;

  // What is wrong, if anything is.
  std::optional<bake::Failure> read(const std::string& manifest) {
    std::string text;
    const std::string trouble = read_manifest(manifest, text);
    if (!trouble.empty()) return bake::Failure{kFile, "the manifest " + trouble, {}};
    repeated_ = 0;
    std::optional<bake::Failure> failure;
    if (fs::path(manifest).extension() == ".json") {
      failure = read_json(manifest, text);
    } else if (const std::size_t zero = text.find('\0'); zero != std::string::npos) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
      return bake::Failure{kFile,
                           one_line("the manifest " + manifest + ": line " + std::to_string(line) +
                                    " holds a zero byte, so that it is no text; give one mesh on each line"),
                           {}};
    } else {
      read_lines(text);
    }
    if (repeated_ != 0)
      notes.push_back((manifest == "-" ? "standard input" : manifest) + ": " + counted(repeated_, "entry") +
                      " named again; each is done once (the first: '" + printable(first_repeated_) + "')");
    return failure;
  }

 private:
  static std::string counted(std::size_t count, const char* what) {
    return grouped(count) + (count == 1 ? std::string(" ") + what + " is" : std::string(" entries are"));
  }
  void add(const std::string& entry) {
    std::string path = plain(entry);
    if (known_.insert(path).second) {
      entries.push_back(std::move(path));
    } else if (repeated_++ == 0) {
      first_repeated_ = entry;
    }
  }
  void read_lines(const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      std::string line = text.substr(at, end - at);
      at = end + 1;
      if (line.ends_with('\r')) line.pop_back();
      if (!line.empty() && line.front() != '#') add(line);
    }
  }
  std::optional<bake::Failure> read_json(const std::string& manifest, const std::string& text) {
    try {
      json::Limits limits;
      limits.bytes = kLongestManifest;
      const json::Document document(text, limits);
      const Value root = document.object({"$schema", "meshes", "rules"});
      if (const Value meshes = root["meshes"]) {
        for (const std::string& mesh : meshes.texts(0, kMostMeshes, kLongestPath))
          add(mesh);
      }
      if (const Value list = root["rules"]) {
        for (const Value& rule : list.objects(0, kMostRules, {"match", "action", "options"}))
          read_rule(rule);
      }
    } catch (const json::Refusal& refusal) {
      return bake::Failure{kUsage, one_line(manifest + ": " + refusal.message), {}};
    }
    return std::nullopt;
  }
  void read_rule(const Value& value) {
    const Value options = value["options"], match = value["match"];
    auto rule = make_batch_rule(match ? match.text(kLongestPath) : std::string(), value["action"].string(),
                                options ? options.texts(0, kMostOptions, kLongestPath) : std::vector<std::string>());
    if (!rule) value.fail(": " + rule.error().message);
    rules.push_back(std::move(*rule));
  }

  std::set<std::string> known_;
  std::size_t repeated_ = 0;
  std::string first_repeated_;
};

// Below the folder of the outputs, whatever the mesh's path: "/a" is "a", "../a" is "_up/a".
std::string inside(const std::string& path) {
  fs::path result;
  for (const fs::path& part : fs::path(path).relative_path())
    result /= part == ".." ? fs::path("_up") : part;
  return result.string();
}

// Adds the meshes with their rules; each pair of mesh and scale once.
void add_tasks(const std::vector<ListedMesh>& meshes, BatchPlan& plan) {
  std::set<std::tuple<std::string, double, double, double>> known;
  for (const ListedMesh& mesh : meshes) {
    BatchTask task{plain(mesh.path), mesh.problem, mesh.scale, mesh.robot, 0, {}};
    if (!known.emplace(task.mesh, mesh.scale.x, mesh.scale.y, mesh.scale.z).second) continue;
    while (!plan.rules[task.rule].takes(task.mesh))
      ++task.rule;
    const bool is_scaled = mesh.scale != bake::Vec3{1, 1, 1};
    task.output = inside(plan.rules[task.rule].output_of(task.mesh + (is_scaled ? "@" + shown_scale(mesh.scale) : "")));
    plan.tasks.push_back(std::move(task));
  }
}

std::optional<bake::Failure> check_outputs(const BatchPlan& plan) {
  std::map<std::string_view, const BatchTask*> writers;
  for (const BatchTask& task : plan.tasks) {
    if (task.output.empty()) continue;
    const auto [other, is_new] = writers.emplace(task.output, &task);
    if (is_new) continue;
    return bake::Failure{kUsage,
                         "'" + printable(other->second->mesh) + "' and '" + printable(task.mesh) +
                             "' would both be written to '" + printable(task.output) + "'; put them into two manifests",
                         {}};
  }
  return std::nullopt;
}

std::string digest_of(const BatchPlan& plan) {
  std::string text;
  const auto add = [&text](std::string_view field) { text.append(field) += '\0'; };
  add("fdcg batch 1");
  add(FDCG_VERSION_STRING);
  for (const BatchRule& rule : plan.rules) {
    add(rule.match), add(rule.action), add(std::to_string(rule.options.size()));
    for (const std::string& option : rule.options)
      add(option);
  }
  for (const BatchTask& task : plan.tasks)
    add(task.mesh), add(task.problem), add(shown_scale(task.scale)), add(task.robot), add(std::to_string(task.rule));
  return bake::sha256_of(text);
}

}  // namespace

bake::Result<BatchPlan> read_batch_plan(const std::vector<std::string>& manifests) {
  ManifestReader reader;
  for (const std::string& manifest : manifests) {
    if (const auto failure = reader.read(manifest)) return *failure;
  }
  if (reader.entries.empty()) return bake::Failure{kUsage, "the manifest names no mesh", {}};
  BatchPlan plan;
  plan.rules = std::move(reader.rules);
  plan.rules.push_back(*make_batch_rule({}, "validate", {}));
  MeshList list = list_meshes(reader.entries);
  plan.notes = std::move(reader.notes);
  plan.notes.insert(plan.notes.end(), list.notes.begin(), list.notes.end());
  for (const BatchRule& rule : plan.rules) {
    const ValidateChoices* const choices = std::get_if<ValidateChoices>(&rule.settings);
    if (const std::string word = choices == nullptr ? "" : lowered_errors(choices->settings); !word.empty())
      plan.notes.push_back(word);
  }
  add_tasks(list.meshes, plan);
  if (const auto failure = check_outputs(plan)) return *failure;
  plan.digest = digest_of(plan);
  return plan;
}

}  // namespace fdcg::tools
