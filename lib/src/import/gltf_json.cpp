// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_json.hpp"

#include <algorithm>
#include <cmath>

namespace fdcg::bake::gltf {

using Json = nlohmann::json;

std::string Value::path() const {
  if (parent_ == nullptr) return {};
  const std::string before = parent_->path();
  if (key_.empty()) return before + "[" + std::to_string(index_) + "]";
  return before.empty() ? std::string(key_) : before + "." + std::string(key_);
}

void Value::fail(const std::string& what) const {
  const std::string place = path();
  throw Refusal{(place.empty() ? "the JSON" : place) + ": " + what};
}

std::optional<Value> Value::find(std::string_view key) const& {
  if (!json_->is_object()) fail("is not an object");
  const auto found = json_->find(key);
  if (found == json_->end()) return std::nullopt;
  return Value(*found, *this, key, 0);
}

Value Value::at(std::string_view key) const& {
  const std::optional<Value> value = find(key);
  if (!value) fail("has no '" + std::string(key) + "', which it needs");
  return *value;
}

std::size_t Value::size() const {
  if (!json_->is_array()) fail("is not an array");
  if (json_->size() >= kNone) fail("has more than 4,294,967,294 items");
  return json_->size();
}

Value Value::item(std::size_t index) const& {
  return {(*json_)[index], *this, {}, index};
}

std::uint64_t Value::whole() const {
  constexpr double kLimit = 0x1p53;  // beyond it JSON writers differ
  const double value = number();
  if (!(value >= 0 && value < kLimit) || value != std::floor(value))
    fail("is " + shown() + ", not a whole number of 0 or more");
  return static_cast<std::uint64_t>(value);
}

double Value::number() const {
  if (!json_->is_number()) fail("is not a number");
  return json_->get<double>();
}

const std::string& Value::text() const {
  if (!json_->is_string()) fail("is not a string");
  return json_->get_ref<const std::string&>();
}

bool Value::boolean() const {
  if (!json_->is_boolean()) fail("is neither true nor false");
  return json_->get<bool>();
}

std::string Value::shown() const {
  constexpr std::size_t kMost = 64;
  if (json_->is_string()) return text().substr(0, kMost);
  return json_->is_number() ? json_->dump() : json_->type_name();
}

Index Value::index_of(std::size_t count, const char* things) const {
  const std::uint64_t index = whole();
  if (index >= count) fail("is " + std::to_string(index) + ", but the file has " + std::to_string(count) + " " + things);
  return static_cast<Index>(index);
}

std::uint64_t Value::whole_or(std::string_view key, std::uint64_t fallback) const {
  const std::optional<Value> value = find(key);
  return value ? value->whole() : fallback;
}

namespace {

// Ahead of the parser, which would take some 80 bytes of memory for each level (and which, asked to call back at each value,
// takes quadratic time). In a text that is JSON up to some byte, the count is right up to there.
void check_depth(std::string_view text) {
  constexpr int kMaxDepth = 128;  // glTF needs some ten levels, extras may have a few more
  int depth = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_string && c == '\\') {
      ++i;
    } else if (c == '"') {
      is_string = !is_string;
    } else if (!is_string && (c == '[' || c == '{')) {
      if (++depth > kMaxDepth) throw Refusal{"the JSON is nested deeper than 128 levels; the file is damaged or forged"};
    } else if (!is_string && (c == ']' || c == '}')) {
      --depth;
    }
  }
}

}  // namespace

nlohmann::json parse_json(std::string_view text) {
  check_depth(text);
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::min(error.byte, text.size());  // of the last byte read, counted from 1
    const std::string_view before = text.substr(0, at);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::string place = "line " + std::to_string(line) + ", byte " + std::to_string(at);
    if (error.byte > text.size()) throw Refusal{"truncated: the JSON ends at " + place + "; fetch or export the file again"};
    throw Refusal{"the JSON is broken at " + place + "; fetch or export the file again"};
  } catch (const Json::exception& error) {  // a number that no double holds
    throw Refusal{"the JSON has a number out of range; export the file again"};
  }
}

}  // namespace fdcg::bake::gltf
