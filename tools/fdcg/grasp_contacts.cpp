// SPDX-License-Identifier: Apache-2.0
#include "grasp_contacts.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "../common/nearest.hpp"
#include "../common/one_line.hpp"
#include "fdcg/grasp.hpp"
#include "fdcg_commands.hpp"
#include "json_words.hpp"
#include "mesh_options.hpp"

namespace fdcg::tools {
namespace {

using Json = nlohmann::json;
using Contacts = std::vector<NamedContact>;

constexpr std::size_t kMostBytes = std::size_t{16} << 20;

// Says what is wrong with which contact; caught where the file's name is known.
struct Wrong {
  std::string message;
};

// What the file holds, short enough for a message that says more.
std::string shown(const std::string& text) {
  constexpr std::size_t kLongest = 40;
  return one_line(text, kLongest);
}

// The finite number that a text is, or a message.
double finite_number(const std::string& text, const std::string& what) {
  const auto value =
      parse_number_between(text, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
  if (!value) throw Wrong{what + " '" + shown(text) + "' is no finite number"};
  return *value;
}

void set_normal(NamedContact& contact, const bake::Vec3& normal) {
  const double length = std::hypot(normal.x, normal.y, normal.z);
  constexpr double kLeast = 1e-100;  // shorter ones have lost digits
  if (!(length >= kLeast && std::isfinite(length)))
    throw Wrong{contact.name + ": the normal has no direction; it points into the object"};
  contact.inward = bake::Vec3{normal.x / length, normal.y / length, normal.z / length};
}

// What a file says of a contact can be what a contact has; what it cannot is told with its place.
void check_numbers(const NamedContact& contact, const std::string& where) {
  const auto refuse = [&](const char* name, double value, const std::string& allowed) {
    char number[32];
    std::snprintf(number, sizeof number, "%.9g", value);
    throw Wrong{where + name + " is " + number + ", allowed " + allowed};
  };
  if (contact.mu && !(*contact.mu >= 0 && *contact.mu <= grasp::kMostMu)) refuse("mu", *contact.mu, "0 to 100");
  if (contact.torsion_m && !(*contact.torsion_m >= 0)) refuse("torsion", *contact.torsion_m, "0 m and more");
  if (contact.cap_n && !(*contact.cap_n >= grasp::kLeastForce_n && *contact.cap_n <= grasp::kMostForce_n))
    refuse("cap", *contact.cap_n, "1e-100 to 1e100 N; leave it out where there is none");
  for (const double x : {contact.point_m.x, contact.point_m.y, contact.point_m.z})
    if (!(std::abs(x) <= grasp::kFarthest_m)) refuse("the point's coordinate", x, "-1e12 to 1e12 m");
}

// As it stands in the file; of lists and objects that it is one: printing those within one another takes as many calls.
std::string text_of(const Json& value) {
  if (value.is_structured()) return "an " + std::string(value.type_name());
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// ---- JSON ----------------------------------------------------------------------------------------------------------------

double number_of(const Json& value, const std::string& what) {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw Wrong{what + " is no finite number: " + shown(text_of(value))};
  return value.get<double>();
}

bake::Vec3 vector_of(const Json& value, const std::string& what) {
  if (!value.is_array() || value.size() != 3) throw Wrong{what + " is not [x, y, z]: " + shown(text_of(value))};
  return {number_of(value[0], what), number_of(value[1], what), number_of(value[2], what)};
}

NamedContact contact_of(const Json& json, std::size_t index) {
  NamedContact contact;
  contact.name = "contact " + std::to_string(index);
  const std::string where = contact.name + ": ";
  if (!json.is_object()) throw Wrong{where + "is no object: " + shown(text_of(json))};
  if (!json.contains("point")) throw Wrong{where + "has no \"point\": [x, y, z] in metres"};
  std::optional<bake::Vec3> normal;
  for (const auto& [key, value] : json.items()) {
    const std::string what = where + "\"" + shown(key) + "\"";
    if (key == "point")
      contact.point_m = vector_of(value, what);
    else if (key == "normal")
      normal = vector_of(value, what);
    else if (key == "mu")
      contact.mu = number_of(value, what);
    else if (key == "torsion")
      contact.torsion_m = number_of(value, what);
    else if (key == "cap")
      contact.cap_n = number_of(value, what);
    else if (key == "name" && value.is_string())
      contact.name = one_line(value.get<std::string>());
    else
      throw Wrong{what + (key == "name" ? " is no text" : " is no member of a contact") +
                  (key == "name" ? "" : did_you_mean(key, {"point", "normal", "mu", "torsion", "cap", "name"}))};
  }
  if (normal) set_normal(contact, *normal);
  check_numbers(contact, where);
  return contact;
}

Contacts parse_json(const std::string& text) {
  DuplicateKeys duplicates;
  const Json document = Json::parse(text, std::ref(duplicates));
  if (!duplicates.duplicate.empty())
    throw Wrong{"\"" + shown(duplicates.duplicate) + "\" stands twice in one object; keep one"};
  const bool is_object = document.is_object();
  if (is_object) {
    for (const auto& [key, value] : document.items()) {
      if (key != "contacts")
        throw Wrong{"\"" + shown(key) + "\" is no member of a contacts file" + did_you_mean(key, {"contacts"})};
    }
    if (!document.contains("contacts") || !document["contacts"].is_array()) throw Wrong{"there is no array \"contacts\""};
  }
  Contacts contacts;
  for (const Json& one : is_object ? document["contacts"] : document)
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
  const std::vector<std::string> known{"x", "y", "z", "mu", "torsion", "cap", "nx", "ny", "nz", "name"};
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto& column = header[i];
    if (std::find(known.begin(), known.end(), column) == known.end())
      throw Wrong{"line 1: '" + shown(column) + "' is no column of a contacts file" +
                  (column.find(';') != std::string::npos ? "; columns are separated by commas" : did_you_mean(column, known))};
    if (std::find(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(i), column) !=
        header.begin() + static_cast<std::ptrdiff_t>(i))
      throw Wrong{"line 1: the column '" + column + "' comes twice"};
  }
  const auto has = [&](const char* column) { return std::find(header.begin(), header.end(), column) != header.end(); };
  if (!has("x") || !has("y") || !has("z")) throw Wrong{"line 1: the header names x, y, z and more (metres), not these"};
  if (has("nx") != has("ny") || has("nx") != has("nz")) throw Wrong{"line 1: of nx, ny, nz either all are there or none"};
}

NamedContact contact_of_line(const std::vector<std::string>& header, const std::vector<std::string>& fields,
                             const std::string& where, std::size_t index) {
  NamedContact contact;
  contact.name = "contact " + std::to_string(index);
  if (fields.size() != header.size())
    throw Wrong{where + std::to_string(fields.size()) + " fields, the header has " + std::to_string(header.size())};
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
    const double value = finite_number(field, where + column);
    if (column == "x") contact.point_m.x = value;
    if (column == "y") contact.point_m.y = value;
    if (column == "z") contact.point_m.z = value;
    if (column == "mu") contact.mu = value;
    if (column == "torsion") contact.torsion_m = value;
    if (column == "cap") contact.cap_n = value;
    if (column == "nx") normal.x = value, has_normal = true;
    if (column == "ny") normal.y = value, has_normal = true;
    if (column == "nz") normal.z = value, has_normal = true;
  }
  if (has_normal) set_normal(contact, normal);
  check_numbers(contact, where);
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

// The report tells contacts by their names. Those without one have a number, which another may have been given as its name.
void refuse_twins(const Contacts& contacts) {
  std::map<std::string_view, std::size_t> first;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto [other, is_new] = first.emplace(contacts[i].name, i);
    if (!is_new)
      throw Wrong{"contacts " + std::to_string(other->second) + " and " + std::to_string(i) + " are both called '" +
                  shown(contacts[i].name) + "'; the report tells contacts by their names: give each its own"};
  }
}

}  // namespace

bake::Result<Contacts> parse_contacts(const std::string& bytes, const std::string& path) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of UTF-8, which spreadsheets put in front
  const std::string text = bytes.starts_with(kMark) ? bytes.substr(kMark.size()) : bytes;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  try {
    if (first == std::string::npos) throw Wrong{"the file is empty; it lists contacts as JSON or CSV"};
    const bool is_json = text[first] == '{' || text[first] == '[';
    Contacts contacts = is_json ? parse_json(text) : parse_csv(text);
    if (contacts.empty()) throw Wrong{"there are no contacts in it"};
    if (contacts.size() > grasp::kMostContacts)
      throw Wrong{"there are " + std::to_string(contacts.size()) + " contacts; at most " +
                  std::to_string(grasp::kMostContacts) + " are judged"};
    refuse_twins(contacts);
    return contacts;
  } catch (const Wrong& wrong) {
    return bake::Failure{kFile, path + ": " + one_line(wrong.message)};
  } catch (const Json::exception& error) {
    return bake::Failure{kFile, path + ": is no JSON: " + one_line(plain_complaint(error))};
  }
}

namespace {

bake::Failure unreadable(const std::string& path, int error_number) {
  return {kFile, "'" + path + "': " + std::strerror(error_number) + (error_number == EISDIR ? "; name a file in it" : "")};
}

}  // namespace

bake::Result<Contacts> read_contacts(const std::string& path) {
  std::FILE* const file = path == "-" ? stdin : std::fopen(path.c_str(), "rb");
  if (file == nullptr) return unreadable(path, errno);
  std::string text(kMostBytes + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file));
  const int error_number = std::ferror(file) != 0 ? errno : 0;
  if (file != stdin) std::fclose(file);
  if (error_number != 0) return unreadable(path, error_number);
  if (text.size() > kMostBytes) return bake::Failure{kFile, path + ": more than 16 MiB is no list of contacts"};
  return parse_contacts(text, path);
}

}  // namespace fdcg::tools
