// SPDX-License-Identifier: Apache-2.0
#include "import/xml_file.hpp"

#include <algorithm>
#include <new>

#include "shared/text.hpp"

namespace fdcg::bake::xml {
namespace {

bool is_utf16(std::string_view bytes) {
  return bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
}

std::string line_at(std::string_view bytes, std::ptrdiff_t offset) {
  if (offset < 0 || is_utf16(bytes)) return {};  // of other bytes than those of the file
  const auto end = bytes.begin() + std::min(offset, static_cast<std::ptrdiff_t>(bytes.size()));
  return "line " + std::to_string(std::count(bytes.begin(), end, '\n') + 1) + ": ";
}

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 48;
  return "'" + printable(text, kMost) + "'";
}

}  // namespace

Node child(const Node& node, std::string_view name) {
  for (Node c = node.first_child(); c; c = c.next_sibling()) {
    if (name_of(c) == name) return c;
  }
  return {};
}

Node next(const Node& sibling) {
  const std::string_view name = name_of(sibling);
  for (Node c = sibling.next_sibling(); c; c = c.next_sibling()) {
    if (name_of(c) == name) return c;
  }
  return {};
}

Node first_element(const Node& node) {
  const Node c = node.first_child();
  return !c || c.type() == pugi::node_element ? c : next_element(c);
}

Node next_element(const Node& node) {
  Node c = node.next_sibling();
  while (c && c.type() != pugi::node_element)
    c = c.next_sibling();
  return c;
}

bool has(const Node& node, std::string_view attribute) {
  return std::any_of(node.attributes_begin(), node.attributes_end(),
                     [attribute](const pugi::xml_attribute& a) { return local_name(a.name()) == attribute; });
}

std::string_view attribute(const Node& node, std::string_view name) {
  for (const pugi::xml_attribute& a : node.attributes()) {
    if (local_name(a.name()) == name) return a.value();
  }
  return {};
}

File::File(std::string_view bytes, std::string part) : bytes_(bytes), part_(std::move(part)) {
  if (!part_.empty()) part_ = "part " + shown(part_) + ": ";
  if (!is_utf16(bytes) && bytes.find('\0') != std::string_view::npos) {
    const auto at = static_cast<std::ptrdiff_t>(bytes.find('\0'));
    throw Refusal{part_ + line_at(bytes, at) + "a zero byte stands in the text; fetch or export the file again"};
  }
  const pugi::xml_parse_result result = document_.load_buffer(bytes.data(), bytes.size(), pugi::parse_default,
                                                              is_utf16(bytes) ? pugi::encoding_auto : pugi::encoding_utf8);
  if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
  if (!result) {
    throw Refusal{part_ + line_at(bytes, result.offset) + "is no well-formed XML (" + result.description() +
                  "); fetch or export the file again"};
  }
}

std::string File::place(const Node& node) const {
  return part_ + line_at(bytes_, node.offset_debug()) + "<" + printable(node.name(), 48) + "> ";
}

void File::fail(const Node& node, const std::string& what) const {
  throw Refusal{place(node) + what};
}

std::uint64_t File::count(const Node& node, std::string_view name, std::uint64_t otherwise) const {
  if (!has(node, name)) return otherwise;
  const std::string_view text = attribute(node, name);
  TextScanner scan(text, {});
  std::uint64_t value = 0;
  if (!scan.find_token() || !scan.read_count(value) || scan.find_token())
    fail(node, "has " + std::string(name) + "=" + shown(text) + ", which is not a whole number of 0 or more");
  return value;
}

double File::real(const Node& node, std::string_view name, Printed& number) const {
  const std::string_view text = attribute(node, name);
  if (!has(node, name)) fail(node, "has no attribute '" + std::string(name) + "'");
  TextScanner scan(text, {});
  double value = 0;
  if (!scan.find_token() || !scan.read_real(value) || scan.find_token())
    fail(node, "has " + std::string(name) + "=" + shown(text) + ", which is not a number");
  number = printed(scan);
  return value;
}

bool File::read_comma_real(TextScanner& scan, double& value, Printed& number) {
  TextScanner ahead = scan;
  std::string word(ahead.read_word());
  const std::size_t comma = word.find(',');
  if (comma == std::string::npos || comma == 0 || comma + 1 == word.size() ||
      word.find_first_of(",.", comma + 1) != std::string::npos)
    return false;
  word[comma] = '.';
  TextScanner digits(word, {});
  if (!digits.read_real(value)) return false;
  number = printed(digits);
  scan = ahead;
  return true;
}

// Comments may cut the text into pieces.
std::string_view File::text_of(const Node& node, std::string& joined) {
  std::string_view only;
  int pieces = 0;
  for (Node c = node.first_child(); c; c = c.next_sibling()) {
    if (c.type() != pugi::node_pcdata && c.type() != pugi::node_cdata) continue;
    if (pieces++ == 0) {
      only = c.value();
      continue;
    }
    if (pieces == 2) joined = only;
    joined += ' ';
    joined += c.value();
  }
  return pieces < 2 ? only : std::string_view(joined);
}

void File::fail_token(const Node& node, std::uint64_t count, const TextScanner& scan, const char* kind) const {
  fail(node, "has " + scan.quote() + " as value " + std::to_string(count) + ", which is not a " + kind);
}

}  // namespace fdcg::bake::xml
