// SPDX-License-Identifier: Apache-2.0
#include "import/text_scanner.hpp"

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "catch.hpp"

using fdcg::bake::TextScanner;

namespace {

bool read(const std::string& text, double& value) {
  TextScanner scan(text, {.hash_comments = true});
  return scan.read_real(value) && scan.line_done();
}
double real(const std::string& text) {
  double value = 0;
  INFO(text);
  REQUIRE(read(text, value));
  return value;
}
int decimals(const std::string& text) {
  TextScanner scan(text, {});
  double value = 0;
  REQUIRE(scan.read_real(value));
  return scan.last_decimals();
}

}  // namespace

TEST_CASE("a real number is the double that strtod gives, bit for bit") {
  // glibc's strtod rounds correctly, and so is the yardstick.
  std::mt19937_64 random(1);
  for (int i = 0; i < 300'000; ++i) {
    char text[64];
    const int style = i % 6, digits = static_cast<int>(random() % 22);
    const double uniform = static_cast<double>(random() >> 11) * 0x1p-53, any = std::bit_cast<double>(random());
    if (style == 0) std::snprintf(text, sizeof text, "%.*f", digits, (uniform - 0.5) * 100);
    if (style == 1) std::snprintf(text, sizeof text, "%.*e", digits, std::isfinite(any) ? any : 1.0);
    if (style == 2) std::snprintf(text, sizeof text, "%.*g", digits, (uniform - 0.5) * 1e-3);
    if (style == 3)
      std::snprintf(text, sizeof text, "%llu.%llue%d", static_cast<unsigned long long>(random() >> random() % 64),
                    static_cast<unsigned long long>(random() >> random() % 64), static_cast<int>(random() % 700) - 350);
    if (style == 4) std::snprintf(text, sizeof text, "%.17g", std::bit_cast<double>(random() >> 12));  // denormals
    if (style == 5) std::snprintf(text, sizeof text, "%.9g", static_cast<double>(static_cast<float>(uniform)));
    const double expected = std::strtod(text, nullptr), got = real(text);
    if (std::bit_cast<std::uint64_t>(expected) != std::bit_cast<std::uint64_t>(got)) {
      FAIL(text << ": " << got << " in place of " << expected);
    }
  }
}

TEST_CASE("numbers halfway between two doubles round to even") {
  CHECK(real("9007199254740993") == 9007199254740992.0);
  CHECK(real("9007199254740995") == 9007199254740996.0);
  CHECK(real("1.00000000000000011102230246251565404236316680908203125") == 1.0);
  CHECK(real("1.00000000000000011102230246251565404236316680908203126") == 1.0 + 0x1p-52);
}

TEST_CASE("results out of range go to infinity or to the nearest") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  CHECK(real("1e400") == kInfinity);
  CHECK(real("-1e99999999999999999999") == -kInfinity);
  CHECK(real("1" + std::string(400, '0')) == kInfinity);
  CHECK(real("1" + std::string(400, '0') + "e-400") == 1);
  CHECK(real("1" + std::string(800, '0') + "e-300") == kInfinity);
  CHECK(real("0." + std::string(800, '0') + "1e300") == 0);
  CHECK(real("1e-400") == 0);
  CHECK(std::signbit(real("-1e-99999999999999999999")));
  CHECK(real("4.9406564584124654e-324") == 0x1p-1074);
  CHECK(real("2.4703282292062328e-324") == 0x1p-1074);
  CHECK(real("2.4703282292062327e-324") == 0);
  CHECK(real("2.2250738585072011e-308") == std::strtod("2.2250738585072011e-308", nullptr));
  CHECK(real("0e999999999999") == 0);
}

TEST_CASE("signs, bare points and both exponent letters are understood") {
  CHECK(real("+1.5") == 1.5);
  CHECK(real(".5") == 0.5);
  CHECK(real("-.5E+1") == -5);
  CHECK(real("5.") == 5);
  CHECK(real("1e+2") == 100);
  CHECK(std::signbit(real("-0")));
  CHECK(real("1.") == 1);
  CHECK(real("+1") == 1);
  CHECK(real("00001.50") == 1.5);
  CHECK(real("5e-324") == 0x1p-1074);
}

TEST_CASE("NaN and infinity are understood in the spellings of C libraries") {
  for (const char* text : {"inf", "+inf", "Infinity", "INF", "1.#INF", "1.#INF00", "+1.#J"})
    CHECK(real(text) == HUGE_VAL);
  for (const char* text : {"-inf", "-Infinity", "-1.#INF"})
    CHECK(real(text) == -HUGE_VAL);
  for (const char* text :
       {"nan", "-nan", "+NaN", "nan(ind)", "-nan(ind)", "NAN(snan)", "1.#QNAN", "-1.#IND", "1.#SNAN", "-1.#IND00", "1.#IO"}) {
    CHECK(std::isnan(real(text)));
  }
}

