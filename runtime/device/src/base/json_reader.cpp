// SPDX-License-Identifier: Apache-2.0
#include "base/json_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/words.hpp"

namespace fdcg::dev {
namespace {

using Json = nlohmann::json;

std::string shown(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list of " + std::to_string(value.size());
  if (value.is_number_float()) return shown_number(value.get<double>());
  constexpr std::size_t kLongest = 60;
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

// An integer that double holds exactly; 2^53 is the last below which each of them is.
bool to_integer(const Json& value, std::int64_t* integer) {
  constexpr double kMost = 9007199254740992.0;
  if (!value.is_number()) return false;
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (!(std::fabs(number) <= kMost) || number != std::floor(number)) return false;
    *integer = static_cast<std::int64_t>(number);
    return true;
  }
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX)) return false;
  *integer = value.get<std::int64_t>();
  return true;
}

std::string range_text(const NumberRange& range) {
  const std::string unit = range.unit[0] == '\0' ? "" : std::string(" ") + range.unit;
  const bool has_least = range.least > -1e300, has_most = range.most < 1e300;
  if (!has_least && !has_most) return "a finite number" + unit;
  if (!has_most)
    return "a number " + std::string(range.is_least_allowed ? "from " : "above ") + shown_number(range.least) + unit +
           (range.is_least_allowed ? " up" : "");
  if (!has_least) return "a number up to " + shown_number(range.most) + unit;
  return "a number " + std::string(range.is_least_allowed ? "from " : "above ") + shown_number(range.least) +
         (range.is_least_allowed ? " to " : " and up to ") + shown_number(range.most) + unit;
}

std::string count_text(int fewest, int most, const char* of) {
  if (fewest == most) return "a list of " + std::to_string(most) + " " + of;
  return "a list of " + std::to_string(fewest) + " to " + std::to_string(most) + " " + of;
}

bool has_count(const Json& value, int fewest, int most) {
  return value.is_array() && value.size() >= static_cast<std::size_t>(fewest) && value.size() <= static_cast<std::size_t>(most);
}

bool is_text(const Json& value, std::size_t longest) {
  if (!value.is_string()) return false;
  const auto& text = value.get_ref<const std::string&>();
  return !text.empty() && text.size() <= longest && std::none_of(text.begin(), text.end(), is_control);
}

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// "0x1F"; false also beyond 32 bits.
bool parse_hex_number(const std::string& text, std::int64_t* number) {
  constexpr std::size_t kMostDigits = 8;
  if (text.size() < 3 || text.size() > 2 + kMostDigits || text[0] != '0' || (text[1] != 'x' && text[1] != 'X')) return false;
  *number = 0;
  for (const char c : text.substr(2)) {
    if (digit_of(c) < 0) return false;
    *number = *number * 16 + digit_of(c);
  }
  return true;
}

// Pairs of digits, with spaces between them or not.
bool parse_hex_bytes(const std::string& text, std::vector<std::uint8_t>* bytes) {
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == ' ') {
      ++i;
      continue;
    }
    if (i + 1 >= text.size() || digit_of(text[i]) < 0 || digit_of(text[i + 1]) < 0) return false;
    bytes->push_back(static_cast<std::uint8_t>(digit_of(text[i]) * 16 + digit_of(text[i + 1])));
    i += 2;
  }
  return true;
}

std::string hexadecimal(std::int64_t number) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%04llX", static_cast<unsigned long long>(number));
  return text;
}

}  // namespace

bool JsonObject::has(const char* key) const {
  return json_ != nullptr && json_->contains(key);
}

bool JsonObject::is_object(const char* key) const {
  return has(key) && json_->at(key).is_object();
}

std::string JsonObject::json(const char* key) const {
  return has(key) ? json_->at(key).dump(-1, ' ', false, Json::error_handler_t::replace) : std::string();
}

std::string JsonObject::path(const char* key) const {
  return path_.empty() ? key : path_ + "." + key;
}

void JsonObject::fail(const char* key, const std::string& what) const {
  file_->fail(path(key) + " " + what);
}

