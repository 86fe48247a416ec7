// SPDX-License-Identifier: Apache-2.0
// JSON that people and other programs write, read value by value. What is wrong is thrown as a Refusal whose message names the
// place, the value found and what is expected: "input.fields[3].offset is 40; it must be an integer from 0 to 28". The caller
// that knows the file's name catches it and puts the name in front. Beside it only std::bad_alloc is thrown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <limits>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace fdcg::json {

struct Refusal {
  std::string message;        // without the file's name; one_line() before it is printed
  bool is_cut_short = false;  // the text ends too early
};

// What a text may be. Twins are members of one name in one object: of those that are allowed the last counts.
struct Limits {
  std::size_t bytes = 1000000;
  int depth = 16;
  bool allows_twins = false;
};

// Of a number; never infinite or NaN.
struct NumberRange {
  double least = -std::numeric_limits<double>::max(), most = std::numeric_limits<double>::max();
  bool is_least_allowed = true;  // false: above it
  const char* unit = "";         // for the message

  [[nodiscard]] bool holds(double number) const {
    return number <= most && (is_least_allowed ? number >= least : number > least);
  }
  [[nodiscard]] std::string text() const;  // "a number above 0 and up to 10 m"
};

using Keys = std::initializer_list<const char*>;

class Document;

// A view of a value, or of the place where one might be. It points to its document and to the value that it was found in: for
// use on the stack.
class Value {
 public:
  // ---- what stands there; never thrown from
  explicit operator bool() const { return json_ != nullptr; }
  [[nodiscard]] bool is_object() const;
  [[nodiscard]] bool is_list() const;
  [[nodiscard]] bool is_number() const;
  [[nodiscard]] bool is_string() const;
  [[nodiscard]] std::string path() const;   // "input.fields[3].offset"
  [[nodiscard]] std::string shown() const;  // for messages: short, a string in quotes, "an object", "a list of 3"
  [[nodiscard]] std::string dump() const;   // as it stands, on one line; "" where there is nothing

  // Refuse the file: "PATH what"; what begins with a colon follows the path at once.
  [[noreturn]] void fail(const std::string& what) const;
  // "PATH is VALUE; it must be expected", or "PATH is missing".
  [[noreturn]] void must_be(const std::string& expected) const;

  // ---- Of an object. The member may be absent: that is refused when its value is asked for.
  [[nodiscard]] Value operator[](std::string_view key) const&;
  Value operator[](std::string_view key) const&& = delete;
  [[nodiscard]] std::vector<std::string> keys() const;
  // Refuses members that are not among the keys and names the nearest of them. `of` ends the message: " of a rotary device".
  void allow_only(Keys keys, const char* of = "") const;
  void allow_only(const std::vector<std::string>& keys, const char* of) const;
  // This value, which must be an object of such keys.
  [[nodiscard]] Value object(Keys keys) const;

  // ---- Of a list
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] Value item(std::size_t index) const&;
  Value item(std::size_t index) const&& = delete;
  // All of a list that is a member, or the document.
  [[nodiscard]] std::vector<Value> items(int fewest, int most, const char* of) const;
  [[nodiscard]] std::vector<Value> objects(int fewest, int most) const { return items(fewest, most, "objects"); }
  [[nodiscard]] std::vector<Value> objects(int fewest, int most, Keys keys) const;
  [[nodiscard]] std::vector<double> numbers(int fewest, int most, const NumberRange& range) const;
  void numbers(double* values, int count, const NumberRange& range) const;  // exactly so many
  [[nodiscard]] std::vector<std::string> texts(int fewest, int most, std::size_t longest) const;

  // ---- Single values
  [[nodiscard]] double number(const NumberRange& range = {}) const;
  [[nodiscard]] std::int64_t integer(std::int64_t least, std::int64_t most) const;  // 3 and 3.0, not 3.5
  [[nodiscard]] std::uint32_t id(std::uint32_t most) const;  // an integer, or a text of hexadecimal digits: "0x1209"
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] const std::string& string() const;                          // any text
  [[nodiscard]] std::string text(std::size_t longest) const;                // not empty, on one line, without NUL
  [[nodiscard]] int choice(Keys names) const;                               // index of the name that stands there
  [[nodiscard]] std::vector<std::uint8_t> hex(int fewest, int most) const;  // "03 01 fF": so many bytes

  // ---- Single values that may be absent
  [[nodiscard]] double number_or(double fallback, const NumberRange& range) const { return *this ? number(range) : fallback; }
  [[nodiscard]] std::int64_t integer_or(std::int64_t fallback, std::int64_t least, std::int64_t most) const {
    return *this ? integer(least, most) : fallback;
  }
  [[nodiscard]] bool boolean_or(bool fallback) const { return *this ? boolean() : fallback; }
  [[nodiscard]] std::string text_or(const char* fallback, std::size_t longest) const {
    return *this ? text(longest) : fallback;
  }
  [[nodiscard]] int choice_or(int fallback, Keys names) const { return *this ? choice(names) : fallback; }

 private:
  friend class Document;
  static constexpr std::size_t kNoItem = static_cast<std::size_t>(-1);
  Value(const nlohmann::json* json, const Value* parent, std::string_view key, std::size_t index = kNoItem)
      : json_(json), parent_(parent), key_(key), index_(index) {}

  const nlohmann::json* json_;  // null: absent
  const Value* parent_;         // null: the document
  std::string_view key_;        // in the parent; empty for an item of an item
  std::size_t index_;           // in the list of that key
};

// A whole text. Refused: no JSON (the message has line and column), what passes the limits.
class Document {
 public:
  explicit Document(std::string_view text, const Limits& limits = {});
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  // The document's value; `name` stands for it in paths.
  [[nodiscard]] Value root(std::string_view name = {}) const { return {json_.get(), nullptr, name}; }
  // The same, which must be an object of such keys.
  [[nodiscard]] Value object(Keys keys) const { return root().object(keys); }

 private:
  std::unique_ptr<nlohmann::json> json_;
};

// Why a text is no JSON, from the parser's own words: "line 1, column 19: invalid literal; last read: ...".
[[nodiscard]] std::string plain_complaint(std::string what);

// The whole file as a text. Empty, or why not: missing, a directory, not permitted, longer than `most` bytes.
[[nodiscard]] std::string read_text_file(const std::string& path, std::size_t most, std::string* text);
[[nodiscard]] std::string read_text(std::istream& stream, const std::string& name, std::size_t most, std::string* text);

}  // namespace fdcg::json
