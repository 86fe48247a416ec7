// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::json {
namespace {

using Json = nlohmann::json;

std::string shown_json(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list of " + std::to_string(value.size());
  if (value.is_number_float()) return shown_number(value.get<double>());
  constexpr std::size_t kLongest = 60;
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

// An integer that double holds exactly; 2^53 is the last below which each of them is.
std::optional<std::int64_t> to_integer(const Json& value) {
  constexpr double kMost = 9007199254740992.0;
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (!(std::fabs(number) <= kMost) || number != std::floor(number)) return std::nullopt;
    return static_cast<std::int64_t>(number);
  }
  if (!value.is_number()) return std::nullopt;
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX)) return std::nullopt;
  return value.get<std::int64_t>();
}

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// "0x1F"; none also beyond 32 bits.
std::optional<std::int64_t> hex_number(const std::string& text) {
  constexpr std::size_t kMostDigits = 8;
  if (text.size() < 3 || text.size() > 2 + kMostDigits || text[0] != '0' || (text[1] != 'x' && text[1] != 'X')) return {};
  std::int64_t number = 0;
  for (const char c : text.substr(2)) {
    if (digit_of(c) < 0) return {};
    number = number * 16 + digit_of(c);
  }
  return number;
}

// Pairs of digits, with spaces between them or not.
std::optional<std::vector<std::uint8_t>> hex_bytes(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == ' ') continue;
    if (i + 1 >= text.size() || digit_of(text[i]) < 0 || digit_of(text[i + 1]) < 0) return {};
    bytes.push_back(static_cast<std::uint8_t>(digit_of(text[i]) * 16 + digit_of(text[i + 1])));
    ++i;
  }
  return bytes;
}

std::string from_to(int fewest, int most) {
  return (fewest == most ? "" : std::to_string(fewest) + " to ") + std::to_string(most);
}

bool is_within(std::size_t count, int fewest, int most) {
  return count >= static_cast<std::size_t>(fewest) && count <= static_cast<std::size_t>(most);
}

}  // namespace

std::string NumberRange::text() const {
  constexpr double kLargest = std::numeric_limits<double>::max();
  const std::string in_unit = unit[0] == '\0' ? "" : std::string(" ") + unit;
  if (least <= -kLargest) return most < kLargest ? "a number up to " + shown_number(most) + in_unit : "a number" + in_unit;
  const std::string start = "a number " + std::string(is_least_allowed ? "from " : "above ") + shown_number(least);
  if (most >= kLargest) return start + in_unit + (is_least_allowed ? " up" : "");
  return start + (is_least_allowed ? " to " : " and up to ") + shown_number(most) + in_unit;
}

// ---- places and messages

bool Value::is_object() const {
  return json_ != nullptr && json_->is_object();
}
bool Value::is_list() const {
  return json_ != nullptr && json_->is_array();
}
bool Value::is_number() const {
  return json_ != nullptr && json_->is_number();
}
bool Value::is_string() const {
  return json_ != nullptr && json_->is_string();
}

std::string Value::path() const {
  std::string path = parent_ == nullptr ? "" : parent_->path();
  if (!path.empty() && !key_.empty()) path += '.';
  path += key_;
  if (index_ != kNoItem) path += "[" + std::to_string(index_) + "]";
  return path;
}

std::string Value::shown() const {
  return json_ == nullptr ? "missing" : shown_json(*json_);
}

std::string Value::dump() const {
  return json_ == nullptr ? "" : json_->dump(-1, ' ', false, Json::error_handler_t::replace);
}

void Value::fail(const std::string& what) const {
  const std::string place = path();
  throw Refusal{place + (place.empty() || what.starts_with(':') ? "" : " ") + what};
}

void Value::must_be(const std::string& expected) const {
  fail("is " + shown() + (json_ == nullptr ? "" : "; it must be " + expected));
}

// ---- objects

Value Value::operator[](std::string_view key) const& {
  if (!is_object()) must_be("an object: { ... }");
  const auto found = json_->find(key);
  return {found == json_->end() ? nullptr : &*found, this, key};
}

std::vector<std::string> Value::keys() const {
  if (!is_object()) must_be("an object: { ... }");
  std::vector<std::string> keys;
  for (const auto& [key, value] : json_->items())
    keys.push_back(key);
  return keys;
}

void Value::allow_only(Keys keys, const char* of) const {
  allow_only(std::vector<std::string>(keys.begin(), keys.end()), of);
}

