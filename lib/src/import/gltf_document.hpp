// SPDX-License-Identifier: Apache-2.0
// The geometry described by the JSON of a glTF 2.0 file, checked: every index in it is valid. Parts that the geometry does not
// need (animations, other accessors) are neither read nor checked; of materials only names, base colours and, where they are
// wanted, normal textures are read.
//
// Places in messages are JSON paths: "meshes[2].primitives[0].attributes.POSITION".
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fdcg/bake.hpp"
#include "import/draco_decode.hpp"
#include "import/gltf_physics.hpp"
#include "import/gltf_textures.hpp"
#include "import/placing.hpp"
#include "shared/json/reader.hpp"

namespace fdcg::bake::gltf {

// Thrown where a file is found wanting, caught by read_gltf: the place is known deep down, the file's name at the top.
using json::Refusal;

// The targets of the bufferViews, accessors, ... that are used.
using Index = std::uint32_t;

enum class Component : std::uint8_t { i8, u8, i16, u16, u32, f32 };
[[nodiscard]] constexpr std::size_t size_of(Component type) {
  constexpr std::array<std::size_t, 6> kSizes = {1, 1, 2, 2, 4, 4};
  return kSizes[static_cast<std::size_t>(type)];
}

struct Buffer {
  bool is_used = false;
  std::optional<std::string> uri;  // none: the binary chunk of the GLB
  std::uint64_t bytes = 0;
};

// How EXT_meshopt_compression has packed a view.
struct Meshopt {
  enum class Mode : std::uint8_t { attributes, triangles, indices };
  enum class Filter : std::uint8_t { none, octahedral, quaternion, exponential };
  Index buffer = 0;
  std::uint64_t offset = 0, bytes = 0, stride = 0, count = 0;
  Mode mode = Mode::attributes;
  Filter filter = Filter::none;
};

struct View {
  bool is_used = false;
  Index buffer = 0;
  std::uint64_t offset = 0, bytes = 0, stride = 0;  // stride 0: tightly packed
  std::optional<Meshopt> meshopt;                   // then buffer and offset are not used
};

// A run of values in a view.
struct Run {
  Index view = 0;
  std::uint64_t offset = 0;
};

struct Sparse {
  std::uint64_t count = 0;
  Run indices, values;
  Component index_type = Component::u32;
};

struct Accessor {
  bool is_used = false;
  std::optional<Run> run;  // none: zeros, or compressed data that stands elsewhere
  Component type = Component::f32;
  unsigned components = 1;  // 3 for positions, 1 for indices
  bool is_normalized = false;
  std::uint64_t count = 0;
  std::optional<Sparse> sparse;
};

enum class Mode : std::uint8_t { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

struct Primitive {
  Mode mode = Mode::triangles;
  std::optional<Index> positions, indices;  // accessors
  std::optional<Index> normals;             // accessor, where they are wanted
  std::optional<Index> uv, colours;         // likewise
  std::optional<Index> height_uv;           // accessor; none: it has none of that set
  bool has_height_uv = false;               // the normal texture of its material lies by height_uv, not by uv
  std::optional<Index> draco_view;          // KHR_draco_mesh_compression
  std::uint32_t draco_positions = 0;        // unique id of the attribute
  DracoExtraIds draco_extras = {};          // of those that are wanted
  bool has_targets = false;
  std::uint32_t material = 0xFFFFFFFF;  // in Document::materials
};

inline constexpr Index kNone = 0xFFFFFFFF;

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  Index haptic = kNone;  // in Document::haptics
};

// A material of MPEG_haptic_material: its textures of values.
struct Haptic {
  std::string name;
  std::optional<TextureInfo> stiffness, friction;
};

struct Node {
  std::string name;
  std::vector<Index> children;
  Index parent = kNone;
  Index mesh = kNone;
  Index matrix = kNone;  // in Document::matrices; none: identity
  bool has_skin = false;
};

// The nodes form trees: none has two parents or is its own ancestor.
struct Document {
  std::vector<Buffer> buffers;
  std::vector<View> views;
  std::vector<Accessor> accessors;
  std::vector<Mesh> meshes;
  std::vector<std::string> materials;                       // names, of those that have one
  std::vector<Colour> base_colours;                         // of the materials, where the appearance is wanted
  std::vector<std::optional<TextureInfo>> normal_textures;  // of the materials that a primitive has, where heights are wanted
  std::vector<Image> images;                                // of the file's; those of textures above are read
  std::vector<Haptic> haptics;                              // where they are wanted
  std::vector<Node> nodes;
  std::vector<Matrix> matrices;
  Physics physics;
  std::vector<Index> roots;  // of the scene that is shown: the default one, else the first; without scenes, all roots
};

// What is looked up beside the geometry.
struct Wanted {
  bool normals = false;
  bool appearance = false;  // texture coordinates, colours and base colours
  bool heights = false;     // normal textures
  bool haptics = false;     // MPEG_haptic_material
};

// Throws Refusal.
Document parse_document(std::string_view text, Wanted wanted = {});

}  // namespace fdcg::bake::gltf
