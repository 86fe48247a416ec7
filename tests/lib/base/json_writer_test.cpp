// SPDX-License-Identifier: Apache-2.0
#include "base/json_writer.hpp"

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "catch.hpp"

using namespace fdcg::bake;
using nlohmann::json;

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