void JsonObject::fail_as(const char* key, const Json& value, const std::string& expected) const {
  fail(key, "is " + shown(value) + "; it must be " + expected);
}

void JsonObject::allow_only(Keys keys, const char* of) const {
  if (json_ == nullptr) return;
  const std::vector<std::string> known(keys.begin(), keys.end());
  for (const auto& member : json_->items()) {
    if (std::find(known.begin(), known.end(), member.key()) != known.end()) continue;
    const std::string place = path_.empty() ? "" : path_ + " has ";
    const std::string end = path_.empty() ? " is no key" : ", which is no key";
    file_->fail(place + in_quotes(member.key()) + end + of + did_you_mean(member.key(), known) + " (the keys" + of + " are " +
                listed(known) + ")");
    return;
  }
}

const Json* JsonObject::find(const char* key) const {
  if (json_ == nullptr) return nullptr;
  const auto found = json_->find(key);
  if (found != json_->end()) return &*found;
  fail(key, "is missing");
  return nullptr;
}

double JsonObject::checked(const std::string& place, const Json& value, const NumberRange& range) const {
  // JSON has no NaN and the parser refuses what overflows: a number is finite here.
  const double number = value.is_number() ? value.get<double>() : 0;
  const bool is_in_range = number <= range.most && (range.is_least_allowed ? number >= range.least : number > range.least);
  if (value.is_number() && is_in_range) return number;
  file_->fail(place + " is " + shown(value) + "; it must be " + range_text(range));
  return range.least > 0 || range.most < 0 ? range.least : 0;
}

double JsonObject::number(const char* key, const NumberRange& range) const {
  const Json* value = find(key);
  return value == nullptr ? 0 : checked(path(key), *value, range);
}

std::int64_t JsonObject::integer(const char* key, std::int64_t least, std::int64_t most) const {
  const Json* value = find(key);
  if (value == nullptr) return least;
  std::int64_t number = 0;
  if (to_integer(*value, &number) && number >= least && number <= most) return number;
  fail_as(key, *value, "an integer from " + std::to_string(least) + " to " + std::to_string(most));
  return least;
}

std::uint32_t JsonObject::id(const char* key, std::uint32_t most) const {
  const Json* value = find(key);
  if (value == nullptr) return 0;
  std::int64_t number = 0;
  const bool is_number =
      value->is_string() ? parse_hex_number(value->get_ref<const std::string&>(), &number) : to_integer(*value, &number);
  if (is_number && number >= 0 && number <= most) return static_cast<std::uint32_t>(number);
  fail_as(key, *value, "a number up to " + hexadecimal(most) + ", in hexadecimal as a text: \"0x0001\"");
  return 0;
}

bool JsonObject::boolean(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) return false;
  if (!value->is_boolean()) fail_as(key, *value, "true or false");
  return value->is_boolean() && value->get<bool>();
}

std::string JsonObject::text(const char* key, std::size_t longest) const {
  const Json* value = find(key);
  if (value == nullptr) return "";
  if (is_text(*value, longest)) return value->get<std::string>();
  fail_as(key, *value, "a text of 1 to " + std::to_string(longest) + " bytes on one line");
  return "";
}

int JsonObject::choice(const char* key, Keys names) const {
  const Json* value = find(key);
  if (value == nullptr) return 0;
  const std::vector<std::string> known(names.begin(), names.end());
  const std::string found = value->is_string() ? value->get<std::string>() : "";
  const auto name = std::find(known.begin(), known.end(), found);
  if (value->is_string() && name != known.end()) return static_cast<int>(name - known.begin());
  fail(key,
       "is " + shown(*value) + (value->is_string() ? did_you_mean(found, known) : "") + " (it may be " + listed(known) + ")");
  return 0;
}

