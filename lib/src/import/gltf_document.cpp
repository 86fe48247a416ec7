// SPDX-License-Identifier: Apache-2.0
// A little over 400 lines: one parser with the rules of a glTF document, each with the message for its violation.
#include "import/gltf_document.hpp"

#include <algorithm>
#include <cmath>

#include "base/srgb.hpp"
#include "import/gltf_extensions.hpp"
#include "import/gltf_haptics.hpp"
#include "import/gltf_placing.hpp"
#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::bake::gltf {
namespace {

using json::Value;

constexpr std::int64_t kMostWhole = (std::int64_t{1} << 53) - 1;  // beyond it JSON writers differ

std::uint64_t whole(const Value& value) {
  return static_cast<std::uint64_t>(value.integer(0, kMostWhole));
}

std::uint64_t offset_of(const Value& value) {
  return static_cast<std::uint64_t>(value["byteOffset"].integer_or(0, 0, kMostWhole));
}

// The number of one of `count` things.
Index index_of(const Value& value, std::size_t count, const char* things) {
  const std::uint64_t index = whole(value);
  if (index >= count) value.fail("is " + std::to_string(index) + ", but the file has " + std::to_string(count) + " " + things);
  return static_cast<Index>(index);
}

// A string without its quotes.
std::string plain(const Value& value) {
  constexpr std::size_t kMost = 64;
  return value.is_string() ? printable(value.string(), kMost) : value.shown();
}

class Parser {
 public:
  Parser(const json::Document& document, Wanted wanted) : root_(document.root()), wanted_(wanted) {}

  Document parse() {
    check_asset();
    check_extensions();
    document_.accessors.resize(count_of("accessors"));
    document_.views.resize(count_of("bufferViews"));
    document_.buffers.resize(count_of("buffers"));
    read_materials();
    read_haptic_materials();
    read_meshes();
    read_nodes();
    document_.physics = read_physics(root_);
    check_trees();
    read_scene();
    return std::move(document_);
  }

 private:
  // ---- the file as a whole

  void check_asset() const {
    const Value asset = root_["asset"];
    const Value version = asset["version"];
    if (!version) fail_version("of no stated version");
    if (const std::string number = plain(version); !number.starts_with("2.")) fail_version(number);
    const Value least = asset["minVersion"];
    if (least && plain(least) != "2.0") fail_version("for readers of version " + plain(least));
  }
  [[noreturn]] static void fail_version(const std::string& what) {
    throw Refusal{"is glTF " + what + "; version 2.0 is read: convert the file"};
  }

  void check_extensions() const {
    const Value required = root_["extensionsRequired"];
    if (!required) return;
    for (std::size_t i = 0; i < required.size(); ++i) {
      const Value item = required.item(i);
      if (is_harmless(item.string())) continue;
      item.fail(": the file needs the extension " + plain(item) +
                ", which may change the triangles and is not read; export it without");
    }
  }

  [[nodiscard]] std::size_t count_of(std::string_view list) const {
    const Value items = root_[list];
    return items ? items.size() : 0;
  }

  // ---- meshes, and what they refer to

  void read_meshes() {
    const Value meshes = root_["meshes"];
    if (!meshes) return;
    document_.meshes.resize(meshes.size());
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      const Value item = meshes.item(m);
      Mesh& mesh = document_.meshes[m];
      mesh.name = name_of(item);
      if (wanted_.haptics) mesh.haptic = haptic_of_mesh(item, document_.haptics.size());
      const Value primitives = item["primitives"];
      mesh.primitives.reserve(primitives.size());
      for (std::size_t p = 0; p < primitives.size(); ++p)
        mesh.primitives.push_back(read_primitive(primitives.item(p)));
    }
  }

  static std::string name_of(const Value& item) {
    const Value name = item["name"];
    return name ? name.string() : std::string();
  }

