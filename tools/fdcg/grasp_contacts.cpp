// SPDX-License-Identifier: Apache-2.0
#include "grasp_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>

#include "fdcg/grasp.hpp"
#include "fdcg_commands.hpp"
#include "mesh_options.hpp"
#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

using Contacts = std::vector<NamedContact>;

constexpr std::size_t kMostBytes = std::size_t{16} << 20;

// A value of the file, cut to fit into a message.
std::string shown(const std::string& text) {
  constexpr std::size_t kLongest = 40;
  return printable(text, kLongest);
}

// The number that a field is, or a message.
double number_of(const std::string& field, const std::string& what, const json::NumberRange& range = {}) {
  const auto value =
      parse_number_between(field, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
  if (!value) throw json::Refusal{what + " '" + shown(field) + "' is no finite number"};
  if (!range.holds(*value)) throw json::Refusal{what + " is " + shown_number(*value) + "; it must be " + range.text()};
  return *value;
}

void set_normal(NamedContact& contact, const bake::Vec3& normal) {
  const double length = std::hypot(normal.x, normal.y, normal.z);
  constexpr double kLeast = 1e-100;  // shorter ones have lost digits
  if (!(length >= kLeast && std::isfinite(length)))
    throw json::Refusal{contact.name + ": the normal has no direction; it points into the object"};
  contact.inward = bake::Vec3{normal.x / length, normal.y / length, normal.z / length};
}

// Allowed ranges of the values in a contacts file.
constexpr json::NumberRange kPlaces{-grasp::kFarthest_m, grasp::kFarthest_m, true, "m"};
constexpr json::NumberRange kMus{0, grasp::kMostMu};
constexpr json::NumberRange kTorsions{0, std::numeric_limits<double>::max(), true, "m"};
constexpr json::NumberRange kCaps{grasp::kLeastForce_n, grasp::kMostForce_n, true, "N; leave it out where there is none"};

// ---- JSON ----------------------------------------------------------------------------------------------------------------

bake::Vec3 vector_of(const json::Value& value, const json::NumberRange& range) {
  double x[3];
  value.numbers(x, 3, range);
  return {x[0], x[1], x[2]};
}

std::optional<double> number_in(const json::Value& value, const json::NumberRange& range) {
  return value ? std::optional(value.number(range)) : std::nullopt;
}

NamedContact contact_of(const json::Value& json, std::size_t index) {
  json.allow_only({"point", "normal", "mu", "torsion", "pad_radius", "cap", "name"});
  NamedContact contact;
  const json::Value name = json["name"];
  contact.name = name ? one_line(name.string()) : "contact " + std::to_string(index);
  contact.point_m = vector_of(json["point"], kPlaces);
  if (const json::Value normal = json["normal"]) set_normal(contact, vector_of(normal, {}));
  contact.mu = number_in(json["mu"], kMus);
  contact.torsion_m = number_in(json["torsion"], kTorsions);
  contact.pad_radius_m = number_in(json["pad_radius"], kTorsions);
  contact.cap_n = number_in(json["cap"], kCaps);
  return contact;
}

Contacts parse_json(const std::string& text) {
  const json::Document document(text, {kMostBytes});
  const json::Value whole = document.root();
  if (whole.is_object()) whole.allow_only({"contacts"});
  constexpr int kMost = static_cast<int>(grasp::kMostContacts);
  Contacts contacts;
  for (const json::Value& one : (whole.is_object() ? whole["contacts"] : document.root("contacts")).objects(1, kMost))
    contacts.push_back(contact_of(one, contacts.size()));
  return contacts;
}

// ---- CSV -----------------------------------------------------------------------------------------------------------------

// A line's fields, without blanks around them.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t start = 0;
  while (start <= line.size()) {
    const std::size_t comma = std::min(line.find(',', start), line.size());
    std::string field = line.substr(start, comma - start);
    const std::size_t first = field.find_first_not_of(" \t\r"), last = field.find_last_not_of(" \t\r");
    fields.push_back(first == std::string::npos ? "" : field.substr(first, last - first + 1));
    start = comma + 1;
  }
  return fields;
}

void check_header(const std::vector<std::string>& header) {
  const std::vector<std::string> known{"x", "y", "z", "mu", "torsion", "pad_radius", "cap", "nx", "ny", "nz", "name"};
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto& column = header[i];
    if (std::find(known.begin(), known.end(), column) == known.end())
      throw json::Refusal{
          "line 1: '" + shown(column) + "' is no column of a contacts file" +
          (column.find(';') != std::string::npos ? "; columns are separated by commas" : did_you_mean(column, known))};
    if (std::find(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(i), column) !=
        header.begin() + static_cast<std::ptrdiff_t>(i))
      throw json::Refusal{"line 1: the column '" + column + "' comes twice"};
  }
  const auto has = [&](const char* column) { return std::find(header.begin(), header.end(), column) != header.end(); };
  if (!has("x") || !has("y") || !has("z")) throw json::Refusal{"line 1: the header names x, y, z and more (metres), not these"};
  if (has("nx") != has("ny") || has("nx") != has("nz"))
    throw json::Refusal{"line 1: of nx, ny, nz either all are there or none"};
}

