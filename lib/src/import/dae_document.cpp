// SPDX-License-Identifier: Apache-2.0
#include "import/dae_document.hpp"

#include <algorithm>
#include <array>

#include "shared/text.hpp"

namespace fdcg::bake::dae {
namespace {

constexpr std::array<std::string_view, 9> kKinds = {"geometry", "node",     "visual_scene", "controller", "material",
                                                    "source",   "vertices", "float_array",  "int_array"};

std::string key_of(std::string_view kind, std::string_view id) {
  std::string key(kind);
  key += '#';
  key += id;
  return key;
}

// The next element of the whole tree, in the file's order.
Node after(Node node) {
  if (const Node below = xml::first_element(node)) return below;
  for (; node; node = node.parent()) {
    if (const Node beside = xml::next_element(node)) return beside;
  }
  return {};
}

bool is_outside(std::string_view url) {
  const std::size_t hash = url.find('#');
  return hash != std::string_view::npos && hash > 0;
}
// Some exporters leave the hash out.
std::string_view id_of(std::string_view url) {
  return url.starts_with('#') ? url.substr(1) : url;
}

}  // namespace

Document::Document(std::string_view bytes) : file_(bytes) {
  if (xml::name_of(root()) != "COLLADA") {
    file_.fail(root(),
               "is the root, so that this is XML but no COLLADA, 3MF, X3D or VTK file; export it as one of them, glTF or PLY");
  }
  const std::string_view version = xml::attribute(root(), "version");
  if (!version.empty() && !version.starts_with("1.4") && !version.starts_with("1.5"))
    file_.fail(root(), "is of version '" + printable(version, 16) + "'; versions 1.4 and 1.5 are read: export it again");
  for (Node node = root(); node; node = after(node)) {
    const std::string_view kind = xml::name_of(node), id = xml::attribute(node, "id");
    if (id.empty() || std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()) continue;
    const auto [known, is_new] = by_id_.emplace(key_of(kind, id), Entry{node, false});
    if (!is_new) known->second.is_twice = true;
  }
}

double Document::metres_per_unit() const {
  const Node unit = xml::child(xml::child(root(), "asset"), "unit");
  if (!unit || !xml::has(unit, "meter")) return 1;
  std::string text(xml::attribute(unit, "meter"));
  std::replace(text.begin(), text.end(), ',', '.');  // as some exporters write it in some languages
  TextScanner scan(text, {});
  double metres = 0;
  if (!scan.find_token() || !scan.read_real(metres) || scan.find_token() || !(metres >= 1e-30 && metres <= 1e30))
    file_.fail(unit, "has meter='" + printable(text, 32) + "', which is no number from 1e-30 to 1e30; correct it");
  return metres;
}

char Document::up_axis() const {
  const std::string_view text = xml::child(xml::child(root(), "asset"), "up_axis").child_value();
  if (text.find("X_UP") != std::string_view::npos) return 'x';
  return text.find("Z_UP") != std::string_view::npos ? 'z' : 'y';
}

Node Document::target(const Node& from, std::string_view attribute, std::string_view kind) const {
  const std::string_view url = xml::attribute(from, attribute);
  if (is_outside(url)) return {};
  const std::string_view id = id_of(url);
  const auto found = by_id_.find(key_of(kind, id));
  const std::string name = "'" + printable(id, 64) + "'";
  if (found == by_id_.end()) {
    file_.fail(from, "names the " + std::string(kind) + " " + name + " in '" + std::string(attribute) +
                         "', and the file has none of this id; export it again");
  }
  if (found->second.is_twice)
    file_.fail(from, "names the " + std::string(kind) + " " + name + ", an id that two elements have; export it again");
  return found->second.node;
}

bool Document::has_target(const Node& from, std::string_view attribute, std::string_view kind) const {
  const std::string_view url = xml::attribute(from, attribute);
  if (is_outside(url)) return false;
  const auto found = by_id_.find(key_of(kind, id_of(url)));
  return found != by_id_.end() && !found->second.is_twice;
}

}  // namespace fdcg::bake::dae
