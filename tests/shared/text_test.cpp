// SPDX-License-Identifier: Apache-2.0
// Messages that quote a file's bytes stay one line of UTF-8.
#include "shared/text.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "catch.hpp"

using namespace fdcg;
using nlohmann::json;

TEST_CASE("a message is one line of UTF-8, whatever bytes it quotes") {
  const struct {
    std::string bytes, line;
  } cases[] = {
      {"plain", "plain"},
      {"a\nb\x7F\x1B[m", "a?b??[m"},
      {"gr\xC3\xBC\xC3\x9F \xE2\x82\xAC \xF0\x9F\x98\x80", "gr\xC3\xBC\xC3\x9F \xE2\x82\xAC \xF0\x9F\x98\x80"},
      {"\xFF\xFE", "\uFFFD\uFFFD"},
      {"\xC3", "\uFFFD"},
      {"\x80\x80x", "\uFFFD\uFFFDx"},
      {"\xC0\xAF", "\uFFFD\uFFFD"},                      // overlong
      {"\xE0\x80\x80", "\uFFFD\uFFFD\uFFFD"},            // overlong
      {"\xED\xA0\x80", "\uFFFD\uFFFD\uFFFD"},            // a surrogate
      {"\xF4\x90\x80\x80", "\uFFFD\uFFFD\uFFFD\uFFFD"},  // beyond U+10FFFF
      {"\xF0\x80\x80\x80", "\uFFFD\uFFFD\uFFFD\uFFFD"},  // overlong
      {"\xC2\x85", "?"},                                 // U+0085, a line's end on some terminals
  };
  for (const auto& one : cases)
    CHECK(one_line(one.bytes) == one.line);
}

TEST_CASE("what is too long is cut between letters, and never away") {
  CHECK(in_quotes(std::string(39, 'a') + "\xC3\xBC") == "'" + std::string(39, 'a') + "...'");
  CHECK(in_quotes(std::string(38, 'a') + "\xC3\xBC...") == "'" + std::string(38, 'a') + "\xC3\xBC...'");
  CHECK(in_quotes(std::string(60, '\x80')) == "'" + one_line(std::string(40, '\x80')) + "...'");
  const std::string line = one_line(std::string(2000, '\xBF'));
  CHECK(line.size() == 3 * 1000 + 3);
}

TEST_CASE("valid_utf8 agrees with another decoder on every pair of bytes and many longer texts") {
  const auto other = [](const std::string& text) {
    try {
      return json::parse(json(text).dump()).get<std::string>() == text;
    } catch (const json::exception&) {
      return false;
    }
  };
  std::string text(2, ' ');
  for (int a = 0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      text[0] = static_cast<char>(a);
      text[1] = static_cast<char>(b);
      if ((valid_utf8(text) == text) != other(text)) FAIL(a << " " << b);
    }
  }
  for (const char* good : {"\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"}) {
    CHECK(other(good));
    CHECK(valid_utf8(good) == good);
  }
  for (const char* bad :
       {"\xE0\x9F\x80", "\xED\xA0\x80", "\xF0\x8F\x80\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xE2\x82"}) {
    CHECK_FALSE(other(bad));
    CHECK(valid_utf8(bad) != bad);
  }
  CHECK(valid_utf8("a\xFFz") == "a\xEF\xBF\xBDz");
  CHECK(valid_utf8("\xC3\xA9t\xC3\xA9", 3) == "\xC3\xA9t...");
  CHECK(valid_utf8("\xC3\xA9t\xC3\xA9", 4) == "\xC3\xA9t...");
}

TEST_CASE("printable text holds no control characters") {
  CHECK(printable("a\x1b[31m\n\x7f\xC2\x9B z\xC3\xA9") == "a?[31m??? z\xC3\xA9");
}

TEST_CASE("a misspelt word leads to the nearest one, if there is a near one") {
  CHECK(nearest("formt", {"full", "format", "fail-on"}) == "format");
  CHECK(did_you_mean("--formt", {"--full", "--format"}) == "; did you mean '--format'?");
  CHECK(did_you_mean("xyzzy", {"--full", "--format"}).empty());
  CHECK(did_you_mean("x", {}).empty());
  CHECK(nearest(std::string(41, 'a'), {"full"}).empty());
}
