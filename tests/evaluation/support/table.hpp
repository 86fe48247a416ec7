// SPDX-License-Identifier: Apache-2.0
// What an evaluation program leaves behind: CSV tables, one observation a row, and what of it a bar was set for.
#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace fdcg::test {

// A number as a table has it: nine significant digits, "nan" and "inf" spelled out.
std::string cell(double value);
inline std::string cell(std::string_view text) {
  return std::string(text);
}
template <class Integer>
requires std::is_integral_v<Integer> std::string cell(Integer value) {
  return std::to_string(value);
}

// FOLDER/NAME.csv. The header is written at once, each row when it is complete: what a program that is stopped has measured is
// there to read. Units belong into the columns' names (`p50_ns`). Throws std::runtime_error, naming the file, where it cannot
// be written, and std::logic_error where a row has not as many cells as there are columns.
class Table {
 public:
  Table(const std::string& folder, const std::string& name, const std::vector<std::string>& columns);
  template <class... Cells>
  void row(const Cells&... cells) {
    write({cell(cells)...});
  }
  void write(const std::vector<std::string>& cells);

 private:
  std::string path_;
  std::size_t columns_;
  std::ofstream file_;
};

// FOLDER/PROGRAM.bars.csv: bar, measured, relation, limit, unit, verdict (ok, FAIL), note. Each is said on standard output too.
class Bars {
 public:
  // `stops_at_first`: the first bar that fails ends the program, with exit code 1.
  Bars(const std::string& folder, const std::string& program, bool stops_at_first = false);
  bool at_most(const std::string& bar, double measured, double limit, const std::string& unit, const std::string& note = "");
  bool at_least(const std::string& bar, double measured, double limit, const std::string& unit, const std::string& note = "");
  [[nodiscard]] int failures() const { return failures_; }

 private:
  bool judge(const std::string& bar, double measured, bool is_at_most, double limit, const std::string& unit,
             const std::string& note);
  Table table_;
  bool stops_at_first_;
  int failures_ = 0;
};

}  // namespace fdcg::test
