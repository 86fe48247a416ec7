// SPDX-License-Identifier: Apache-2.0
// The text as a whole: reader.hpp's Document, and reading it from a disk.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::json {
namespace {

using Json = nlohmann::json;

// nlohmann's own document takes the last of two members with one name and nests without end.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(const Limits& limits, Json* root) : limits_(limits), root_(root) {}

  bool null() override { return add(nullptr) != nullptr; }
  bool boolean(bool is_true) override { return add(is_true) != nullptr; }
  bool number_integer(std::int64_t number) override { return add(number) != nullptr; }
  bool number_unsigned(std::uint64_t number) override { return add(number) != nullptr; }
  bool number_float(double number, const std::string&) override { return add(number) != nullptr; }
  bool string(std::string& text) override { return add(std::move(text)) != nullptr; }
  bool binary(binary_t&) override { return false; }  // of other formats than text
  bool start_object(std::size_t) override { return enter(Json::object()); }
  bool start_array(std::size_t) override { return enter(Json::array()); }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }
  bool key(std::string& name) override {
    const auto [member, is_new] = open_.back()->get_ref<Json::object_t&>().try_emplace(name);
    if (!is_new && !limits_.allows_twins) throw Refusal{in_quotes(name) + " stands twice in one object; keep one"};
    member_ = &member->second;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception& error) override {
    const std::string what = plain_complaint(error.what());
    throw Refusal{"is no JSON: " + what, what.find("unexpected end of input") != std::string::npos};
  }

 private:
  Json* add(Json value) {
    if (open_.empty()) return &(*root_ = std::move(value));
    Json& parent = *open_.back();
    if (parent.is_object()) return &(*member_ = std::move(value));
    parent.get_ref<Json::array_t&>().push_back(std::move(value));
    return &parent.back();
  }
  bool enter(Json container) {
    if (open_.size() == static_cast<std::size_t>(limits_.depth))
      throw Refusal{"nests deeper than " + std::to_string(limits_.depth) + " levels; write it flatter"};
    open_.push_back(add(std::move(container)));
    return true;
  }
  bool leave() {
    open_.pop_back();
    return true;
  }

  const Limits& limits_;
  Json* root_;
  std::vector<Json*> open_;  // the containers around the next value: nothing is added to any but the last, so that none moves
  Json* member_ = nullptr;   // of the last, where it is an object
};

}  // namespace

Document::Document(std::string_view text, const Limits& limits) : json_(std::make_unique<Json>()) {
  if (text.size() > limits.bytes)
    throw Refusal{"has " + std::to_string(text.size()) + " bytes; the limit is " + std::to_string(limits.bytes)};
  Builder builder(limits, json_.get());
  if (!Json::sax_parse(text, &builder)) throw Refusal{"is no JSON"};
}
Document::~Document() = default;

std::string plain_complaint(std::string what) {
  for (const std::string_view own : {"] parse error at ", "] "}) {  // after the number that the parser has for it
    const std::size_t at = what.find(own);
    if (at == std::string::npos) continue;
    what.erase(0, at + own.size());
    break;
  }
  const std::size_t from = what.find(": syntax error while parsing "), to = what.find(" - ");
  if (from != std::string::npos && to != std::string::npos && from < to) what.replace(from, to + 3 - from, ": ");
  return what;
}

std::string read_text_file(const std::string& path, std::size_t most, std::string* text) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))  // which opens like a file, and throws when it is read
    return one_line(path + ": is a directory; name a file in it");
  std::ifstream file(path, std::ios::binary);
  if (file.is_open()) return read_text(file, path, most, text);
  const bool exists = std::filesystem::exists(path, ignored);
  return one_line(path + (exists ? ": cannot be read; check its permissions" : ": does not exist; check the path"));
}

std::string read_text(std::istream& stream, const std::string& name, std::size_t most, std::string* text) {
  text->assign(most + 1, '\0');
  stream.read(text->data(), static_cast<std::streamsize>(text->size()));
  text->resize(static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) return one_line(name + ": reading failed; check the disk");
  if (text->size() > most) return one_line(name + ": has more than " + std::to_string(most) + " bytes, which is the limit");
  return "";
}

}  // namespace fdcg::json
