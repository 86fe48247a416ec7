// SPDX-License-Identifier: Apache-2.0
#include "import/import_ply.hpp"

#include <optional>

#include "import/ply_extras.hpp"

namespace fdcg::bake {
namespace ply {
namespace {

std::optional<Scalar> parse_scalar(std::string_view word) {
  if (word == "char" || word == "int8") return Scalar::i8;
  if (word == "uchar" || word == "uint8") return Scalar::u8;
  if (word == "short" || word == "int16") return Scalar::i16;
  if (word == "ushort" || word == "uint16") return Scalar::u16;
  if (word == "int" || word == "int32") return Scalar::i32;
  if (word == "uint" || word == "uint32") return Scalar::u32;
  if (word == "float" || word == "float32") return Scalar::f32;
  if (word == "double" || word == "float64") return Scalar::f64;
  return std::nullopt;
}

// The part of the file that can be the header: up to the end of the line end_header. Lines are found by the line ending of the
// first line, because a binary body may contain any byte.
struct HeaderExtent {
  std::size_t bytes = 0;  // 0: no end_header
  std::uint32_t lines = 0;
};

HeaderExtent find_header(std::string_view bytes) {
  const std::size_t first_end = bytes.find_first_of("\r\n");
  if (first_end == std::string_view::npos) return {};
  const bool is_cr = bytes[first_end] == '\r' && !(first_end + 1 < bytes.size() && bytes[first_end + 1] == '\n');
  const char line_end = is_cr ? '\r' : '\n';
  HeaderExtent extent;
  for (std::size_t start = 0; start < bytes.size();) {
    const std::size_t end = bytes.find(line_end, start);
    std::string_view line = bytes.substr(start, end == std::string_view::npos ? end : end - start);
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t'))
      line.remove_suffix(1);
    ++extent.lines;
    if (line == "end_header") {
      extent.bytes = end == std::string_view::npos ? bytes.size() : end + 1;
      return extent;
    }
    if (end == std::string_view::npos) break;
    start = end + 1;
  }
  return {};
}

class HeaderParser : SoupReader {
 public:
  HeaderParser(const MeshText& input, HeaderExtent extent)
      : SoupReader(input, Format::ply), scan_(input.bytes.substr(0, extent.bytes), {}) {
    header_.body_offset = extent.bytes;
    header_.body_line = extent.lines + 1;
  }

  Result<Header> parse() {
    scan_.next_line();  // "ply"
    while (scan_.find_token()) {
      const std::string_view keyword = scan_.read_word();
      if (keyword == "end_header") break;
      if (!parse_line(keyword)) return result(false).error();
      scan_.next_line();
    }
    if (!has_format_) {
      fail("the PLY header has no 'format' line");
      return result(false).error();
    }
    for (ElementKind& element : header_.elements) {
      if (!assign_roles(element)) return result(false).error();
    }
    return std::move(header_);
  }

 private:
  bool fail_here(const std::string& what) { return fail_at_line(scan_.line(), what); }

  bool parse_line(std::string_view keyword) {
    if (keyword == "comment" || keyword == "obj_info") return true;
    if (keyword == "format") return parse_format();
    if (keyword == "element") return parse_element();
    if (keyword == "property") return parse_property();
    return fail_here("the PLY header has a line that starts with '" + std::string(keyword.substr(0, 32)) + "'");
  }

  std::string_view next_word() { return scan_.line_done() ? std::string_view() : scan_.read_word(); }

  bool parse_format() {
    const std::string_view encoding = next_word(), version = next_word();
    if (encoding == "ascii") {
      header_.encoding = Encoding::ascii;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = Encoding::little_endian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = Encoding::big_endian;
    } else {
      return fail_here("the PLY format is none of ascii, binary_little_endian and binary_big_endian");
    }
    if (version != "1.0") return fail_here("the PLY version is not 1.0");
    has_format_ = true;
    return true;
  }

  bool parse_element() {
    // Each is compared with all others; files have only a few.
    constexpr std::size_t kMostElements = 256;
    if (header_.elements.size() >= kMostElements) {
      return fail_here("the PLY header declares more than " + std::to_string(kMostElements) + " elements; leave some out");
    }
    ElementKind element;
    element.name = next_word();
    std::int64_t count = 0;
    if (scan_.line_done() || !scan_.read_integer(count) || count < 0) {
      return fail_here("element '" + element.name.substr(0, 32) + "' has no count of 0 or more");
    }
    element.count = static_cast<std::uint64_t>(count);
    if (element.name == "vertex") {
      element.kind = Kind::vertex;
      header_.vertex_count = element.count;
    } else if (element.name == "face") {
      element.kind = Kind::face;
    } else if (element.name == "tristrips") {
      element.kind = Kind::tristrips;
    }
    for (const ElementKind& other : header_.elements) {
      if (other.name == element.name) return fail_here("element '" + element.name.substr(0, 32) + "' is declared twice");
    }
    header_.elements.push_back(std::move(element));
    return true;
  }

