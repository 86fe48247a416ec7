// SPDX-License-Identifier: Apache-2.0
#include "batch_merge.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "../common/atomic_file.hpp"
#include "../common/program.hpp"
#include "fdcg/fdcg.h"
#include "report_reader.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Thrown within this file.
struct Refusal {
  bake::Failure failure;
};
[[noreturn]] void refuse(int exit_code, const std::string& message) {
  throw Refusal{{exit_code, message, {}}};
}

// "2-of-4.jsonl" -> 4; nothing for other names.
std::optional<std::size_t> number_of_shards(const std::string& name) {
  const std::size_t at = name.find("-of-");
  if (at == std::string::npos || !name.ends_with(".jsonl")) return std::nullopt;
  const auto shard = parse_shard(name.substr(0, at) + "/" + name.substr(at + 4, name.size() - at - 4 - 6));
  return shard ? std::optional(shard->of) : std::nullopt;
}

std::size_t find_number(const BatchFolder& folder) {
  std::set<std::size_t> numbers;
  std::error_code error;
  for (fs::directory_iterator entry(folder.shards(), error), end; !error && entry != end; entry.increment(error)) {
    if (const auto of = number_of_shards(entry->path().filename().string())) numbers.insert(*of);
  }
  if (numbers.empty()) refuse(kFile, "'" + folder.shards() + "' has no results of shards; run 'fdcg batch --shard I/N' first");
  if (numbers.size() > 1) {
    refuse(kUsage, "'" + folder.shards() + "' has shards of a batch in " + std::to_string(*numbers.begin()) +
                       " and of one in " + std::to_string(*numbers.rbegin()) + "; remove those that are not wanted");
  }
  return *numbers.begin();
}

// The results of one shard, line by line.
class ShardFile {
 public:
  ShardFile(const BatchFolder& folder, const Shard& shard)
      : path_(folder.shard(shard)), shard_(shard), file_(path_, std::ios::binary) {
    std::string line;
    if (!file_ || !std::getline(file_, line))
      refuse(kFile, "shard " + std::to_string(shard.number) + "/" + std::to_string(shard.of) + " has no results ('" + path_ +
                        "'); run it, with --resume if it was begun");
    const Json head = Json::parse(line, nullptr, false);
    if (!head.is_object() || head.value("fdcg_batch", 0) != 1 || head.value("shard", std::size_t{0}) != shard.number ||
        head.value("of", std::size_t{0}) != shard.of)
      damaged("does not begin as results do");
    plan_ = head.value("plan", std::string());
    meshes_ = head.value("meshes", std::size_t{0});
  }

