// SPDX-License-Identifier: Apache-2.0
// Writes JSON (RFC 8259) incrementally, so that a report of millions of findings need not be held in memory.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shared/text.hpp"

namespace fdcg::bake {

// Appends to a string that the caller may empty at any time between two calls.
class JsonWriter {
 public:
  explicit JsonWriter(std::string& out) : out_(out) {}

  // Items one per line, or all on one line; containers inside a one-line container are on that line too.
  enum class Layout { lines, one_line };
  void begin_object(Layout layout = Layout::lines) { begin('{', layout); }
  void end_object() { end('}'); }
  void begin_array(Layout layout = Layout::lines) { begin('[', layout); }
  void end_array() { end(']'); }
  // As members of an object.
  void begin_object(std::string_view name, Layout layout = Layout::lines) { key(name), begin_object(layout); }
  void begin_array(std::string_view name, Layout layout = Layout::lines) { key(name), begin_array(layout); }

  void key(std::string_view name) {
    separate();
    quote(name);
    out_ += ": ";
    follows_key_ = true;
  }
  void value(std::string_view text) {  // any bytes: what is not UTF-8 is replaced
    separate();
    quote(text);
  }
  void value(const char* text) { value(std::string_view(text)); }
  void value(bool is_true) {
    separate();
    out_ += is_true ? "true" : "false";
  }
  template <class Integer>
  requires std::is_integral_v<Integer>
  void value(Integer number) { append_number(number); }
  void value(double number) {  // null where it is not finite; else the shortest digits that read back the same
    if (std::isfinite(number)) return append_number(number);
    separate();
    out_ += "null";
  }
  template <class Value>
  void member(std::string_view name, const Value& content) {
    key(name);
    value(content);
  }
  // Appends items written by another JsonWriter; an empty text appends none.
  void splice(std::string_view items) {
    if (items.empty()) return;
    separate();
    out_ += items;
  }

 private:
  struct Level {
    bool is_on_one_line = false;
    bool is_empty = true;
  };

  void begin(char bracket, Layout layout) {
    separate();
    out_ += bracket;
    levels_.push_back({layout == Layout::one_line || (!levels_.empty() && levels_.back().is_on_one_line), true});
  }
  void end(char bracket) {
    const Level level = levels_.back();
    levels_.pop_back();
    if (!level.is_on_one_line && !level.is_empty) break_line();
    out_ += bracket;
  }
  void break_line() {
    out_ += '\n';
    out_.append(levels_.size(), ' ');
  }
  // Writes the separator between the previous item and the next one.
  void separate() {
    if (follows_key_ || levels_.empty()) {
      follows_key_ = false;
      return;
    }
    Level& level = levels_.back();
    if (!level.is_empty) out_ += ',';
    if (!level.is_on_one_line) break_line();
    if (level.is_on_one_line && !level.is_empty) out_ += ' ';
    level.is_empty = false;
  }
  template <class Number>
  void append_number(Number number) {
    separate();
    char buffer[32];
    out_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr);
  }
  static bool is_plain(char c) { return c >= 0x20 && c < 0x7F && c != '"' && c != '\\'; }
  void quote(std::string_view text) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    out_ += '"';
    for (std::size_t at = 0; at < text.size();) {
      std::size_t plain = at;
      while (plain < text.size() && is_plain(text[plain]))
        ++plain;
      out_.append(text, at, plain - at);
      if (plain == text.size()) break;
      at = plain;
      const CodePoint point = code_point_at(text, at);
      if (point.bytes == 0) {
        out_ += kReplacement;
        ++at;
        continue;
      }
      if (point.value == '"' || point.value == '\\') out_ += '\\';
      if (point.value < 0x20) {
        out_ += "\\u00";
        out_ += kDigits[point.value >> 4];
        out_ += kDigits[point.value & 15u];
      } else {
        out_ += text.substr(at, point.bytes);
      }
      at += point.bytes;
    }
    out_ += '"';
  }

  std::string& out_;
  std::vector<Level> levels_;
  bool follows_key_ = false;
};

}  // namespace fdcg::bake