  Primitive read_primitive(const Value& item) {
    Primitive primitive;
    const Value attributes = item["attributes"];
    const Value mode = item["mode"];
    constexpr std::uint64_t kModes = 7;
    if (mode && whole(mode) >= kModes)
      mode.fail("is " + std::to_string(whole(mode)) + "; use one of the modes, 0 (points) to 6 (fan)");
    if (mode) primitive.mode = static_cast<Mode>(whole(mode));
    primitive.has_targets = static_cast<bool>(item["targets"]);
    if (const Value positions = attributes["POSITION"]) {
      primitive.positions = use_accessor(positions);
      check_positions(positions, *primitive.positions);
    }
    if (const Value normals = attributes["NORMAL"]; normals && wanted_.normals) {
      primitive.normals = use_accessor(normals);
      check_positions(normals, *primitive.normals);
    }
    if (wanted_.appearance) read_looks(attributes, primitive);
    if (const Value indices = item["indices"]) {
      primitive.indices = use_accessor(indices);
      check_indices(indices, *primitive.indices);
    }
    primitive.material = material_of(item);
    std::string height_uv;  // the name of the attribute
    if (wanted_.heights && primitive.material != kNone) height_uv = read_normal_texture(attributes, primitive);
    if (const Value extensions = item["extensions"]) read_draco(extensions, height_uv, primitive);
    return primitive;
  }

  void check_looks(const Value& place, Index index, bool is_usable, const char* kinds) const {
    if (!is_usable || document_.accessors[index].type == Component::u32)
      place.fail(": accessors[" + std::to_string(index) + "] is not of " + kinds + " of floats, nor of 8- or 16-bit integers");
  }
  Index use_places(const Value& uv) {
    const Index index = use_accessor(uv);
    check_looks(uv, index, document_.accessors[index].components == 2, "VEC2");
    return index;
  }
  void read_looks(const Value& attributes, Primitive& primitive) {
    if (const Value uv = attributes["TEXCOORD_0"]) primitive.uv = use_places(uv);
    if (const Value colours = attributes["COLOR_0"]) {
      primitive.colours = use_accessor(colours);
      const unsigned components = document_.accessors[*primitive.colours].components;
      check_looks(colours, *primitive.colours, components == 3 || components == 4, "VEC3 or VEC4");
    }
  }

  TextureReader textures() {
    document_.images.resize(count_of("images"));
    return {root_, document_.images, [this](const Value& view) { return use_view(view); }};
  }
  void read_haptic_materials() {
    if (!wanted_.haptics) return;
    TextureReader reader = textures();
    document_.haptics = read_haptics(root_, reader);
  }

  // The texture once for each material. The name of the texture coordinates by which it lies; empty: the first.
  std::string read_normal_texture(const Value& attributes, Primitive& primitive) {
    document_.normal_textures.resize(document_.materials.size());
    std::optional<TextureInfo>& texture = document_.normal_textures[primitive.material];
    if (!texture) texture = textures().normal_texture(primitive.material);
    if (!texture || texture->tex_coord == 0) return {};
    std::string name = "TEXCOORD_" + std::to_string(texture->tex_coord);
    primitive.has_height_uv = true;
    if (const Value uv = attributes[name]) primitive.height_uv = use_places(uv);
    return name;
  }

  // The geometry does not need them, so errors here do not refuse the file.
  void read_materials() try {
    const Value materials = root_["materials"];
    if (!materials) return;
    document_.materials.resize(materials.size());
    for (std::size_t m = 0; m < materials.size(); ++m)
      document_.materials[m] = name_of(materials.item(m));
    if (!wanted_.appearance) return;
    document_.base_colours.resize(materials.size(), {1, 1, 1, 1});
    for (std::size_t m = 0; m < materials.size(); ++m)
      read_base_colour(materials.item(m), document_.base_colours[m]);
  } catch (const Refusal&) {
    return;
  }
  static void read_base_colour(const Value& material, Colour& colour) {
    const Value metallic = material["pbrMetallicRoughness"];
    const Value factor = metallic ? metallic["baseColorFactor"] : metallic;
    if (!factor) return;
    std::array<double, 4> shares{};
    read_numbers(factor, shares);
    for (std::size_t k = 0; k < shares.size(); ++k)
      colour[k] = share_of(shares[k]);
  }
  [[nodiscard]] Index material_of(const Value& primitive) const try {
    const Value material = primitive["material"];
    return material ? index_of(material, document_.materials.size(), "materials") : kNone;
  } catch (const Refusal&) {
    return kNone;
  }