  bool parse_property() {
    if (header_.elements.empty()) return fail_here("a property stands before the first element");
    Property property;
    std::string_view type = next_word();
    if (type == "list") {
      property.is_list = true;
      const std::optional<Scalar> count = parse_scalar(next_word());
      if (!count) return fail_here("a list has a count of unknown type");
      property.count = *count;
      type = next_word();
    }
    const std::optional<Scalar> value = parse_scalar(type);
    if (!value) return fail_here("a property has the unknown type '" + std::string(type.substr(0, 32)) + "'");
    property.value = *value;
    property.name = next_word();
    if (property.name.empty()) return fail_here("a property has no name");
    header_.elements.back().properties.push_back(std::move(property));
    return true;
  }

  static Role role_of(Kind kind, const std::string& name) {
    if (kind == Kind::vertex) return name == "x" ? Role::x : name == "y" ? Role::y : name == "z" ? Role::z : Role::none;
    if (kind == Kind::other) return Role::none;
    return name == "vertex_indices" || name == "vertex_index" ? Role::indices : Role::none;
  }

  bool assign_roles(ElementKind& element) {
    std::array<int, 5> seen{};
    for (Property& property : element.properties) {
      property.role = role_of(element.kind, property.name);
      if (property.role == Role::none) continue;
      if (++seen[static_cast<std::size_t>(property.role)] > 1) {
        if (property.role == Role::indices) return fail("element '" + element.name + "' has two lists of vertices; leave one");
        return fail("element '" + element.name + "' has property '" + property.name + "' twice");
      }
      if (property.is_list != (property.role == Role::indices)) {
        return fail("property '" + property.name + "' of element '" + element.name + "' must" +
                    (property.is_list ? " not be a list" : " be a list"));
      }
    }
    if (element.kind == Kind::vertex) assign_extras(element, input_.wants_normals, input_.wants_appearance);
    const auto has = [&seen](Role role) { return seen[static_cast<std::size_t>(role)] == 1; };
    if (element.kind == Kind::vertex && !(has(Role::x) && has(Role::y) && has(Role::z))) {
      return fail("element 'vertex' lacks one of the properties x, y and z");
    }
    if ((element.kind == Kind::face || element.kind == Kind::tristrips) && element.count > 0 && !has(Role::indices)) {
      return fail("element '" + element.name + "' has no list property vertex_indices or vertex_index");
    }
    if (element.kind == Kind::vertex && element.count > kMaxPoints) {
      return fail("the header promises " + std::to_string(element.count) + " vertices; the limit is " +
                  std::to_string(kMaxPoints));
    }
    return true;
  }

  TextScanner scan_;
  Header header_;
  bool has_format_ = false;
};

}  // namespace

std::string ignored_name(const ElementKind& element) {
  return "'" + readable_name(element.name) + "' elements";
}

std::string row_name(const ElementKind& element, std::uint64_t row) {
  return "row " + std::to_string(row) + " of " + std::to_string(element.count) + " of element '" + element.name.substr(0, 32) +
         "'";
}

Result<Header> read_header(const MeshText& input) {
  std::string_view magic = input.bytes;
  if (magic.starts_with("\xEF\xBB\xBF")) magic.remove_prefix(3);
  if (!magic.starts_with("ply") || magic.find_first_of(" \t\r\n") != 3)
    return refuse(input.name, "does not start with 'ply'; is it another format?");
  const HeaderExtent extent = find_header(input.bytes);
  if (extent.bytes == 0)
    return refuse(input.name, "truncated: the PLY header has no line 'end_header'; fetch or export it again");
  return HeaderParser(input, extent).parse();
}

}  // namespace ply

Result<PolygonSoup> read_ply(const MeshText& input) {
  const Result<ply::Header> header = ply::read_header(input);
  if (!header) return header.error();
  return header->encoding == ply::Encoding::ascii ? ply::read_ascii_body(input, *header)
                                                  : ply::read_binary_body(input, *header);
}

}  // namespace fdcg::bake
