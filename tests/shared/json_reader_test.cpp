// SPDX-License-Identifier: Apache-2.0
// The one reader of JSON: what it takes, and that all it refuses is refused by its place, with what is expected.
#include "shared/json/reader.hpp"

#include <functional>
#include <sstream>
#include <string>

#include "catch.hpp"

using namespace fdcg::json;

namespace {

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const Refusal& refused) {
    return refused.message;
  }
  return "";
}

std::string refusal(const std::string& text, const Limits& limits = {}) {
  return refusal([&] { const Document document(text, limits); });
}

constexpr const char* kFull = R"({"a": {"list": [{"x": 1}, {"y": [2, "three"]}], "word": "sphere"},
  "number": 2.5, "whole": 3.0, "large": 18446744073709551615, "id": "0x1F", "hex": "03 01fF", "yes": true, "none": null,
  "lines": "a\nb", "empty": ""})";

}  // namespace

TEST_CASE("values are read as they stand") {
  const Document document(kFull);
  const Value root = document.root();
  CHECK(root["number"].number() == 2.5);
  CHECK(root["whole"].integer(0, 3) == 3);
  CHECK(root["id"].id(31) == 31);
  CHECK(root["whole"].id(3) == 3);
  CHECK(root["hex"].hex(3, 3) == std::vector<std::uint8_t>{3, 1, 255});
  CHECK(root["yes"].boolean());
  CHECK(root["lines"].string() == "a\nb");
  const Value a = root["a"];
  CHECK(a["word"].text(6) == "sphere");
  CHECK(a["word"].choice({"box", "sphere"}) == 1);
  CHECK(a.keys() == std::vector<std::string>{"list", "word"});
  CHECK(a["list"].objects(2, 2).size() == 2);
  CHECK(root["none"]);
  CHECK_FALSE(root["nothing"]);
  CHECK(root["nothing"].number_or(7, {0, 1}) == 7);
  CHECK(root["number"].number_or(7, {0, 3}) == 2.5);
  CHECK(root["nothing"].choice_or(1, {"a"}) == 1);
  CHECK(root["nothing"].text_or("b", 1) == "b");
  CHECK(root["nothing"].dump().empty());
  CHECK(a["list"].dump() == R"([{"x":1},{"y":[2,"three"]}])");
}

TEST_CASE("a refusal names the place, the value and what is expected") {
  const Document document(kFull);
  const Value root = document.root(), a = root["a"], list = a["list"], first = list.item(0), second = list.item(1),
              y = second["y"];
  CHECK(y.path() == "a.list[1].y");
  CHECK(y.item(1).path() == "a.list[1].y[1]");
  const auto said = [](const auto& read) { return refusal([&] { (void)read(); }); };
  CHECK(said([&] { return second["y"].numbers(2, 2, {}); }) == "a.list[1].y[1] is \"three\"; it must be a number");
  CHECK(said([&] { return list.objects(3, 9); }) == "a.list is a list of 2; it must be a list of 3 to 9 objects");
  CHECK(said([&] { return first["z"].boolean(); }) == "a.list[0].z is missing");
  CHECK(said([&] { return root["b"].number(); }) == "b is missing");
  CHECK(said([&] { return root["number"].integer(1, 4); }) == "number is 2.5; it must be an integer from 1 to 4");
  CHECK(said([&] { return root["large"].integer(1, 4); }) ==
        "large is 18446744073709551615; it must be an integer from 1 to 4");
  CHECK(said([&] { return root["number"].number({3, 4, true, "m"}); }) == "number is 2.5; it must be a number from 3 to 4 m");
  CHECK(said([&] {
          return root["number"].number({2.5, 4, false});
        }) == "number is 2.5; it must be a number above 2.5 and up to 4");
  CHECK(said([&] { return root["id"].id(30); }) ==
        "id is \"0x1F\"; it must be a number up to 0x001E, in hexadecimal as a text: \"0x0001\"");
  CHECK(said([&] { return root["hex"].hex(1, 2); }) ==
        "hex is \"03 01fF\"; it must be a text of 1 to 2 bytes in hexadecimal: \"03 01\", not of 3");
  CHECK(said([&] { return root["lines"].text(9); }) == "lines is \"a\\nb\"; it must be a text of 1 to 9 bytes on one line");
  CHECK(said([&] { return root["empty"].text(9); }) == "empty is \"\"; it must be a text of 1 to 9 bytes on one line");
  CHECK(said([&] {
          return a["word"].choice({"square", "spheres"});
        }) == "a.word is \"sphere\"; did you mean 'spheres'? (it may be square, spheres)");
  CHECK(said([&] { return root["yes"].string(); }) == "yes is true; it must be a text");
  CHECK(said([&] { return root["none"].boolean(); }) == "none is null; it must be true or false");
  CHECK(said([&] { return y["x"]; }) == "a.list[1].y is a list of 2; it must be an object: { ... }");
  CHECK(said([&] { return a.size(); }) == "a is an object; it must be a list: [ ... ]");
  CHECK(refusal([&] {
          a.allow_only({"lists", "word"}, " of a");
        }) == "a has 'list', which is no key of a; did you mean 'lists'? (the keys of a are lists, word)");
  CHECK(refusal([&] { (void)document.object({"a"}); }).starts_with("'empty' is no key (the keys are a)"));
  CHECK(refusal([&] { y.fail(": its second is a word"); }) == "a.list[1].y: its second is a word");
}

