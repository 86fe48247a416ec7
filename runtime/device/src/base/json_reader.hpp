// SPDX-License-Identifier: Apache-2.0
// Profiles and scenes: JSON read key by key, with ranges. The first thing wrong becomes the file's error, one line that names
// the file, the place, the value found and what is expected: "touch.json: input.fields[3].offset is 40; it must be from 0 to
// 28". After it every reader gives its fallback (or 0), so that code reads on without a check a line and asks for the error at
// the end. Values read after an error mean nothing. Allocates; throws nothing but std::bad_alloc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace fdcg::dev {

inline constexpr std::size_t kMostJsonBytes = 1000000;
inline constexpr int kMostJsonDepth = 16;

// Of a number; never infinite or NaN.
struct NumberRange {
  double least = -1e300, most = 1e300;
  bool is_least_allowed = true;  // false: above it
  const char* unit = "";         // for the message
};

using Keys = std::initializer_list<const char*>;

class JsonFile;

// One object of the file, for use while the JsonFile lives. `key` names one of its members.
class JsonObject {
 public:
  bool has(const char* key) const;
  bool is_object(const char* key) const;
  std::string json(const char* key) const;  // the member as it stands, on one line; "" where it is absent
  std::string path(const char* key) const;  // "input.fields[3].offset"
  // The file's error, unless there is one: "PATH of the key" + " " + what.
  void fail(const char* key, const std::string& what) const;
  // Refuses members that are not among the keys and names the nearest of them. `of` ends the message: " of a rotary device".
  void allow_only(Keys keys, const char* of = "") const;

  // ---- Members that must be there
  double number(const char* key, const NumberRange& range) const;
  std::int64_t integer(const char* key, std::int64_t least, std::int64_t most) const;  // 3 and 3.0, not 3.5
  std::uint32_t id(const char* key, std::uint32_t most) const;  // an integer, or a text of hexadecimal digits: "0x1209"
  bool boolean(const char* key) const;
  std::string text(const char* key, std::size_t longest) const;  // not empty, on one line, without NUL
  int choice(const char* key, Keys names) const;                 // index of the name that stands there; 0 after an error
  std::vector<double> numbers(const char* key, int fewest, int most, const NumberRange& range) const;
  void numbers(const char* key, double* values, int count, const NumberRange& range) const;  // exactly so many
  std::vector<std::string> texts(const char* key, int fewest, int most, std::size_t longest) const;
  std::vector<std::uint8_t> hex(const char* key, int fewest, int most) const;  // "03 01 fF": so many bytes
  JsonObject object(const char* key, Keys keys) const;                         // keys as for allow_only
  std::vector<JsonObject> objects(const char* key, int fewest, int most, Keys keys) const;

  // ---- Members that may be absent
  double number_or(const char* key, double fallback, const NumberRange& range) const;
  std::int64_t integer_or(const char* key, std::int64_t fallback, std::int64_t least, std::int64_t most) const;
  std::uint32_t id_or(const char* key, std::uint32_t fallback, std::uint32_t most) const;
  bool boolean_or(const char* key, bool fallback) const;
  std::string text_or(const char* key, const std::string& fallback, std::size_t longest) const;
  int choice_or(const char* key, int fallback, Keys names) const;

 private:
  friend class JsonFile;
  JsonObject(JsonFile* file, const nlohmann::json* json, std::string path) : file_(file), json_(json), path_(std::move(path)) {}
  const nlohmann::json* find(const char* key) const;  // null with an error where it is absent
  void fail_as(const char* key, const nlohmann::json& value, const std::string& expected) const;
  double checked(const std::string& place, const nlohmann::json& value, const NumberRange& range) const;

  JsonFile* file_;
  const nlohmann::json* json_;  // an object; null after an error
  std::string path_;            // "" of the whole
};

class JsonFile {
 public:
  explicit JsonFile(std::string name);
  ~JsonFile();
  JsonFile(const JsonFile&) = delete;
  JsonFile& operator=(const JsonFile&) = delete;

  // Refused: not one JSON object (the message has line and column), a member twice, deeper than kMostJsonDepth, longer than
  // kMostJsonBytes.
  JsonObject parse(std::string_view text, Keys keys);
  void fail(const std::string& message);  // unless there is an error; put after "NAME: ", on one line
  bool has_failed() const { return !error_.empty(); }
  const std::string& error() const { return error_; }  // empty: none

 private:
  std::string name_, error_;
  std::unique_ptr<nlohmann::json> json_;
};

// The whole file as a text. Empty, or why not: missing, a folder, not permitted, longer than `most` bytes.
std::string read_text_file(const std::string& path, std::size_t most, std::string* text);

}  // namespace fdcg::dev
