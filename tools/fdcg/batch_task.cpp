// SPDX-License-Identifier: Apache-2.0
#include "batch_task.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "../common/atomic_file.hpp"
#include "../common/program.hpp"
#include "batch_process.hpp"
#include "batch_work.hpp"
#include "fdcg/results.hpp"
#include "fdcg/robot.hpp"
#include "packed_texts.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// What is known of a result before the mesh is read, then the body's members.
std::string line_of(const BatchTask& task, const BatchPlan& plan, bool has_output, const std::string& body) {
  Json head;
  head["mesh"] = valid_utf8(task.mesh);
  if (task.scale != bake::Vec3{1, 1, 1}) head["scale"] = {task.scale.x, task.scale.y, task.scale.z};
  if (!task.robot.empty()) head["robot"] = valid_utf8(task.robot);
  head["action"] = plan.rules[task.rule].action;
  head["rule"] = task.rule + 1 == plan.rules.size() ? Json(nullptr) : Json(task.rule);
  if (has_output) head["output"] = valid_utf8(task.output);
  std::string line = dumped(head);
  line.back() = ',';
  return line + body + "}";
}

BatchResult result_of(const BatchTask& task, const BatchPlan& plan, CacheEntry entry) {
  BatchResult result;
  result.exit_code = entry.exit_code;
  result.said = std::move(entry.said);
  result.line = line_of(task, plan, entry.has_output, entry.body);
  return result;
}

std::string without_name(const std::string& message, const std::string& name) {
  return message.starts_with(name + ": ") ? message.substr(name.size() + 2) : message;
}

// Whether a file has these bytes already: most have in a run that goes on with another.
bool has_bytes(const std::string& path, const std::string& bytes) {
  std::error_code error;
  if (fs::file_size(path, error) != bytes.size() || error) return false;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return file && text.str() == bytes;
}

// Why it cannot be written, or nothing.
std::string write_output(const BatchTask& task, const BatchPlace& place, const std::string& bytes) {
  const std::string path = place.outputs + "/" + task.output;
  if (has_bytes(path, bytes)) return {};
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  if (error) return "cannot make the folder of '" + path + "': " + error.message();
  AtomicFile file(path, place.unfinished + "/output-" + unique_name());
  file.write(bytes);
  return file.commit() ? std::string() : file.error();
}

// Keys of what is done with this mesh. The first is by its own bytes; the second, where it refers to others, by theirs too.
class Keys {
 public:
  Keys(const BatchTask& task, const BatchRule& rule) : folder_(fs::path(task.mesh).parent_path()) {
    static const std::string kProgram = program_identity();
    add(kProgram), add(rule.action), add(std::to_string(rule.options.size()));
    for (const std::string& option : rule.options)
      add(option);
    for (const double factor : {task.scale.x, task.scale.y, task.scale.z})
      add(shown_number(factor));
    add(fs::path(task.mesh).extension().string());
  }
  [[nodiscard]] std::string by_file(const std::string& sha256) const { return bake::sha256_of(text_ + sha256); }
  // `files` as the mesh names them, from its folder. Nothing where one cannot be read.
  [[nodiscard]] std::optional<std::string> by_references(const std::string& sha256,
                                                         const std::vector<std::string>& files) const {
    std::string all = text_ + sha256;
    for (const std::string& file : files) {
      const auto hash = bake::sha256_of_file(folder_ / file);
      if (!hash) return std::nullopt;
      all += '\0' + file + '\0' + *hash;
    }
    return bake::sha256_of(all);
  }
  [[nodiscard]] std::vector<std::string> seen_from_mesh(const std::vector<std::string>& files) const {
    std::vector<std::string> names;
    for (const std::string& file : files)
      names.push_back(fs::path(file).lexically_proximate(folder_.empty() ? "." : folder_).string());
    return names;
  }

 private:
  void add(std::string_view field) { text_.append(field) += '\0'; }

  fs::path folder_;
  std::string text_;
};

std::optional<CacheEntry> found(const Keys& keys, const std::string& sha256, const BatchCache& cache) {
  const std::string key = keys.by_file(sha256);
  if (auto entry = cache.load(key)) return entry;
  const std::vector<std::string> files = cache.references(key);
  const auto second = files.empty() ? std::nullopt : keys.by_references(sha256, files);
  return second ? cache.load(*second) : std::nullopt;
}