void Value::allow_only(const std::vector<std::string>& known, const char* of) const {
  for (const std::string& key : this->keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const bool is_whole = path().empty();
    fail((is_whole ? "" : "has ") + in_quotes(key) + (is_whole ? " is no key" : ", which is no key") + of +
         did_you_mean(key, known) + " (the keys" + of + " are " + listed(known) + ")");
  }
}

Value Value::object(Keys keys) const {
  allow_only(keys);
  return *this;
}

// ---- lists

std::size_t Value::size() const {
  if (!is_list()) must_be("a list: [ ... ]");
  return json_->size();
}

Value Value::item(std::size_t index) const& {
  if (index_ == kNoItem) return {&(*json_)[index], parent_, key_, index};
  return {&(*json_)[index], this, {}, index};
}

std::vector<Value> Value::items(int fewest, int most, const char* of) const {
  if (!is_list() || !is_within(json_->size(), fewest, most)) must_be("a list of " + from_to(fewest, most) + " " + of);
  std::vector<Value> items;
  for (std::size_t i = 0; i < json_->size(); ++i)
    items.push_back(item(i));
  return items;
}

std::vector<Value> Value::objects(int fewest, int most, Keys keys) const {
  std::vector<Value> found = objects(fewest, most);
  for (const Value& one : found)
    one.allow_only(keys);
  return found;
}

std::vector<double> Value::numbers(int fewest, int most, const NumberRange& range) const {
  std::vector<double> numbers;
  for (const Value& one : items(fewest, most, "numbers"))
    numbers.push_back(one.number(range));
  return numbers;
}

void Value::numbers(double* values, int count, const NumberRange& range) const {
  const std::vector<double> found = numbers(count, count, range);
  std::copy(found.begin(), found.end(), values);
}

std::vector<std::string> Value::texts(int fewest, int most, std::size_t longest) const {
  std::vector<std::string> texts;
  for (const Value& one : items(fewest, most, "texts"))
    texts.push_back(one.text(longest));
  return texts;
}

// ---- single values

double Value::number(const NumberRange& range) const {
  // JSON has no NaN and the parser refuses what overflows: a number is finite here.
  const double number = is_number() ? json_->get<double>() : 0;
  if (!is_number() || !range.holds(number)) must_be(range.text());
  return number;
}

std::int64_t Value::integer(std::int64_t least, std::int64_t most) const {
  const std::optional<std::int64_t> number = is_number() ? to_integer(*json_) : std::nullopt;
  if (!number || *number < least || *number > most)
    must_be("an integer from " + std::to_string(least) + " to " + std::to_string(most));
  return *number;
}

std::uint32_t Value::id(std::uint32_t most) const {
  const std::optional<std::int64_t> number = is_string() ? hex_number(string()) : json_ ? to_integer(*json_) : std::nullopt;
  if (!number || *number < 0 || *number > most) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%04lX", static_cast<unsigned long>(most));
    must_be("a number up to " + std::string(text) + ", in hexadecimal as a text: \"0x0001\"");
  }
  return static_cast<std::uint32_t>(*number);
}

bool Value::boolean() const {
  if (json_ == nullptr || !json_->is_boolean()) must_be("true or false");
  return json_->get<bool>();
}

const std::string& Value::string() const {
  if (!is_string()) must_be("a text");
  return json_->get_ref<const std::string&>();
}

std::string Value::text(std::size_t longest) const {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; };
  const std::string text = is_string() ? string() : "";
  if (text.empty() || text.size() > longest || std::any_of(text.begin(), text.end(), is_control))
    must_be("a text of 1 to " + std::to_string(longest) + " bytes on one line");
  return text;
}

int Value::choice(Keys names) const {
  const std::vector<std::string> known(names.begin(), names.end());
  const auto name = is_string() ? std::find(known.begin(), known.end(), string()) : known.end();
  if (name == known.end()) {
    fail("is " + shown() + (is_string() ? did_you_mean(string(), known) : "") +
         (json_ == nullptr ? "" : " (it may be " + listed(known) + ")"));
  }
  return static_cast<int>(name - known.begin());
}

std::vector<std::uint8_t> Value::hex(int fewest, int most) const {
  const std::optional<std::vector<std::uint8_t>> bytes = is_string() ? hex_bytes(string()) : std::nullopt;
  if (!bytes || !is_within(bytes->size(), fewest, most)) {
    must_be("a text of " + from_to(fewest, most) + " bytes in hexadecimal: \"03 01\"" +
            (bytes ? ", not of " + std::to_string(bytes->size()) : ""));
  }
  return *bytes;
}

}  // namespace fdcg::json
