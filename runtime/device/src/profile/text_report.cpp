// SPDX-License-Identifier: Apache-2.0
#include "profile/text_report.hpp"

#include <charconv>
#include <cmath>

namespace fdcg::dev {
namespace {

constexpr int kDigits = 9;        // a float's value comes back from so many
constexpr int kNumberBytes = 16;  // "-1.23456789e-300"
constexpr int kCountBytes = 10;   // "4294967295"

bool is_space(char c) {
  return c == ' ' || c == '\t';
}

template <class Number>
bool parse(const char* begin, const char* end, Number* number) {
  const std::from_chars_result result = std::from_chars(begin, end, *number);
  return begin != end && result.ec == std::errc() && result.ptr == end;
}

}  // namespace

TextColumns::TextColumns(const ReportLayout& layout, const std::uint8_t* line, int bytes) {
  const char* at = reinterpret_cast<const char*>(line);
  const char* end = at + (bytes < 0 || bytes > kMaxReportBytes ? 0 : bytes);
  if (end > at && end[-1] == '\n') --end;
  if (end > at && end[-1] == '\r') --end;
  const auto skip_spaces = [&] {
    while (at < end && is_space(*at))
      ++at;
  };
  const bool is_spaced = layout.separator == ' ';
  int columns = 0;
  skip_spaces();
  while (at < end || (!is_spaced && columns > 0)) {
    if (columns == layout.columns) return;
    const char* const begin = at;
    while (at < end && *at != layout.separator && !(is_spaced && is_space(*at)))
      ++at;
    const char* stop = at;
    while (stop > begin && is_space(stop[-1]))
      --stop;
    begin_[columns] = begin;
    end_[columns++] = stop;
    if (at == end) break;
    ++at;  // the separator
    skip_spaces();
  }
  is_right_ = columns == layout.columns;
}

bool TextColumns::number(const Field& field, double* number) const {
  const char* const begin = begin_[field.offset];
  const bool has_plus = begin != end_[field.offset] && *begin == '+';
  return parse(begin + has_plus, end_[field.offset], number);
}

bool TextColumns::count(const Field& field, std::uint32_t* count) const {
  return parse(begin_[field.offset], end_[field.offset], count);
}

bool TextColumns::is_word(const Field& field) const {
  std::uint32_t word = 0;
  int bytes = 0;
  for (const char* c = begin_[field.offset]; c < end_[field.offset]; ++c, ++bytes) {
    if (bytes == kWordBytes || *c == 0) return false;
    word |= std::uint32_t{static_cast<unsigned char>(*c)} << 8 * bytes;
  }
  return word == field.constant;
}

void TextLine::separate() {
  if (bytes_ > 0) data_[bytes_++] = static_cast<std::uint8_t>(layout_.separator);
}

void TextLine::add(double number) {
  separate();
  char* const begin = reinterpret_cast<char*>(data_) + bytes_;
  const double finite = std::isfinite(number) ? number : 0;
  bytes_ +=
      static_cast<int>(std::to_chars(begin, begin + kNumberBytes, finite, std::chars_format::general, kDigits).ptr - begin);
}

void TextLine::add(std::uint32_t count) {
  separate();
  char* const begin = reinterpret_cast<char*>(data_) + bytes_;
  bytes_ += static_cast<int>(std::to_chars(begin, begin + kCountBytes, count).ptr - begin);
}

void TextLine::add_word(const Field& field) {
  separate();
  for (std::uint32_t word = field.constant; word != 0; word >>= 8)
    data_[bytes_++] = static_cast<std::uint8_t>(word);
}

int TextLine::end() {
  data_[bytes_++] = '\n';
  return bytes_;
}

const Field* field_at(const ReportLayout& layout, int column) {
  for (int i = 0; i < layout.field_count; ++i) {
    if (layout.fields[i].offset == column) return &layout.fields[i];
  }
  return nullptr;
}

int longest_line(const ReportLayout& layout) {
  int bytes = layout.columns;  // separators, and the line feed
  for (int column = 0; column < layout.columns; ++column) {
    const Field* const field = field_at(layout, column);
    const bool is_number = field != nullptr && (field->role == Role::kAxis || field->role == Role::kEffort);
    bytes += field == nullptr ? 1 : field->role == Role::kConstant ? kWordBytes : is_number ? kNumberBytes : kCountBytes;
  }
  return bytes;
}

}  // namespace fdcg::dev
