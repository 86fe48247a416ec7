// SPDX-License-Identifier: Apache-2.0
// The text as a whole: json_reader.hpp's JsonFile, and reading it from a disk.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "base/json_reader.hpp"
#include "base/words.hpp"

namespace fdcg::dev {
namespace {

using Json = nlohmann::json;

// nlohmann's words without its own number and the names of its parts: "line 1, column 19: invalid literal; last read: ...".
std::string plain_complaint(std::string what) {
  for (const char* const words : {"] parse error at ", "] "}) {
    const std::size_t at = what.find(words);
    if (at == std::string::npos) continue;
    what.erase(0, at + std::strlen(words));
    break;
  }
  const std::size_t from = what.find(": syntax error while parsing "), to = what.find(" - ");
  if (from != std::string::npos && to != std::string::npos && from < to) what.replace(from, to + 3 - from, ": ");
  return what;
}

// The pass before the real one: nlohmann's document takes the last of two members with one name and nests without end.
class Shape : public nlohmann::json_sax<Json> {
 public:
  std::string complaint;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(std::int64_t) override { return true; }
  bool number_unsigned(std::uint64_t) override { return true; }
  bool number_float(double, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }
  bool key(std::string& name) override {
    if (names_.back().insert(name).second) return true;
    complaint = in_quotes(name) + " stands twice in one object; keep one";
    return false;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception& error) override {
    complaint = "is no JSON: " + plain_complaint(error.what());
    return false;
  }

 private:
  bool enter() {
    names_.emplace_back();
    if (names_.size() <= static_cast<std::size_t>(kMostJsonDepth)) return true;
    complaint = "nests deeper than " + std::to_string(kMostJsonDepth) + " levels; write it flatter";
    return false;
  }
  bool leave() {
    names_.pop_back();
    return true;
  }
  std::vector<std::set<std::string>> names_;
};

}  // namespace

JsonFile::JsonFile(std::string name) : name_(std::move(name)) {}
JsonFile::~JsonFile() = default;

void JsonFile::fail(const std::string& message) {
  if (error_.empty()) error_ = one_line(name_ + ": " + message);
}

JsonObject JsonFile::parse(std::string_view text, Keys keys) {
  const JsonObject nothing(this, nullptr, "");
  if (text.size() > kMostJsonBytes) {
    fail("has " + std::to_string(text.size()) + " bytes; the limit is " + std::to_string(kMostJsonBytes));
    return nothing;
  }
  Shape shape;
  if (!Json::sax_parse(text, &shape)) {
    fail(shape.complaint.empty() ? "is no JSON" : shape.complaint);
    return nothing;
  }
  json_ = std::make_unique<Json>(Json::parse(text, nullptr, false));
  if (!json_->is_object()) {
    fail("holds no JSON object; it must be one: { ... }");
    return nothing;
  }
  const JsonObject root(this, json_.get(), "");
  root.allow_only(keys);
  return root;
}

std::string read_text_file(const std::string& path, std::size_t most, std::string* text) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))  // which opens like a file, and throws when it is read
    return one_line(path + ": is a folder; name a file in it");
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open()) {
    const bool exists = std::filesystem::exists(path, ignored);
    return one_line(path + (exists ? ": cannot be read; check its permissions" : ": does not exist; check the path"));
  }
  text->assign(most + 1, '\0');
  file.read(text->data(), static_cast<std::streamsize>(text->size()));
  text->resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad()) return one_line(path + ": reading failed; check the disk");
  if (text->size() > most) return one_line(path + ": has more than " + std::to_string(most) + " bytes, which is the limit");
  return "";
}

}  // namespace fdcg::dev