  void read_draco(const Value& extensions, const std::string& height_uv, Primitive& primitive) {
    const Value draco = extensions[kDraco];
    if (!draco) return;
    if (primitive.mode != Mode::triangles && primitive.mode != Mode::triangle_strip) {
      draco.fail("compresses a primitive of mode " + std::to_string(static_cast<int>(primitive.mode)) +
                 "; only triangles (4) and strips (5) can be");
    }
    const Value attributes = draco["attributes"];
    primitive.draco_positions = draco_id(attributes["POSITION"]);
    const std::pair<DracoExtra, std::string> extras[] = {{DracoExtra::normal, wanted_.normals ? "NORMAL" : ""},
                                                         {DracoExtra::uv, wanted_.appearance ? "TEXCOORD_0" : ""},
                                                         {DracoExtra::height_uv, height_uv},
                                                         {DracoExtra::colour, wanted_.appearance ? "COLOR_0" : ""}};
    for (const auto& [which, name] : extras) {
      if (name.empty()) continue;
      if (const Value attribute = attributes[name])
        primitive.draco_extras[static_cast<std::size_t>(which)] = draco_id(attribute);
    }
    primitive.draco_view = use_view(draco["bufferView"]);
  }
  static std::uint32_t draco_id(const Value& attribute) {
    const std::uint64_t id = whole(attribute);
    if (id > 0xFFFFFFFFu) attribute.fail("is " + std::to_string(id) + "; unique ids have 32 bits");
    return static_cast<std::uint32_t>(id);
  }

  void check_positions(const Value& place, Index index) const {
    const Accessor& accessor = document_.accessors[index];
    if (accessor.components == 3 && accessor.type != Component::u32) return;
    place.fail(": accessors[" + std::to_string(index) +
               "] is not of VEC3 of floats, nor of 8- or 16-bit integers (KHR_mesh_quantization)");
  }
  void check_indices(const Value& place, Index index) const {
    const Accessor& accessor = document_.accessors[index];
    const bool is_unsigned =
        accessor.type == Component::u8 || accessor.type == Component::u16 || accessor.type == Component::u32;
    if (accessor.components == 1 && is_unsigned) return;
    place.fail(": accessors[" + std::to_string(index) + "] is not of SCALAR of unsigned 8-, 16- or 32-bit integers");
  }

  // ---- accessors, views and buffers: each is read when something refers to it

  Index use_accessor(const Value& reference) {
    const Index index = index_of(reference, document_.accessors.size(), "accessors");
    Accessor& accessor = document_.accessors[index];
    if (accessor.is_used) return index;
    accessor.is_used = true;
    const Value list = root_["accessors"];
    const Value item = list.item(index);
    accessor.type = read_component(item["componentType"]);
    accessor.components = read_type(item["type"]);
    accessor.count = whole(item["count"]);
    if (const Value normalized = item["normalized"]) accessor.is_normalized = normalized.boolean();
    if (const Value view = item["bufferView"]) accessor.run = Run{use_view(view), offset_of(item)};
    if (const Value sparse = item["sparse"]) accessor.sparse = read_sparse(sparse, accessor);
    return index;
  }

  static Component read_component(const Value& item) {
    constexpr std::optional<Component> kComponents[] = {Component::i8, Component::u8,  Component::i16, Component::u16,
                                                        std::nullopt,  Component::u32, Component::f32};
    const std::uint64_t index = whole(item) - 5120;
    if (index < std::size(kComponents) && kComponents[index]) return *kComponents[index];
    item.fail("is " + std::to_string(whole(item)) + "; the types are 5120 to 5123, 5125 and 5126");
  }

