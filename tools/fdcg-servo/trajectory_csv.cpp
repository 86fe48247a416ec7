// SPDX-License-Identifier: Apache-2.0
#include "trajectory_csv.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

namespace fdcg::servo {
namespace {

constexpr std::size_t kMissing = static_cast<std::size_t>(-1);
constexpr std::array<std::string_view, 4> kColumns = {"t", "x", "y", "z"};
constexpr std::size_t kShownCharacters = 40;  // of a wrong value, in the message

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// Takes the next line off the text, without its end.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  return line;
}

// Splits at commas outside of double quotes; the quotes around a whole field are dropped.
void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    std::string_view field = trimmed(line.substr(begin, i - begin));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = trimmed(field.substr(1, field.size() - 2));
    fields.push_back(field);
    begin = i + 1;
  }
}

bool parse_double(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

// What came from the file, safe to print on one line.
std::string shown(std::string_view value) {
  std::string text(value.substr(0, kShownCharacters));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7F; }, '?');
  return "'" + text + (value.size() > kShownCharacters ? "...'" : "'");
}

class Parser {
 public:
  Parser(const std::string& name, std::string& error) : name_(name), error_(error) {}

  bool header(std::string_view line) {
    split(line, fields_);
    for (std::size_t k = 0; k < kColumns.size(); ++k) {
      if (std::count(fields_.begin(), fields_.end(), kColumns[k]) > 1) {
        return refuse("the header names the column '" + std::string(kColumns[k]) + "' twice");
      }
      const auto found = std::find(fields_.begin(), fields_.end(), kColumns[k]);
      if (found == fields_.end()) {
        return refuse("the header " + shown(line) + " has no column '" + std::string(kColumns[k]) +
                      "'; it must name t, x, y and z");
      }
      column_[k] = static_cast<std::size_t>(found - fields_.begin());
    }
    return true;
  }

  bool row(std::string_view line, TrajectoryPoint& point) {
    split(line, fields_);
    std::array<double, 4> values{};
    for (std::size_t k = 0; k < kColumns.size(); ++k) {
      if (column_[k] >= fields_.size()) {
        return refuse(std::to_string(fields_.size()) + " columns, but '" + std::string(kColumns[k]) + "' is number " +
                      std::to_string(column_[k] + 1));
      }
      const std::string_view field = fields_[column_[k]];
      if (!parse_double(field, values[k])) {
        return refuse("column '" + std::string(kColumns[k]) + "' holds " + shown(field) +
                      ", which is not a number that a double can hold");
      }
    }
    if (!std::isfinite(values[0])) return refuse("the time is not finite");
    point = {values[0], {values[1], values[2], values[3]}};
    return true;
  }

  bool refuse(const std::string& what) {
    error_ = name_ + ", line " + std::to_string(line_) + ": " + what;
    return false;
  }
  void next_line() { ++line_; }

 private:
  const std::string& name_;
  std::string& error_;
  std::size_t line_ = 1;
  std::array<std::size_t, 4> column_{kMissing, kMissing, kMissing, kMissing};
  std::vector<std::string_view> fields_;
};

}  // namespace

bool parse_trajectory(std::string_view text, const std::string& name, std::vector<TrajectoryPoint>& points,
                      std::string& error) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  points.clear();
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
  Parser parser(name, error);
  if (text.empty()) {
    error = name + ": the file is empty; a trajectory starts with a header that names t, x, y and z";
    return false;
  }
  if (!parser.header(take_line(text))) return false;
  while (!text.empty()) {
    parser.next_line();
    const std::string_view line = take_line(text);
    if (trimmed(line).empty()) continue;
    TrajectoryPoint point;
    if (!parser.row(line, point)) return false;
    points.push_back(point);
  }
  if (!points.empty()) return true;
  error = name + ": a header but no row; nothing to replay";
  return false;
}

bool read_trajectory(const std::string& path, std::vector<TrajectoryPoint>& points, std::string& error) {
  const bool is_standard_input = path == "-";
  const std::string name = is_standard_input ? "standard input" : "'" + path + "'";
  const auto close_file = [](std::FILE* file) {
    if (file != stdin) std::fclose(file);
  };
  const std::unique_ptr<std::FILE, decltype(close_file)> file(is_standard_input ? stdin : std::fopen(path.c_str(), "rb"),
                                                              close_file);
  std::string text;
  std::size_t got = 0;
  errno = file == nullptr ? errno : 0;
  if (file != nullptr) {
    constexpr std::size_t kChunk = 1 << 20;
    do {
      const std::size_t size = text.size();
      text.resize(size + kChunk);
      got = std::fread(text.data() + size, 1, kChunk, file.get());
      text.resize(size + got);
    } while (got != 0);
  }
  if (file == nullptr || std::ferror(file.get()) != 0) {
    error = "cannot read " + name + ": " + std::strerror(errno);
    return false;
  }
  return parse_trajectory(text, is_standard_input ? name : path, points, error);
}

}  // namespace fdcg::servo
