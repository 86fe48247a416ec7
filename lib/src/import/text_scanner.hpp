// SPDX-License-Identifier: Apache-2.0
// Tokens of a text file in memory, with line numbers. Numbers are correctly rounded. Beyond std::from_chars this accepts a
// leading
// '+', results out of range, and the spellings of NaN and infinity that C libraries print.
#pragma once

#include <algorithm>
#include <array>
#include <climits>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace fdcg::bake {

class TextScanner {
 public:
  struct Syntax {
    bool hash_comments = false;  // '#' starts a comment that ends with the line
    bool continuation = false;   // '\' before the end of a line joins it with the next
  };
  static constexpr int kNoDecimals = INT_MIN;  // a number without information about the file's precision

  // A byte order mark is skipped. Lines end in LF or CRLF; in CR where the text has no LF at all.
  TextScanner(std::string_view text, Syntax syntax);

  [[nodiscard]] std::uint32_t line() const { return line_; }  // 1-based
  [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(p_ - begin_); }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - p_); }
  [[nodiscard]] bool at_end() const { return p_ == end_; }
  [[nodiscard]] char peek() const { return p_ == end_ ? '\0' : *p_; }

  // Skips blanks and a comment; true at the end of the line.
  bool line_done() {
    skip_blanks();
    return p_ == end_ || *p_ == line_end_;
  }

  // Skips blanks, comments and ends of lines; false if the text ends before a token.
  bool find_token() {
    while (line_done()) {
      if (p_ == end_) return false;
      ++p_;
      ++line_;
    }
    return true;
  }

  // Skips what is left of this line, and its end. A continuation is not honoured: names and comments may end in '\'.
  void next_line() {
    const void* found = std::memchr(p_, line_end_, remaining());
    p_ = found == nullptr ? end_ : static_cast<const char*>(found) + 1;
    line_ += found != nullptr;
  }

  // Over binary data in a text: the lines in it are not counted. At most to the end.
  void skip(std::size_t bytes) { p_ += bytes < remaining() ? bytes : remaining(); }

  // Each of the following starts at the cursor, which must stand on a token. On false the cursor has not moved.

  // A real number, up to the token's end. last_decimals() then is the number of its decimals.
  bool read_real(double& value) {
    const char* q = p_;
    const bool is_negative = q != end_ && *q == '-';
    if (is_negative || (q != end_ && *q == '+')) ++q;
    const char* const unsigned_part = q;
    std::uint64_t mantissa = 0;  // of more than 19 digits: meaningless
    q = read_digits(q, mantissa);
    std::ptrdiff_t digits = q - unsigned_part, decimals = 0;
    if (q != end_ && *q == '.') {
      const char* const fraction = ++q;
      q = read_digits(q, mantissa);
      decimals = q - fraction;
      digits += decimals;
      if (q != end_ && *q == '#' && decimals == 0 && read_special(value)) return true;  // 1.#INF, where '#' is no comment
    }
    if (digits == 0) return read_special(value);
    bool is_blank_zero = false;  // "0e0" stands for any precision
    if (q != end_ && (*q == 'e' || *q == 'E')) {
      std::ptrdiff_t exponent = 0;
      q = read_exponent(q + 1, exponent);
      decimals -= exponent;
      is_blank_zero = mantissa == 0;
    }
    if (q == nullptr || (q != end_ && !ends_token(*q))) return read_special(value);
    // Up to here both factors are exact in a double, so that one operation rounds once: correctly (Clinger 1990).
    constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
    double magnitude = static_cast<double>(mantissa);
    if (digits > 19 || mantissa > kExact || decimals > kExactPowers || decimals < -kExactPowers) {
      magnitude = round_decimal({unsigned_part, static_cast<std::size_t>(q - unsigned_part)});
    } else if (decimals > 0) {
      magnitude /= kPowersOfTen[static_cast<std::size_t>(decimals)];
    } else {
      magnitude *= kPowersOfTen[static_cast<std::size_t>(-decimals)];
    }
    value = is_negative ? -magnitude : magnitude;
    last_decimals_ = is_blank_zero ? kNoDecimals : static_cast<int>(decimals);
    last_digits_ = digits > 19 ? static_cast<int>(std::min<std::ptrdiff_t>(digits, 1000)) : digits_of(mantissa);
    p_ = q;
    return true;
  }
  [[nodiscard]] int last_decimals() const { return last_decimals_; }
  // Of the same number: digits from the first that is not 0 on; of a NaN or an infinity those of the number before.
  [[nodiscard]] int last_digits() const { return last_digits_; }

  // An integer; stops at the first character that is not a digit. Saturates at +-2^62.
  bool read_integer_prefix(std::int64_t& value) {
    const char* q = p_;
    const bool negative = q != end_ && *q == '-';
    if (negative || (q != end_ && *q == '+')) ++q;
    const char* const first = q;
    std::int64_t magnitude = 0;
    constexpr std::int64_t kLimit = std::int64_t{1} << 62;
    while (q != end_ && is_digit(*q)) {
      magnitude = magnitude < kLimit / 10 - 1 ? magnitude * 10 + (*q - '0') : kLimit;
      ++q;
    }
    if (q == first) return false;
    value = negative ? -magnitude : magnitude;
    p_ = q;
    return true;
  }

  // A whole number that the token's end follows.
  bool read_integer(std::int64_t& value) {
    const char* const start = p_;
    if (read_integer_prefix(value) && token_ended()) return true;
    p_ = start;
    return false;
  }

  // The same, and not negative.
  bool read_count(std::uint64_t& value) {
    const char* const start = p_;
    std::int64_t number = 0;
    if (read_integer(number) && number >= 0) {
      value = static_cast<std::uint64_t>(number);
      return true;
    }
    p_ = start;
    return false;
  }

  [[nodiscard]] bool token_ended() const { return p_ == end_ || ends_token(*p_); }

  // Whether the token is `keyword`, which is in lower case, in either case.
  [[nodiscard]] bool is_keyword(std::string_view keyword) const {
    if (remaining() < keyword.size()) return false;
    for (std::size_t i = 0; i < keyword.size(); ++i) {
      if ((p_[i] | 0x20) != keyword[i]) return false;
    }
    return p_ + keyword.size() == end_ || ends_token(p_[keyword.size()]);
  }
  bool take_keyword(std::string_view keyword) {
    if (!is_keyword(keyword)) return false;
    p_ += keyword.size();
    return true;
  }

  // Everything up to the token's end. A control character that is no blank is a word by itself, so that reading words always
  // advances.
  std::string_view read_word() {
    const char* const start = p_;
    while (p_ != end_ && !ends_token(*p_))
      ++p_;
    if (p_ == start && p_ != end_) ++p_;
    return {start, static_cast<std::size_t>(p_ - start)};
  }

  // What is left of the line, without blanks around it, as names have it: '#' and '\\' are part of it.
  std::string_view read_rest_of_line();

  // The token at the cursor in quotes, for messages: at most 32 characters, unprintable ones as '?'.
  [[nodiscard]] std::string quote() const;

 private:
  static int digits_of(std::uint64_t mantissa) {
    int digits = 0;
    for (; mantissa != 0; mantissa /= 10)
      ++digits;
    return digits;
  }
  static bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }
  [[nodiscard]] bool ends_token(char c) const { return static_cast<unsigned char>(c) <= ' ' || c == comment_ || c == joiner_; }

  void skip_blanks() {
    for (; p_ != end_; ++p_) {
      const char c = *p_;
      if (c == ' ' || c == '\t') continue;
      if (c == line_end_) return;
      if (static_cast<unsigned char>(c) > ' ' && c != comment_ && c != joiner_) return;
      if (!skip_rare_blank()) return;
    }
  }
  bool skip_rare_blank();
  const char* read_digits(const char* q, std::uint64_t& number) const {
    while (q != end_ && is_digit(*q))
      number = number * 10 + static_cast<std::uint64_t>(*q++ - '0');
    return q;
  }
  const char* read_exponent(const char* q, std::ptrdiff_t& exponent) const;
  static double round_decimal(std::string_view decimal);
  bool read_special(double& value);

  static constexpr std::ptrdiff_t kExactPowers = 22;  // 10^22 is the largest power of ten that is a double
  static constexpr std::array<double, kExactPowers + 1> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                                        1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                                        1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

  const char* begin_;
  const char* p_;
  const char* end_;
  std::uint32_t line_ = 1;
  int last_decimals_ = kNoDecimals;
  int last_digits_ = 0;
  char line_end_ = '\n';
  char comment_ = ' ';  // ' ': none; every blank ends a token anyhow
  char joiner_ = ' ';
};

}  // namespace fdcg::bake
