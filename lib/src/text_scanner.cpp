// SPDX-License-Identifier: Apache-2.0
#include "text_scanner.hpp"

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

// inf, nan and nan(...) as C99 prints them; 1.#INF, 1.#QNAN, 1.#IND, 1.#SNAN and what rounding leaves of them (1.#J, 1.#IO) as
// Microsoft's library did.
bool read_special(std::string_view unsigned_token, double& value) {
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

// What a decimal's own characters say about it.
struct Decimal {
  bool is_valid = false;
  bool is_zero = true;
  bool has_exponent = false;
  int decimals = 0;                  // digits after the point, less the exponent: the last digit is worth 10^-decimals
  std::ptrdiff_t leading_power = 0;  // the first digit that is not 0 is worth 10^leading_power
};

Decimal examine(std::string_view token) {
  constexpr std::ptrdiff_t kFar = 1'000'000;  // exponents beyond it change nothing any more
  Decimal result;
  std::size_t i = 0;
  std::ptrdiff_t digits = 0, point = -1, first = -1;
  for (; i < token.size(); ++i) {
    const char c = token[i];
    if (c == '.' && point < 0) {
      point = digits;
    } else if (c >= '0' && c <= '9') {
      if (c != '0' && first < 0) first = digits;
      ++digits;
    } else {
      break;
    }
  }
  if (digits == 0) return result;
  std::ptrdiff_t exponent = 0;
  if (i < token.size()) {
    if (token[i] != 'e' && token[i] != 'E') return result;
    ++i;
    const bool negative = i < token.size() && token[i] == '-';
    if (i < token.size() && (token[i] == '-' || token[i] == '+')) ++i;
    if (i == token.size()) return result;
    for (; i < token.size(); ++i) {
      if (token[i] < '0' || token[i] > '9') return result;
      exponent = std::min(exponent * 10 + (token[i] - '0'), kFar);
    }
    if (negative) exponent = -exponent;
    result.has_exponent = true;
  }
  if (point < 0) point = digits;
  result.is_valid = true;
  result.is_zero = first < 0;
  result.leading_power = point - 1 - first + exponent;
  result.decimals = static_cast<int>(std::clamp(digits - point - exponent, -kFar, kFar));
  return result;
}

}  // namespace

TextScanner::TextScanner(std::string_view text, Syntax syntax) : begin_(text.data()), p_(begin_), end_(begin_ + text.size()) {
  if (text.starts_with("\xEF\xBB\xBF")) p_ += 3;
  const bool has_cr = !text.empty() && std::memchr(begin_, '\r', text.size()) != nullptr;
  if (has_cr && std::memchr(begin_, '\n', text.size()) == nullptr) line_end_ = '\r';
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
    --p_;  // the caller steps on
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

const char* TextScanner::real_token_end() const {
  const char* q = p_;
  while (q != end_) {
    const bool in_special =
        *q == '#' && q - p_ >= 2 && q[-1] == '.' && q[-2] == '1' && q + 1 != end_ && lower(q[1]) >= 'a' && lower(q[1]) <= 'z';
    if (ends_token(*q) && !in_special) break;
    ++q;
  }
  return q;
}

bool TextScanner::read_unusual_real(double& value) {
  const char* const token_end = real_token_end();
  std::string_view token(p_, static_cast<std::size_t>(token_end - p_));
  const bool negative = token.starts_with('-');
  if (negative || token.starts_with('+')) token.remove_prefix(1);
  double magnitude = 0;
  last_decimals_ = kNoDecimals;
  if (const Decimal decimal = examine(token); decimal.is_valid) {
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), magnitude, std::chars_format::general);
    if (error == std::errc::result_out_of_range) {
      magnitude = !decimal.is_zero && decimal.leading_power > 0 ? std::numeric_limits<double>::infinity() : 0.0;
    } else if (error != std::errc{} || end != token_end) {
      return false;
    }
    if (!(decimal.is_zero && decimal.has_exponent)) last_decimals_ = decimal.decimals;  // "0e0" stands for any precision
  } else if (!read_special(token, magnitude)) {
    return false;
  }
  value = negative ? -magnitude : magnitude;
  p_ = token_end;
  return true;
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
