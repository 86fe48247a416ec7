// SPDX-License-Identifier: Apache-2.0
#include "base/printable.hpp"

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/json_writer.hpp"
#include "catch.hpp"

using namespace fdcg::bake;
using nlohmann::json;

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

TEST_CASE("JsonWriter writes what another parser reads back") {
  std::string out;
  JsonWriter writer(out);
  writer.begin_object();
  writer.member("text", "a\"\\\n\t\x01\x7f\xC3\xA9\xFF");
  writer.member("largest", std::numeric_limits<std::uint64_t>::max());
  writer.member("least", std::numeric_limits<std::int64_t>::min());
  writer.key("numbers");
  writer.begin_array(JsonWriter::Layout::one_line);
  for (const double number : {0.1, -0.0, 1e-300, 5e-324, 1.7976931348623157e308, std::numeric_limits<double>::quiet_NaN()})
    writer.value(number);
  writer.end_array();
  writer.key("empty");
  writer.begin_object();
  writer.end_object();
  writer.key("nested");
  writer.begin_array();
  writer.begin_array();
  writer.value(true);
  writer.end_array();
  writer.splice("[1, 2]");
  writer.splice("");
  writer.end_array();
  writer.end_object();
  CAPTURE(out);
  const json parsed = json::parse(out);
  CHECK(parsed["text"] == "a\"\\\n\t\x01\x7f\xC3\xA9\xEF\xBF\xBD");
  CHECK(parsed["largest"] == std::numeric_limits<std::uint64_t>::max());
  CHECK(parsed["least"] == std::numeric_limits<std::int64_t>::min());
  CHECK(parsed["numbers"] == json::array({0.1, -0.0, 1e-300, 5e-324, 1.7976931348623157e308, nullptr}));
  CHECK(parsed["empty"].empty());
  CHECK(parsed["nested"] == json::array({json::array({true}), json::array({1, 2})}));
  CHECK(out.find("\"numbers\": [0.1, -0, ") != std::string::npos);
}