  [[nodiscard]] const std::string& plan() const { return plan_; }
  [[nodiscard]] std::size_t meshes() const { return meshes_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  std::string next() {
    std::string line;
    if (!std::getline(file_, line) || file_.eof()) damaged("ends early");
    return line;
  }
  [[noreturn]] void damaged(const std::string& how) const {
    refuse(kFile, "'" + path_ + "' " + how + "; run shard " + std::to_string(shard_.number) + "/" + std::to_string(shard_.of) +
                      " again with --resume");
  }

 private:
  std::string path_;
  Shard shard_;
  std::ifstream file_;
  std::string plan_;
  std::size_t meshes_ = 0;
};

std::vector<std::unique_ptr<ShardFile>> open_shards(const BatchFolder& folder) {
  const std::size_t of = find_number(folder);
  allow_many_files();
  std::vector<std::unique_ptr<ShardFile>> shards;
  for (std::size_t number = 1; number <= of; ++number) {
    shards.push_back(std::make_unique<ShardFile>(folder, Shard{number, of, {}}));
    if (shards.back()->plan() != shards[0]->plan() || shards.back()->meshes() != shards[0]->meshes())
      refuse(kFile, "'" + shards.back()->path() + "' and '" + shards[0]->path() +
                        "' are of batches of other meshes, rules or versions of fdcg; run both again");
  }
  return shards;
}

// What report.json says of all.
class Tally {
 public:
  void add(simdjson::dom::element line, const bake::Report& report) {
    const int code = static_cast<int>(std::int64_t(line["exit_code"]));
    ++totals_.meshes;
    ++(code == kClean ? totals_.clean : code == kFindings ? totals_.with_findings : totals_.failed);
    totals_.exit_code = std::max(totals_.exit_code, code);
    ++codes_[code];
    ++actions_[std::string(std::string_view(line["action"]))][code];
    vertices_ += report.vertices, faces_ += report.faces;
    std::uint64_t bytes = 0;
    if (line["output_bytes"].get(bytes) == simdjson::SUCCESS) output_bytes_ += bytes;
    for (const bake::Issue& issue : report.issues) {
      auto& [meshes, findings] = rules_[issue.rule];
      ++meshes, findings += issue.total;
    }
  }
  [[nodiscard]] const BatchTotals& totals() const { return totals_; }
  [[nodiscard]] std::string text(const std::string& plan) const {
    Json json{{"tool", "fdcg"},           {"version", FDCG_VERSION_STRING}, {"plan", plan}, {"exit_code", totals_.exit_code},
              {"meshes", totals_.meshes}, {"exit_codes", by_code(codes_)}};
    for (const auto& [action, codes] : actions_)
      json["actions"][action] = by_code(codes);
    json["rules"] = Json::object();
    for (const auto& [rule, counts] : rules_)
      json["rules"][rule] = {{"meshes", counts.first}, {"findings", counts.second}};
    json["vertices"] = vertices_;
    json["faces"] = faces_;
    json["output_bytes"] = output_bytes_;
    return json.dump(1) + "\n";
  }

 private:
  using Codes = std::map<int, std::uint64_t>;
  static Json by_code(const Codes& codes) {
    Json json = Json::object();
    for (const auto& [code, meshes] : codes)
      json[std::to_string(code)] = meshes;
    return json;
  }

  BatchTotals totals_;
  Codes codes_;
  std::map<std::string, Codes> actions_;
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> rules_;  // meshes, findings
  std::uint64_t vertices_ = 0, faces_ = 0, output_bytes_ = 0;
};

BatchTotals merge(const BatchFolder& folder, const std::string& unfinished) {
  const auto shards = open_shards(folder);
  AtomicFile results(folder.results(), unfinished + "/results"), summary(folder.report(), unfinished + "/report"),
      sarif(folder.sarif(), unfinished + "/sarif");
  std::error_code ignored;
  bake::ReportOptions options;
  options.source_root = fs::current_path(ignored).string();
  const auto writer = bake::make_report_writer(
      bake::ReportFormat::sarif, [&sarif](std::string_view piece) { sarif.write(piece); }, options);
  Tally tally;
  simdjson::dom::parser parser;  // a library's reports are many megabytes, and it reads them ten times as fast
  for (std::size_t i = 0; i < shards[0]->meshes(); ++i) {
    ShardFile& shard = *shards[i % shards.size()];
    const std::string text = shard.next();
    try {
      const simdjson::dom::element line = parser.parse(text);
      bake::Report report = read_report(line["report"]);
      report.file = std::string_view(line["mesh"]);
      tally.add(line, report);
      writer->add(report);
    } catch (const std::exception&) {  // of simdjson's
      shard.damaged("has a line that is no result");
    }
    results.write(text + "\n");
  }
  writer->finish(tally.totals().exit_code);
  summary.write(tally.text(shards[0]->plan()));
  if (const int code = commit_all({&sarif, &summary, &results}); code != kClean) refuse(code, {});
  return tally.totals();
}

}  // namespace

bake::Result<BatchTotals> merge_shards(const BatchFolder& folder) {
  UnfinishedFolder unfinished(folder, "merge");
  if (!unfinished.trouble().empty()) return bake::Failure{kFile, unfinished.trouble(), {}};
  try {
    const BatchTotals totals = merge(folder, unfinished.path());
    unfinished.finish();
    return totals;
  } catch (const Refusal& refusal) {
    unfinished.finish();
    return refusal.failure;
  }
}

}  // namespace fdcg::tools