TEST_CASE("invalid numbers are refused, and the cursor does not move") {
  for (const char* text : {"",      "-",     "+",     ".",   "e5",  "1e",  "1e+",    "1.2.3",    "1,5",  "0x10", "1f",
                           "infi",  "nano",  "nan(",  "--1", "+-1", "1.#", "1.#FOO", "one",      "\xff", "1d5",  "1D+5",
                           "0x1p3", "1'000", "1_000", "1;",  "..5", ".e5", "1e5.5",  "\xC2\xB2", "inf1"}) {
    TextScanner scan(text, {});
    double value = 7;
    INFO(text);
    CHECK_FALSE(scan.read_real(value));
    CHECK(value == 7);
    CHECK(scan.offset() == 0);
  }
}

TEST_CASE("the decimals of a number are those of its last digit") {
  CHECK(decimals("1.250") == 3);
  CHECK(decimals("12") == 0);
  CHECK(decimals("1.25e-3") == 5);
  CHECK(decimals("1.25e1") == 1);
  CHECK(decimals("1.5e3") == -2);
  CHECK(decimals("0.000") == 3);
  CHECK(decimals("0e-9") == TextScanner::kNoDecimals);
  CHECK(decimals("nan") == TextScanner::kNoDecimals);
  CHECK(decimals("0.12345678901234567890123") == 23);
}

TEST_CASE("whole numbers saturate and end where the caller says") {
  std::int64_t value = 0;
  TextScanner big("99999999999999999999999 -99999999999999999999999 12/3 4x", {});
  CHECK(big.read_integer(value));
  CHECK(value == std::int64_t{1} << 62);
  REQUIRE(big.find_token());
  CHECK(big.read_integer(value));
  CHECK(value == -(std::int64_t{1} << 62));
  REQUIRE(big.find_token());
  CHECK_FALSE(big.read_integer(value));
  CHECK(big.read_integer_prefix(value));
  CHECK(value == 12);
  CHECK(big.peek() == '/');
}

TEST_CASE("lines are counted over LF, CRLF, CR, comments and joined lines") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string text = "a # x" + end + end + "  b \\" + end + "c" + end;
    TextScanner scan(text, {.hash_comments = true, .continuation = true});
    REQUIRE(scan.find_token());
    CHECK(scan.read_word() == "a");
    CHECK(scan.line_done());
    REQUIRE(scan.find_token());
    CHECK(scan.line() == 3);
    CHECK(scan.read_word() == "b");
    CHECK_FALSE(scan.line_done());
    CHECK(scan.line() == 4);
    CHECK(scan.read_word() == "c");
    CHECK_FALSE(scan.find_token());
    CHECK(scan.at_end());
  }
}

TEST_CASE("a control character is a separate word, so that reading words terminates") {
  TextScanner scan(std::string_view("\x01\0b\x02 c", 6), {});
  std::vector<std::string> words;
  while (words.size() < 10 && scan.find_token())
    words.emplace_back(scan.read_word());
  CHECK(words == std::vector<std::string>{"\x01", std::string(1, '\0'), "b", "\x02", "c"});
}

TEST_CASE("a comment ends a number, and a byte order mark is skipped") {
  TextScanner scan(
      "\xEF\xBB\xBF"
      "1.5# note",
      {.hash_comments = true});
  double value = 0;
  CHECK(scan.read_real(value));
  CHECK(value == 1.5);
  CHECK(scan.line_done());
  TextScanner one("1.# note", {.hash_comments = true});
  CHECK(one.read_real(value));
  CHECK(value == 1);
}

TEST_CASE("the rest of a line is one name") {
  TextScanner scan("o  a #1 \\ \t\r\n\r\nb", {.hash_comments = true, .continuation = true});
  CHECK(scan.read_word() == "o");
  CHECK(scan.read_rest_of_line() == "a #1 \\");
  CHECK(scan.line() == 1);
  scan.next_line();
  CHECK(scan.read_rest_of_line().empty());
  scan.next_line();
  CHECK(scan.line() == 3);
  CHECK(scan.read_rest_of_line() == "b");
  CHECK(scan.read_rest_of_line().empty());
}

TEST_CASE("a token is quoted on one line of printable characters") {
  CHECK(TextScanner("ab\x01 c", {}).quote() == "'ab'");
  CHECK(TextScanner("a\xC3\xA4z", {}).quote() == "'a??z'");
  CHECK(TextScanner(std::string(100, 'x'), {}).quote() == "'" + std::string(32, 'x') + "'");
  CHECK(TextScanner(std::string(1, '\0'), {}).quote() == "'?'");
}
