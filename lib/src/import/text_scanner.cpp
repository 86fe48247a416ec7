// SPDX-License-Identifier: Apache-2.0
#include "import/text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

namespace fdcg::bake {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool has_prefix(std::string_view token, std::string_view lower_case) {
  return token.size() >= lower_case.size() &&
         std::equal(lower_case.begin(), lower_case.end(), token.begin(), [](char a, char b) { return a == lower(b); });
}
bool is_word(std::string_view token, std::string_view lower_case) {
  return token.size() == lower_case.size() && has_prefix(token, lower_case);
}

// inf, nan and nan(...) as C99 prints them; 1.#INF, 1.#QNAN, 1.#IND, 1.#SNAN and their rounded forms (1.#J, 1.#IO) as printed
// by old Microsoft libraries.
bool parse_special(std::string_view unsigned_token, double& value) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (is_word(unsigned_token, "inf") || is_word(unsigned_token, "infinity")) {
    value = kInfinity;
  } else if (is_word(unsigned_token, "nan") || is_word(unsigned_token, "qnan") || is_word(unsigned_token, "snan") ||
             (has_prefix(unsigned_token, "nan(") && unsigned_token.back() == ')')) {
    value = kNan;
  } else if (has_prefix(unsigned_token, "1.#inf") || has_prefix(unsigned_token, "1.#j")) {
    value = kInfinity;
  } else if (has_prefix(unsigned_token, "1.#ind") || has_prefix(unsigned_token, "1.#io") ||
             has_prefix(unsigned_token, "1.#qnan") || has_prefix(unsigned_token, "1.#snan") ||
             has_prefix(unsigned_token, "1.#nan") || has_prefix(unsigned_token, "1.#r")) {
    value = kNan;
  } else {
    return false;
  }
  return true;
}

constexpr std::ptrdiff_t kFarExponent = 1'000'000'000;  // larger exponents make no difference

// Whether a decimal that no double can hold is too large; else it is too small.
bool is_large(std::string_view decimal) {
  const std::size_t mantissa_end = std::min(decimal.find_first_of("eE"), decimal.size());
  const std::string_view mantissa = decimal.substr(0, mantissa_end);
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return false;
  const auto point = static_cast<std::ptrdiff_t>(std::min(mantissa.find('.'), mantissa.size()));
  std::ptrdiff_t exponent = 0;
  const bool is_negative = decimal.substr(mantissa_end).find('-') != std::string_view::npos;
  for (const char c : decimal.substr(mantissa_end)) {
    if (c >= '0' && c <= '9') exponent = std::min(exponent * 10 + (c - '0'), kFarExponent);
  }
  return point - static_cast<std::ptrdiff_t>(first) + (is_negative ? -exponent : exponent) > 0;
}

}  // namespace

TextScanner::TextScanner(std::string_view text, Syntax syntax) : begin_(text.data()), p_(begin_), end_(begin_ + text.size()) {
  if (text.starts_with("\xEF\xBB\xBF")) p_ += 3;
  const auto has = [text](char c) { return text.find(c) != std::string_view::npos; };
  if (!has('\n') && has('\r')) line_end_ = '\r';
  if (syntax.hash_comments) comment_ = '#';
  if (syntax.continuation) joiner_ = '\\';
}

// At a character that is neither space, tab nor the line's end: true if it is to be skipped with the blanks; then the cursor is
// on its last byte.
bool TextScanner::skip_rare_blank() {
  const char c = *p_;
  if (c == '\r' || c == '\v' || c == '\f') return true;
  if (c == '#' && comment_ == '#') {
    const void* found = std::memchr(p_, line_end_, remaining());
    p_ = found == nullptr ? end_ : static_cast<const char*>(found);
    --p_;  // the caller advances
    return true;
  }
  if (c == '\\' && joiner_ == '\\') {
    const char* q = p_ + 1;
    while (q != end_ && *q != line_end_ && (*q == ' ' || *q == '\t' || *q == '\r'))
      ++q;
    if (q == end_ || *q != line_end_) return false;
    p_ = q;
    ++line_;
    return true;
  }
  return false;
}

// The end of the exponent that starts at q, after its 'e'; nullptr if it has no digit.
const char* TextScanner::read_exponent(const char* q, std::ptrdiff_t& exponent) const {
  const bool is_negative = q != end_ && *q == '-';
  if (is_negative || (q != end_ && *q == '+')) ++q;
  const char* const first = q;
  for (; q != end_ && is_digit(*q); ++q)
    exponent = std::min(exponent * 10 + (*q - '0'), kFarExponent);
  if (is_negative) exponent = -exponent;
  return q == first ? nullptr : q;
}

// Of digits, a point and an exponent, already known to be well formed.
double TextScanner::round_decimal(std::string_view decimal) {
  double value = 0;
  const auto [end, error] = std::from_chars(decimal.data(), decimal.data() + decimal.size(), value);
  if (error == std::errc::result_out_of_range) return is_large(decimal) ? std::numeric_limits<double>::infinity() : 0.0;
  return value;
}

bool TextScanner::read_special(double& value) {
  const char* q = p_;
  const auto is_in_special = [&q, this] {
    return *q == '#' && q - p_ >= 2 && q[-1] == '.' && q[-2] == '1' && q + 1 != end_ && lower(q[1]) >= 'a' &&
           lower(q[1]) <= 'z';
  };
  while (q != end_ && (!ends_token(*q) || is_in_special()))
    ++q;
  std::string_view token(p_, static_cast<std::size_t>(q - p_));
  const bool is_negative = token.starts_with('-');
  if (is_negative || token.starts_with('+')) token.remove_prefix(1);
  double magnitude = 0;
  if (!parse_special(token, magnitude)) return false;
  value = is_negative ? -magnitude : magnitude;
  last_decimals_ = kNoDecimals;
  p_ = q;
  return true;
}

std::string_view TextScanner::read_rest_of_line() {
  const void* found = std::memchr(p_, line_end_, remaining());
  const char* const start = p_;
  p_ = found == nullptr ? end_ : static_cast<const char*>(found);
  const std::string_view rest(start, static_cast<std::size_t>(p_ - start));
  constexpr std::string_view kBlanks = " \t\r\v\f";
  const std::size_t first = rest.find_first_not_of(kBlanks);
  return first == std::string_view::npos ? std::string_view() : rest.substr(first, rest.find_last_not_of(kBlanks) - first + 1);
}

std::string TextScanner::quote() const {
  constexpr std::size_t kShown = 32;
  std::string text = "'";
  const char* q = p_;
  for (; q != end_ && static_cast<unsigned char>(*q) > ' ' && text.size() <= kShown; ++q) {
    text += *q < 0x7F && *q > ' ' ? *q : '?';
  }
  if (q == p_ && q != end_ && static_cast<unsigned char>(*q) < ' ') text += '?';
  return text + "'";
}

}  // namespace fdcg::bake
