// SPDX-License-Identifier: Apache-2.0
// Messages that quote a file's bytes stay one line of UTF-8.
#include <string>

#include "base/words.hpp"
#include "catch.hpp"

using namespace fdcg::dev;

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
  CHECK(in_quotes(std::string(60, '\x80')) == "'" + std::string(40, '\x80') + "...'");
  const std::string line = one_line(std::string(2000, '\xBF'));
  CHECK(line.size() == 3 * 1000 + 3);
}
