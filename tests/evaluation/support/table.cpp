// SPDX-License-Identifier: Apache-2.0
#include "table.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace fdcg::test {
namespace {

// RFC 4180: a cell with a comma, a quote or a line end is quoted.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string in_folder(const std::string& folder, const std::string& file) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw std::runtime_error(folder + ": cannot be made (" + error.message() + "); name a folder that you may write to");
  return (std::filesystem::path(folder) / file).string();
}

}  // namespace

std::string cell(double value) {
  if (std::isnan(value)) return "nan";
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

Table::Table(const std::string& folder, const std::string& name, const std::vector<std::string>& columns)
    : path_(in_folder(folder, name + ".csv")), columns_(columns.size()), file_(path_) {
  write(columns);
}

void Table::write(const std::vector<std::string>& cells) {
  if (cells.size() != columns_) {
    throw std::logic_error(path_ + ": a row of " + std::to_string(cells.size()) + " cells under " + std::to_string(columns_) +
                           " columns");
  }
  for (std::size_t k = 0; k < cells.size(); ++k)
    file_ << (k > 0 ? "," : "") << quoted(cells[k]);
  file_ << '\n' << std::flush;
  if (!file_) throw std::runtime_error(path_ + ": cannot be written; is the disk full, the folder there and yours?");
}

Bars::Bars(const std::string& folder, const std::string& program, bool stops_at_first)
    : table_(folder, program + ".bars", {"bar", "measured", "relation", "limit", "unit", "verdict", "note"}),
      stops_at_first_(stops_at_first) {}

bool Bars::at_most(const std::string& bar, double measured, double limit, const std::string& unit, const std::string& note) {
  return judge(bar, measured, true, limit, unit, note);
}

bool Bars::at_least(const std::string& bar, double measured, double limit, const std::string& unit, const std::string& note) {
  return judge(bar, measured, false, limit, unit, note);
}

bool Bars::judge(const std::string& bar, double measured, bool is_at_most, double limit, const std::string& unit,
                 const std::string& note) {
  const bool holds = is_at_most ? measured <= limit : measured >= limit;  // NaN holds nothing
  failures_ += !holds;
  table_.row(bar, measured, is_at_most ? "at most" : "at least", limit, unit, holds ? "ok" : "FAIL", note);
  std::printf("%-4s %s: %s %s (%s %s)%s%s\n", holds ? "ok" : "FAIL", bar.c_str(), cell(measured).c_str(), unit.c_str(),
              is_at_most ? "at most" : "at least", cell(limit).c_str(), note.empty() ? "" : "; ", note.c_str());
  std::fflush(stdout);
  if (!holds && stops_at_first_) std::_Exit(1);
  return holds;
}

}  // namespace fdcg::test