  static unsigned read_type(const Value& item) {
    constexpr std::array<std::pair<std::string_view, unsigned>, 7> kTypes = {
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
    for (const auto& [name, components] : kTypes) {
      if (item.string() == name) return components;
    }
    item.fail("is " + item.shown() + "; the types are SCALAR, VEC2 to VEC4 and MAT2 to MAT4");
  }

  Sparse read_sparse(const Value& item, const Accessor& accessor) {
    Sparse sparse;
    const Value count = item["count"];
    sparse.count = whole(count);
    if (sparse.count > accessor.count) {
      count.fail("is " + std::to_string(sparse.count) + ", more than the accessor's " + std::to_string(accessor.count));
    }
    const Value indices = item["indices"], values = item["values"];
    const Value type = indices["componentType"];
    sparse.index_type = read_component(type);
    if (sparse.index_type != Component::u8 && sparse.index_type != Component::u16 && sparse.index_type != Component::u32) {
      type.fail("is not the type of an unsigned integer");
    }
    sparse.indices = {use_view(indices["bufferView"]), offset_of(indices)};
    sparse.values = {use_view(values["bufferView"]), offset_of(values)};
    return sparse;
  }

  Index use_view(const Value& reference) {
    const Index index = index_of(reference, document_.views.size(), "bufferViews");
    View& view = document_.views[index];
    if (view.is_used) return index;
    view.is_used = true;
    const Value list = root_["bufferViews"];
    const Value item = list.item(index);
    if (const Value extensions = item["extensions"]) view.meshopt = read_meshopt(extensions[kMeshopt]);
    if (!view.meshopt) view.buffer = use_buffer(item["buffer"]);
    view.offset = offset_of(item);
    view.bytes = whole(item["byteLength"]);
    view.stride = item["byteStride"] ? whole(item["byteStride"]) : 0;
    return index;
  }

  std::optional<Meshopt> read_meshopt(const Value& item) {
    if (!item) return std::nullopt;
    Meshopt packed;
    packed.buffer = use_buffer(item["buffer"]);
    packed.offset = offset_of(item);
    packed.bytes = whole(item["byteLength"]);
    packed.stride = whole(item["byteStride"]);
    packed.count = whole(item["count"]);
    const std::size_t mode = choice(item["mode"], {"ATTRIBUTES", "TRIANGLES", "INDICES"});
    packed.mode = static_cast<Meshopt::Mode>(mode);
    if (const Value filter = item["filter"])
      packed.filter = static_cast<Meshopt::Filter>(choice(filter, {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}));
    return packed;
  }

  static std::size_t choice(const Value& item, const std::vector<std::string_view>& names) {
    const auto found = std::find(names.begin(), names.end(), std::string_view(item.string()));
    if (found == names.end()) item.fail("is " + item.shown() + ", no name that the extension has");
    return static_cast<std::size_t>(found - names.begin());
  }

  Index use_buffer(const Value& reference) {
    const Index index = index_of(reference, document_.buffers.size(), "buffers");
    Buffer& buffer = document_.buffers[index];
    if (buffer.is_used) return index;
    buffer.is_used = true;
    const Value list = root_["buffers"];
    const Value item = list.item(index);
    if (const Value uri = item["uri"]) buffer.uri = uri.string();
    buffer.bytes = whole(item["byteLength"]);
    return index;
  }

  // ---- nodes

  void read_nodes() {
    const Value nodes = root_["nodes"];
    if (!nodes) return;
    document_.nodes.resize(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const Value item = nodes.item(n);
      Node& node = document_.nodes[n];
      node.name = name_of(item);
      node.has_skin = static_cast<bool>(item["skin"]);
      if (const Value mesh = item["mesh"]) node.mesh = index_of(mesh, document_.meshes.size(), "meshes");
      read_transform(item, node);
      if (const Value children = item["children"]) read_children(children, static_cast<Index>(n));
    }
  }

  void read_children(const Value& children, Index parent) {
    for (std::size_t i = 0; i < children.size(); ++i) {
      const Value item = children.item(i);
      const Index child = index_of(item, document_.nodes.size(), "nodes");
      Index& known = document_.nodes[child].parent;
      if (known != kNone) {
        item.fail(": nodes[" + std::to_string(child) + "] is a child of nodes[" + std::to_string(known) +
                  "] already, and has one parent at most; export the scene again");
      }
      known = parent;
      document_.nodes[parent].children.push_back(child);
    }
  }

  void read_transform(const Value& item, Node& node) {
    Matrix matrix = kIdentity;
    if (const Value given = item["matrix"]) {
      read_numbers(given, matrix);
      const bool is_affine = matrix[3] == 0 && matrix[7] == 0 && matrix[11] == 0 && matrix[15] == 1;
      if (!is_affine) given.fail(": its last row is not 0, 0, 0, 1; export the scene again");
    } else {
      std::array<double, 3> translation{}, scale = {1, 1, 1};
      std::array<double, 4> rotation = {0, 0, 0, 1};
      if (const Value t = item["translation"]) read_numbers(t, translation);
      if (const Value s = item["scale"]) read_numbers(s, scale);
      const Value r = item["rotation"];
      if (r) read_numbers(r, rotation);
      if (!composed(translation, rotation, scale, matrix))
        r.fail("is no rotation: its length is not that of a unit quaternion");
    }
    if (matrix == kIdentity) return;
    node.matrix = static_cast<Index>(document_.matrices.size());
    document_.matrices.push_back(matrix);
  }

  template <std::size_t kCount>
  static void read_numbers(const Value& list, std::array<double, kCount>& numbers) {
    if (list.size() != kCount) list.fail("has " + std::to_string(list.size()) + " numbers, not " + std::to_string(kCount));
    for (std::size_t i = 0; i < kCount; ++i)
      numbers[i] = list.item(i).number();
  }

  // No node has two parents (read_children), so a cycle is the only other error.
  void check_trees() const {
    const std::vector<Node>& nodes = document_.nodes;
    std::vector<Index> seen_from(nodes.size(), kNone);  // start of the walk to the root that visited the node
    for (Index start = 0; start < nodes.size(); ++start) {
      for (Index n = start; n != kNone && seen_from[n] != start; n = nodes[n].parent) {
        if (seen_from[n] != kNone) break;
        seen_from[n] = start;
        if (nodes[n].parent != kNone && seen_from[nodes[n].parent] == start) {
          throw Refusal{"nodes[" + std::to_string(n) + "] is its own ancestor; export the scene again"};
        }
      }
    }
  }

  void read_scene() {
    const Value scenes = root_["scenes"];
    const std::size_t count = scenes ? scenes.size() : 0;
    const Value chosen = root_["scene"];
    const Index scene = chosen ? index_of(chosen, count, "scenes") : 0;
    if (count == 0) {
      for (Index n = 0; n < document_.nodes.size(); ++n) {
        if (document_.nodes[n].parent == kNone) document_.roots.push_back(n);
      }
      return;
    }
    const Value item = scenes.item(scene);
    const Value roots = item["nodes"];
    if (!roots) return;
    std::vector<bool> is_listed(document_.nodes.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const Value root = roots.item(i);
      const Index n = index_of(root, document_.nodes.size(), "nodes");
      if (is_listed[n]) root.fail("lists nodes[" + std::to_string(n) + "] a second time; export the scene again");
      if (document_.nodes[n].parent != kNone) {
        root.fail(": nodes[" + std::to_string(n) + "] is a child of nodes[" + std::to_string(document_.nodes[n].parent) +
                  "] and no root; export the scene again");
      }
      is_listed[n] = true;
      document_.roots.push_back(n);
    }
  }

  Value root_;
  Wanted wanted_;
  Document document_;
};

}  // namespace

Document parse_document(std::string_view text, Wanted wanted) {
  constexpr json::Limits kLimits = {0xFFFFFFFF, 128, true};  // glTF needs some ten levels, extras may have a few more
  constexpr std::size_t kShown = 300;                        // bytes: the text that is wrong may be long
  std::optional<json::Document> document;
  try {
    document.emplace(text, kLimits);
  } catch (const Refusal& refusal) {
    throw Refusal{(refusal.is_cut_short ? "truncated: it " : "") + printable(refusal.message, kShown) +
                  "; fetch or export the file again"};
  }
  return Parser(*document, wanted).parse();
}

}  // namespace fdcg::bake::gltf
