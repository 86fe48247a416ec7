// SPDX-License-Identifier: Apache-2.0
// Draco-compressed meshes (bitstream up to 2.2, libdraco). draco_decode.cpp alone includes the library.
//
// libdraco trusts the counts in a file: a forged file of 34 bytes makes it allocate 16 GB. It therefore runs only in a child
// process with limits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fdcg/bake.hpp"
#include "import/guarded_child.hpp"

namespace fdcg::bake {

// What may be read beside positions. height_uv: texture coordinates of another set.
enum class DracoExtra : std::uint8_t { normal, uv, height_uv, colour };
inline constexpr std::size_t kDracoExtras = 4;
// Of each, the attribute's unique id as in glTF; none: it is not wanted.
using DracoExtraIds = std::array<std::optional<std::uint32_t>, kDracoExtras>;

struct DracoInput {
  std::string_view bytes;
  std::optional<std::uint32_t> position_id;  // the attribute's unique id, as in glTF; default: the position attribute
  DracoExtraIds extra_ids = {};
  bool wants_named = false;  // normals, the first texture coordinates and colours, by what Draco calls them
};

// Of a point: components that are not there are 1; integers as shares of their largest.
using DracoValue = std::array<float, 4>;

// Points are numbered as Draco numbers them: one for each combination of attribute values, so that a vertex on a seam of
// another attribute (a texture's, say) is several points at the same place.
struct DracoMesh {
  std::string trouble;  // why there is no mesh, a phrase that follows its name ("is not ..."); else empty
  bool is_point_cloud = false;
  bool is_float = false;               // every coordinate is a float; else each is an integer or a double
  double absolute_quantum = 0;         // half a step of the quantisation; 0 where there is none
  std::vector<Vec3> points;            // exactly what libdraco decodes
  std::vector<std::uint32_t> corners;  // three a face
  // One a point, or none: not wanted, not there, or not of three (normals), two (texture coordinates), three or four (colours)
  // components.
  std::array<std::vector<DracoValue>, kDracoExtras> extras;
  bool has_whole_colours = false;  // colours are integers: of a screen, in files that are no glTF
};

// In this process: for the child, and for fuzzing under a memory limit of another kind.
DracoMesh decode_draco_here(const DracoInput& input);

// The meshes in the result of the child process.
class DracoMeshes {
 public:
  struct Mesh {
    std::string trouble;
    bool is_point_cloud = false;
    bool is_float = false;
    double absolute_quantum = 0;
    std::span<const Vec3> points;
    std::span<const std::uint32_t> corners;  // three a face; may be no point's number
    std::array<std::span<const DracoValue>, kDracoExtras> extras;
    bool has_whole_colours = false;

    [[nodiscard]] std::span<const DracoValue> extra(DracoExtra which) const { return extras[static_cast<std::size_t>(which)]; }
  };

  // Why none could be decoded: how the child process ended, a phrase that follows "its Draco data"; else empty.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] std::string refusal() const;                                 // the same as a message, with what to do about it
  [[nodiscard]] const std::vector<Mesh>& meshes() const { return meshes_; }  // one an input

 private:
  friend DracoMeshes decode_draco(std::span<const DracoInput> inputs, const ChildLimits& limits);
  bool read(std::size_t count);

  ChildResult result_;
  std::string trouble_;
  std::vector<Mesh> meshes_;
};

// Decodes all of them in one child process.
DracoMeshes decode_draco(std::span<const DracoInput> inputs, const ChildLimits& limits);

// 256 MiB and 512 bytes for each byte of Draco data; 10 s and 4 s for each MiB. Meshes take 0.3 to 2 bytes a face, and libdraco
// some 100 bytes and a microsecond for each.
ChildLimits draco_limits(std::size_t draco_bytes);

}  // namespace fdcg::bake
