// SPDX-License-Identifier: Apache-2.0
// Reports that are lines of text, as devices of one's own send them over a serial line: "17 0.0125 -3e-4 0\n", numbers in
// decimal and words in columns. Names of the layout's columns are its fields' offsets. No heap, no locale; cost linear in the
// line.
#pragma once

#include <cstdint>

#include "profile/profile.hpp"

namespace fdcg::dev {

inline constexpr int kMaxColumns = 32;
inline constexpr int kWordBytes = 4;  // of a constant: its letters are the bytes of Field::constant, the first the least

// A line that was read, in columns. Where it ends in a line feed, or that and a carriage return, these do not count.
class TextColumns {
 public:
  TextColumns(const ReportLayout& layout, const std::uint8_t* line, int bytes);
  bool are_as_laid_out() const { return is_right_; }
  // Of a field's column; false: something else stands there. NaN and infinity are numbers.
  bool number(const Field& field, double* number) const;
  bool count(const Field& field, std::uint32_t* count) const;  // decimal digits alone
  bool is_word(const Field& field) const;

 private:
  const char *begin_[kMaxColumns] = {}, *end_[kMaxColumns] = {};
  bool is_right_ = false;
};

// A line that is written, column by column.
class TextLine {
 public:
  TextLine(const ReportLayout& layout, std::uint8_t* data) : layout_(layout), data_(data) {}
  void add(double number);  // nine digits; what is not finite as 0
  void add(std::uint32_t count);
  void add_word(const Field& field);
  int end();  // the line feed; how many bytes in all

 private:
  void separate();

  const ReportLayout& layout_;
  std::uint8_t* data_;
  int bytes_ = 0;
};

const Field* field_at(const ReportLayout& layout, int column);  // null: none
// The most bytes that a line may have which is written by this layout.
int longest_line(const ReportLayout& layout);

}  // namespace fdcg::dev