void remember(const Keys& keys, const bake::PolygonSoup& soup, const CacheEntry& entry, BatchCache& cache) {
  const std::string key = keys.by_file(soup.sha256);
  if (soup.other_files.empty()) return cache.store(key, entry);
  const std::vector<std::string> files = keys.seen_from_mesh(soup.other_files);
  const auto second = keys.by_references(soup.sha256, files);
  if (!second) return;
  cache.store(*second, entry);
  cache.store_references(key, files);
}

BatchResult done(const BatchTask& task, const BatchPlan& plan, const BatchPlace& place, BatchCache& cache) {
  if (!task.problem.empty()) return failed_result(task, plan, {kFile, task.problem, "unreadable"});
  std::error_code ignored;
  const fs::file_type type = fs::status(task.mesh, ignored).type();
  if (type != fs::file_type::regular && type != fs::file_type::not_found && type != fs::file_type::directory)
    return failed_result(task, plan, {kFile, "is no regular file, and a batch waits for none", "unreadable"});
  const auto file = bake::MeshFile::open(task.mesh);
  if (!file) return failed_result(task, plan, file.error());
  const BatchRule& rule = plan.rules[task.rule];
  const Keys keys(task, rule);
  auto entry = found(keys, file->sha256(), cache);
  const bool is_cached = entry.has_value();
  if (!is_cached) {
    auto soup = file->import(import_options(rule));
    if (!soup) return failed_result(task, plan, soup.error());
    bake::scale_soup(*soup, task.scale);
    auto made = do_batch_work(rule, *soup, place.jobs);
    if (!made) return failed_result(task, plan, made.error());
    entry = std::move(*made);
    remember(keys, *soup, *entry, cache);
  }
  if (entry->has_output) {
    if (const std::string trouble = write_output(task, place, entry->output); !trouble.empty()) {
      BatchResult result;
      result.exit_code = kFile;
      result.is_fatal = true;
      result.said = trouble;
      return result;
    }
  }
  BatchResult result = result_of(task, plan, std::move(*entry));
  result.is_cached = is_cached;
  return result;
}

}  // namespace

std::string packed_result(const BatchResult& result) {
  return packed({{static_cast<std::size_t>(result.exit_code), std::size_t{result.is_fatal}, std::size_t{result.is_cached}},
                 {result.line, result.said, result.cache_trouble}});
}

BatchResult unpacked_result(const std::string& bytes) {
  auto parts = unpacked(bytes, 3, 3);
  if (!parts) throw std::runtime_error("a worker's answer makes no sense");
  return {static_cast<int>(parts->numbers[0]), parts->numbers[1] != 0,     parts->numbers[2] != 0,
          std::move(parts->texts[0]),          std::move(parts->texts[1]), std::move(parts->texts[2])};
}

BatchResult failed_result(const BatchTask& task, const BatchPlan& plan, const bake::Failure& why) {
  BatchResult result;
  result.exit_code = why.exit_code;
  result.said = one_line(without_name(why.message, task.mesh));
  const std::string& action = plan.rules[task.rule].action;
  bake::Report report;
  report.issues.emplace_back();
  report.issues[0].rule = !why.rule.empty() ? why.rule : "not-" + action + (action == "repair" ? "ed" : "d");
  report.issues[0].total = 1;
  report.issues[0].message = result.said;
  const std::string text = dumped(Json{{"exit_code", why.exit_code}, {"error", result.said}});
  result.line = line_of(task, plan, false, text.substr(1, text.size() - 2) + ",\"report\":" + bake::report_line(report));
  return result;
}

BatchResult do_batch_task(const BatchTask& task, const BatchPlan& plan, const BatchPlace& place, BatchCache& cache) {
  BatchResult result;
  try {
    result = done(task, plan, place, cache);
  } catch (const std::bad_alloc&) {
    result = failed_result(task, plan, {kFile, "needs more memory than there is (--memory); cut the mesh into parts", {}});
  } catch (const std::exception& error) {
    result = failed_result(task, plan, {kInternal, std::string("internal error: ") + error.what(), {}});
  }
  result.cache_trouble = cache.trouble();
  return result;
}

}  // namespace fdcg::tools