std::vector<double> JsonObject::numbers(const char* key, int fewest, int most, const NumberRange& range) const {
  const Json* value = find(key);
  if (value == nullptr) return std::vector<double>(static_cast<std::size_t>(fewest));
  if (!has_count(*value, fewest, most)) {
    fail_as(key, *value, count_text(fewest, most, "numbers"));
    return std::vector<double>(static_cast<std::size_t>(fewest));
  }
  std::vector<double> numbers;
  for (const Json& item : *value)
    numbers.push_back(checked(path(key) + "[" + std::to_string(numbers.size()) + "]", item, range));
  return numbers;
}

void JsonObject::numbers(const char* key, double* values, int count, const NumberRange& range) const {
  const std::vector<double> found = numbers(key, count, count, range);
  std::copy(found.begin(), found.end(), values);
}

std::vector<std::string> JsonObject::texts(const char* key, int fewest, int most, std::size_t longest) const {
  const Json* value = find(key);
  if (value == nullptr) return {};
  if (!has_count(*value, fewest, most)) {
    fail_as(key, *value, count_text(fewest, most, "texts"));
    return {};
  }
  std::vector<std::string> texts;
  for (const Json& item : *value) {
    if (!is_text(item, longest)) {
      file_->fail(path(key) + "[" + std::to_string(texts.size()) + "] is " + shown(item) + "; it must be a text of 1 to " +
                  std::to_string(longest) + " bytes on one line");
      return {};
    }
    texts.push_back(item.get<std::string>());
  }
  return texts;
}

std::vector<std::uint8_t> JsonObject::hex(const char* key, int fewest, int most) const {
  const Json* value = find(key);
  if (value == nullptr) return {};
  std::vector<std::uint8_t> bytes;
  const bool is_hex = value->is_string() && parse_hex_bytes(value->get_ref<const std::string&>(), &bytes);
  if (is_hex && bytes.size() >= static_cast<std::size_t>(fewest) && bytes.size() <= static_cast<std::size_t>(most))
    return bytes;
  fail_as(key, *value,
          "a text of " + std::to_string(fewest) + " to " + std::to_string(most) + " bytes in hexadecimal: \"03 01\"" +
              (is_hex ? ", not of " + std::to_string(bytes.size()) : ""));
  return {};
}

JsonObject JsonObject::object(const char* key, Keys keys) const {
  const Json* value = find(key);
  if (value != nullptr && !value->is_object()) {
    fail_as(key, *value, "an object: { ... }");
    value = nullptr;
  }
  JsonObject found(file_, value, path(key));
  found.allow_only(keys);
  return found;
}

std::vector<JsonObject> JsonObject::objects(const char* key, int fewest, int most, Keys keys) const {
  const Json* value = find(key);
  if (value == nullptr) return {};
  if (!has_count(*value, fewest, most)) {
    fail_as(key, *value, count_text(fewest, most, "objects"));
    return {};
  }
  std::vector<JsonObject> found;
  for (const Json& item : *value) {
    const std::string place = path(key) + "[" + std::to_string(found.size()) + "]";
    if (!item.is_object()) {
      file_->fail(place + " is " + shown(item) + "; it must be an object: { ... }");
      return {};
    }
    found.push_back(JsonObject(file_, &item, place));
    found.back().allow_only(keys);
  }
  return found;
}

double JsonObject::number_or(const char* key, double fallback, const NumberRange& range) const {
  return has(key) ? number(key, range) : fallback;
}
std::int64_t JsonObject::integer_or(const char* key, std::int64_t fallback, std::int64_t least, std::int64_t most) const {
  return has(key) ? integer(key, least, most) : fallback;
}
std::uint32_t JsonObject::id_or(const char* key, std::uint32_t fallback, std::uint32_t most) const {
  return has(key) ? id(key, most) : fallback;
}
bool JsonObject::boolean_or(const char* key, bool fallback) const {
  return has(key) ? boolean(key) : fallback;
}
std::string JsonObject::text_or(const char* key, const std::string& fallback, std::size_t longest) const {
  return has(key) ? text(key, longest) : fallback;
}
int JsonObject::choice_or(const char* key, int fallback, Keys names) const {
  return has(key) ? choice(key, names) : fallback;
}

}  // namespace fdcg::dev
