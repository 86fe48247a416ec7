// SPDX-License-Identifier: Apache-2.0
#include "import/soup_reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace fdcg::bake {

Failure refuse(const std::string& name, const std::string& what, const char* rule) {
  std::string message = name + ": " + what;
  if (what.find(';') == std::string::npos) message += "; correct the file or export it again";
  for (char& c : message) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') c = '?';
  }
  return Failure{3, message, rule};
}

std::string readable_name(std::string_view name) {
  constexpr std::size_t kShown = 48;
  std::size_t length = name.size();
  if (length > kShown) {
    length = kShown;
    while (length > kShown - 4 && (static_cast<unsigned char>(name[length]) & 0xC0) == 0x80)
      --length;  // in the middle of a UTF-8 character
  }
  std::string text(name.substr(0, length));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') c = '?';
  }
  return length < name.size() ? text + "..." : text;
}

void SoupReader::ignore(std::string_view what, std::uint64_t count) {
  if (count == 0) return;
  const auto same = [what](const Ignored& i) { return i.what == what; };
  const auto found = std::find_if(soup_.ignored.begin(), soup_.ignored.end(), same);
  if (found != soup_.ignored.end()) {
    found->count += count;
  } else {
    soup_.ignored.push_back({std::string(what), count});
  }
}

void SoupReader::begin_part(std::string name) {
  constexpr std::size_t kAlways = 64, kBytesOfFile = 16;  // a part costs some 40 to 200 bytes
  const std::size_t most = kAlways + input_.bytes.size() / kBytesOfFile;
  if (soup_.parts.size() >= most) {
    name = "(further parts)";
    has_further_parts_ = true;
  }
  soup_.parts.push_back({std::move(name), static_cast<std::uint32_t>(soup_.face_count())});
}

bool MaterialList::begin(PolygonSoup& soup, std::string_view name) {
  constexpr std::size_t kLongest = 1024;
  fill(soup);
  current_ = PolygonSoup::kNoMaterial;
  if (name.empty()) return true;
  std::string text(name.substr(0, kLongest));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') c = '?';
  }
  const auto known = index_of_.find(text);
  if (known == index_of_.end() && soup.materials.size() >= PolygonSoup::kNoMaterial) return false;
  if (known == index_of_.end()) {
    if (soup.materials.empty()) soup.face_material.resize(soup.face_count(), PolygonSoup::kNoMaterial);
    soup.materials.push_back(text);
  }
  current_ = known != index_of_.end() ? known->second : static_cast<std::uint16_t>(soup.materials.size() - 1);
  index_of_.emplace(std::move(text), current_);
  return true;
}

void MaterialList::fill(PolygonSoup& soup) const {
  if (!soup.materials.empty()) soup.face_material.resize(soup.face_count(), current_);
}

void MaterialList::finish(PolygonSoup& soup) {
  fill(soup);
  std::vector<std::uint16_t> now(soup.materials.size(), PolygonSoup::kNoMaterial);  // by first use; a name alone is none
  std::vector<std::string> used;
  for (std::uint16_t& material : soup.face_material) {
    if (material == PolygonSoup::kNoMaterial) continue;
    if (now[material] == PolygonSoup::kNoMaterial) {
      now[material] = static_cast<std::uint16_t>(used.size());
      used.push_back(std::move(soup.materials[material]));
    }
    material = now[material];
  }
  soup.materials = std::move(used);
  if (soup.materials.empty()) soup.face_material.clear();
}

void SoupReader::set_material(std::string_view name) {
  if (!materials_.begin(soup_, name)) ignore("materials beyond the 65,535th");
}

bool SoupReader::fail_big_face(std::uint64_t count) {
  const std::string place = soup_.face_line.size() == soup_.face_first.size()
                                ? "line " + std::to_string(soup_.face_line.back()) + ": "
                                : std::string();
  return fail(place + "face " + std::to_string(soup_.face_first.size() - 1) + " has " + std::to_string(count) +
              " corners; the limit is " + std::to_string(kMaxFaceCorners) + ": cut it into smaller polygons");
}

void SoupReader::report(std::size_t offset) {
  constexpr std::size_t kSteps = 100;
  next_report_ = offset + std::max<std::size_t>(input_.bytes.size() / kSteps, std::size_t{1} << 20);
  if (input_.progress) input_.progress("import", static_cast<double>(offset) / static_cast<double>(input_.bytes.size()));
}

std::string TextSoupReader::not_a_number() const {
  const std::string token = scan_.quote();
  const bool has_comma = token.find(',') != std::string::npos;
  return token + " is not a number" + (has_comma ? "; write decimals with a point" : "");
}

// A decimal of a float's own, rounded to the digits printed, is the float to within half a unit of its last digit. Of random
// decimals of eight digits one in two passes, of nine one in twelve, so that no mesh of doubles does. Seven digits always pass:
// printed with so few, a number is known no better than a float.
void TextSoupReader::set_quanta(bool are_floats) {
  double extent = 0;
  for (const Vec3& p : soup_.points) {
    for (const double c : {p.x, p.y, p.z}) {
      if (std::isfinite(c)) extent = std::max(extent, std::fabs(c));
    }
  }
  soup_.absolute_quantum = precision_.half_step(extent);
  if (are_floats || precision_.are_floats()) soup_.relative_quantum = 0x1p-24;
}

}  // namespace fdcg::bake