NamedContact contact_of_line(const std::vector<std::string>& header, const std::vector<std::string>& fields,
                             const std::string& where, std::size_t index) {
  NamedContact contact;
  contact.name = "contact " + std::to_string(index);
  if (fields.size() != header.size())
    throw json::Refusal{where + std::to_string(fields.size()) + " fields, the header has " + std::to_string(header.size())};
  bake::Vec3 normal{};
  bool has_normal = false;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string &column = header[i], &field = fields[i];
    const bool may_be_empty = column != "x" && column != "y" && column != "z";
    if (field.empty() && may_be_empty) continue;
    if (column == "name") {
      contact.name = one_line(field);
      continue;
    }
    const auto number = [&](const json::NumberRange& range) { return number_of(field, where + column, range); };
    if (column == "x") contact.point_m.x = number(kPlaces);
    if (column == "y") contact.point_m.y = number(kPlaces);
    if (column == "z") contact.point_m.z = number(kPlaces);
    if (column == "mu") contact.mu = number(kMus);
    if (column == "torsion") contact.torsion_m = number(kTorsions);
    if (column == "pad_radius") contact.pad_radius_m = number(kTorsions);
    if (column == "cap") contact.cap_n = number(kCaps);
    if (column == "nx") normal.x = number({}), has_normal = true;
    if (column == "ny") normal.y = number({}), has_normal = true;
    if (column == "nz") normal.z = number({}), has_normal = true;
  }
  if (has_normal) set_normal(contact, normal);
  return contact;
}

Contacts parse_csv(const std::string& text) {
  Contacts contacts;
  std::vector<std::string> header;
  std::size_t line_number = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string line = text.substr(start, end - start);
    start = end + 1;
    ++line_number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (header.empty()) {
      header = fields_of(line);
      check_header(header);
      continue;
    }
    contacts.push_back(contact_of_line(header, fields_of(line), "line " + std::to_string(line_number) + ": ", contacts.size()));
  }
  return contacts;
}

// A soft finger is given by its torsion or its pad radius, not both.
void refuse_two_radii(const Contacts& contacts) {
  for (const NamedContact& contact : contacts)
    if (contact.torsion_m && contact.pad_radius_m)
      throw json::Refusal{contact.name + " has both torsion and pad_radius; torsion is mu times pad_radius: keep one of them"};
}

// Names identify contacts in the report. One without a name gets its number, which may be the name of another.
void refuse_twins(const Contacts& contacts) {
  std::map<std::string_view, std::size_t> first;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto [other, is_new] = first.emplace(contacts[i].name, i);
    if (!is_new)
      throw json::Refusal{"contacts " + std::to_string(other->second) + " and " + std::to_string(i) + " are both called '" +
                          shown(contacts[i].name) + "'; the report tells contacts by their names: give each its own"};
  }
}

}  // namespace

bake::Result<Contacts> parse_contacts(const std::string& bytes, const std::string& path) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of UTF-8, which spreadsheets put in front
  const std::string text = bytes.starts_with(kMark) ? bytes.substr(kMark.size()) : bytes;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  try {
    if (first == std::string::npos) throw json::Refusal{"the file is empty; it lists contacts as JSON or CSV"};
    const bool is_json = text[first] == '{' || text[first] == '[';
    Contacts contacts = is_json ? parse_json(text) : parse_csv(text);
    if (contacts.empty()) throw json::Refusal{"there are no contacts in it"};
    if (contacts.size() > grasp::kMostContacts)
      throw json::Refusal{"there are " + std::to_string(contacts.size()) + " contacts; at most " +
                          std::to_string(grasp::kMostContacts) + " are judged"};
    refuse_twins(contacts);
    refuse_two_radii(contacts);
    return contacts;
  } catch (const json::Refusal& refusal) {
    return bake::Failure{kFile, path + ": " + one_line(refusal.message)};
  }
}

bake::Result<Contacts> read_contacts(const std::string& path) {
  std::string text;
  const std::string trouble =
      path == "-" ? json::read_text(std::cin, path, kMostBytes, &text) : json::read_text_file(path, kMostBytes, &text);
  if (!trouble.empty()) return bake::Failure{kFile, trouble};
  return parse_contacts(text, path);
}

}  // namespace fdcg::tools
