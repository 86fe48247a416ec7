// SPDX-License-Identifier: Apache-2.0
// XML files as trees of nodes (pugixml: it expands no entities of a file's own and opens nothing), with the places that
// messages name, and the numbers in texts and attributes read exactly. Only the readers of XML formats include this.
#pragma once

#include <cstdint>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "import/printed_precision.hpp"
#include "import/text_scanner.hpp"
#include "shared/json/reader.hpp"

namespace fdcg::bake::xml {

using json::Refusal;  // thrown where a file is found wanting, caught by the format's reader
using Node = pugi::xml_node;

inline constexpr int kMaxDepth = 128;  // of scenes and of references from node to node

// Names count without their prefix: "p:path" is "path".
[[nodiscard]] inline std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}
[[nodiscard]] inline std::string_view name_of(const Node& node) {
  return local_name(node.name());
}
[[nodiscard]] Node child(const Node& node, std::string_view name);                  // the first of this name; empty: none
[[nodiscard]] Node next(const Node& sibling);                                       // after it, of the same name
[[nodiscard]] Node first_element(const Node& node);                                 // child
[[nodiscard]] Node next_element(const Node& node);                                  // sibling
[[nodiscard]] bool has(const Node& node, std::string_view attribute);               // likewise without prefix
[[nodiscard]] std::string_view attribute(const Node& node, std::string_view name);  // empty: none

// The bytes outlive the file.
class File {
 public:
  // UTF-8 or UTF-16. `part`: of an archive, for messages; empty: the file itself. Throws Refusal, std::bad_alloc.
  explicit File(std::string_view bytes, std::string part = {});

  [[nodiscard]] Node root() const { return document_.document_element(); }

  // "line 12: <p> ": where messages start.
  [[nodiscard]] std::string place(const Node& node) const;
  // Throws Refusal: `place` `what`.
  [[noreturn]] void fail(const Node& node, const std::string& what) const;

  // A whole number of 0 or more; `otherwise` where there is no such attribute.
  [[nodiscard]] std::uint64_t count(const Node& node, std::string_view name, std::uint64_t otherwise) const;

  // Calls use(value) for each whole number in the node's text; returns how many there are.
  template <class Use>
  std::uint64_t for_each_whole(const Node& node, const Use& use) const {
    std::string joined;
    TextScanner scan(text_of(node, joined), {});
    std::uint64_t count = 0;
    for (; scan.find_token(); ++count) {
      std::int64_t value = 0;
      if (!scan.read_integer(value)) fail_token(node, count, scan, "whole number");
      use(value);
    }
    return count;
  }
  // Likewise real numbers, with how each was printed. "1,5" is 1.5, as some exporters have it in some
  // languages: a list without blanks would not have as many numbers as its file says.
  template <class Use>
  std::uint64_t for_each_real(const Node& node, const Use& use) const {
    std::string joined;
    TextScanner scan(text_of(node, joined), {});
    std::uint64_t count = 0;
    for (; scan.find_token(); ++count) {
      double value = 0;
      Printed number;
      if (!read_real(scan, value, number)) fail_token(node, count, scan, "number");
      use(value, number);
    }
    return count;
  }

  // All of an attribute's text as one real number.
  [[nodiscard]] double real(const Node& node, std::string_view name, Printed& number) const;

 private:
  static bool read_real(TextScanner& scan, double& value, Printed& number) {
    if (!scan.read_real(value)) return read_comma_real(scan, value, number);
    number = printed(scan);
    return true;
  }
  static bool read_comma_real(TextScanner& scan, double& value, Printed& number);
  static std::string_view text_of(const Node& node, std::string& joined);
  [[noreturn]] void fail_token(const Node& node, std::uint64_t count, const TextScanner& scan, const char* kind) const;

  std::string_view bytes_;
  std::string part_;
  pugi::xml_document document_;
};

}  // namespace fdcg::bake::xml