TEST_CASE("a document that is a list has the name it is given") {
  const Document document("[{\"x\": 1}, 2]");
  const Value list = document.root("bodies");
  CHECK(refusal([&] { (void)list.items(2, 2, "bodies")[1].object({"x"}); }) == "bodies[1] is 2; it must be an object: { ... }");
  CHECK(refusal([&] { (void)document.object({"x"}); }) == "is a list of 2; it must be an object: { ... }");
}

TEST_CASE("what is no JSON is refused by line and column, also where a hostile text has no end of it") {
  CHECK(refusal("{\"a\": 1,\n \"b\": }").starts_with("is no JSON: line 2, column 7: "));
  CHECK(refusal("").starts_with("is no JSON: line 1, column 1: "));
  CHECK(refusal("{\"a\": 1e999}").starts_with("is no JSON: number overflow"));
  CHECK(refusal("{\"a\": 1} x").starts_with("is no JSON: line 1, column 10"));
  CHECK(refusal(std::string(16, '[') + std::string(16, ']')).empty());
  CHECK(refusal(std::string(17, '[') + std::string(17, ']')) == "nests deeper than 16 levels; write it flatter");
  CHECK(refusal(std::string(300000, '[')) == "nests deeper than 16 levels; write it flatter");
  CHECK(refusal("[[1]]", {100, 1}) == "nests deeper than 1 levels; write it flatter");
  CHECK(refusal("[1, 2]", {5}) == "has 6 bytes; the limit is 5");
  for (const auto& [text, is_cut_short] : {std::pair("{\"a\": [1", true), std::pair("{\"a\": ]", false)}) {
    try {
      const Document document{std::string_view(text)};
      FAIL("is taken: " << text);
    } catch (const Refusal& refused) {
      CHECK(refused.is_cut_short == is_cut_short);
    }
  }
}

TEST_CASE("of members with one name none may be lost unseen, unless the format allows it") {
  const std::string twins = R"({"o": {"a": {"deep": 1}, "b": 2, "a": [3]}})";
  CHECK(refusal(twins) == "'a' stands twice in one object; keep one");
  CHECK(refusal(R"({"a": {"a": 1}, "b": {"a": 1}})").empty());
  const Document document(twins, {100, 16, true});
  const Value root = document.root();
  CHECK(root["o"].dump() == R"({"a":[3],"b":2})");
}

TEST_CASE("a text is read from a stream up to a limit") {
  std::istringstream stream("12345");
  std::string text;
  CHECK(read_text(stream, "-", 5, &text).empty());
  CHECK(text == "12345");
  std::istringstream longer("123456");
  CHECK(read_text(longer, "-", 5, &text) == "-: has more than 5 bytes, which is the limit");
}
