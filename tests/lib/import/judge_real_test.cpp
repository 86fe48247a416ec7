// SPDX-License-Identifier: Apache-2.0
// Mesh files of other people, as assimp and lib3mf read them: the same faces in the same places, and the same unit. Where a
// judge differs, it stands in kDifferences, with how many faces it is about and why.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>

#include "../../support/import_support.hpp"
#include "../../support/judge_scene.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;

namespace {

// A judge's own way with a file (and the folder that it is in). Faces without a partner, and partners of opposite winding;
// exact.
struct Difference {
  std::string_view file;
  std::size_t ours, theirs, turned;
  const char* why;
};
constexpr Difference kDifferences[] = {
    {"defective/inf_nan.obj", 1, 1, 0, "assimp reads inf as NaN"},
    {"real/Mors1_CM_line.obj", 1, 0, 0, "assimp takes a face of two corners for a line"},
    {"real/Mors2_CM_line.obj", 1, 0, 0, "likewise"},
    {"invalid/malformed2.obj", 1, 0, 0, "assimp drops a face without corners; here it is reported"},
    {"IndexOutOfRange/IndexOutOfRange.gltf", 1, 0, 0,
     "assimp drops a face with a corner that is not there; here it is reported"},
};

// Files that one of us refuses and the other reads, with a word of the reason.
struct Refused {
  std::string_view file;
  const char* ours;    // in our message; null: we read it
  const char* theirs;  // in the judge's; null: it reads it
};
constexpr Refused kRefused[] = {
    {"real/malformed_property_index_oob.3mf", "names property 1000000", nullptr},
    {"real/part76.obj", nullptr, "Invalid face index"},  // reported as index-out-of-range
    {"Collada/cube_UTF16LE.dae", nullptr, "malformed XML"},
    {"Collada/library_animation_clips.dae", nullptr, "Cannot parse string"},  // of an animation
    {"Collada/cameras.dae", "holds no face", nullptr},  // assimp draws the skeleton of a scene without meshes
    {"Collada/lights.dae", "holds no face", nullptr},   // likewise
    {"OBJ/box_UTF16BE.obj", "UTF-16", nullptr},
    {"OBJ/number_formats.obj", "'3.1+e2' is not a number", nullptr},
    {"OFF/invalid.off", "truncated: the header promises 4 faces", nullptr},
    {"PLY/Wuson.ply", "a line that starts with 'Created'", nullptr},
    {"PLY/issue623.ply", "'7.941797' is not a whole number", nullptr},  // no 'element face' in its header
    {"PLY/pond.0.ply", "truncated", nullptr},
    {"X3D/HelloX3dTrademark.x3d", "holds no face", nullptr},  // a sphere and a text, which assimp tessellates
    {"X3D/ComputerKeyboard.x3d", "holds no face", nullptr},   // extrusions
    {"IndexOutOfRange/AllIndicesOutOfRange.gltf", nullptr, "has no faces"},
    {"issue_3269/texcoord_crash.gltf", nullptr, "TEXCOORD_1"},
    {"wrongTypes/badExtension.gltf", nullptr, "KHR_texture_transform"},  // of materials and names: the triangles are fine
    {"wrongTypes/badNumber.gltf", nullptr, "scale"},
    {"wrongTypes/badObject.gltf", nullptr, "pbrMetallicRoughness"},
    {"wrongTypes/badString.gltf", nullptr, "name"},
    {"wrongTypes/badUint.gltf", nullptr, "index"},
    {"invalid/OutOfMemory.off", "truncated: the header promises 353535235358 vertices", nullptr},
    {"invalid/malformed.obj", nullptr, "Invalid face index"},  // reported as index-out-of-range
};

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return ending;
}

std::vector<std::filesystem::path> files_to_judge() {
  const char* named = std::getenv("FDCG_REAL_MESHES");
  const std::filesystem::path shared =
      named != nullptr ? std::filesystem::path(named) : std::filesystem::path(FDCG_SOURCE_DIR) / "../shared/meshes";
  const std::set<std::string> endings = {".dae", ".zae", ".3mf", ".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".x3d"};
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& folder : {shared, std::filesystem::path("/usr/share/assimp/models")}) {
    for (const auto& path : files_in(folder)) {
      if (endings.contains(lower_ending(path))) files.push_back(path);
    }
  }
  return files;
}

struct Verdict {
  bool is_compared = false;
  std::string text;  // empty: as expected
};

Verdict judge(const std::filesystem::path& path) {
  const std::string name = (path.parent_path().filename() / path.filename()).string();
  const bool is_3mf = lower_ending(path) == ".3mf";
  const JudgeScene theirs = is_3mf ? read_with_lib3mf(path) : read_with_assimp(path);
  if (theirs.trouble == kNoJudge) return {};
  const Result<PolygonSoup> soup = import_mesh(path);
  const auto* const refused =
      std::find_if(std::begin(kRefused), std::end(kRefused), [&](const Refused& r) { return r.file == name; });
  const std::string our_trouble = soup ? std::string() : soup.error().message;
  if (refused != std::end(kRefused)) {
    const auto is_said = [](const char* word, const std::string& trouble) {
      return word == nullptr ? trouble.empty() : trouble.find(word) != std::string::npos;
    };
    if (is_said(refused->ours, our_trouble) && is_said(refused->theirs, theirs.trouble)) return {};
    return {false, "refused otherwise than listed; ours: '" + our_trouble + "', judge: '" + theirs.trouble + "'"};
  }
  const bool is_empty = !soup && soup.error().rule == "empty-mesh" && theirs.faces.empty();
  const bool is_version_1 = our_trouble.find("version 2.0 is read") != std::string::npos ||  // of glTF
                            our_trouble.find("version 2 is read") != std::string::npos;
  if (is_empty || is_version_1 || (!soup && !theirs.trouble.empty())) return {};
  if (!soup || !theirs.trouble.empty()) return {false, "ours: '" + our_trouble + "', judge: '" + theirs.trouble + "'"};
  const std::vector<PlacedFace> ours = faces_in_place(*soup);
  const FaceDifference found = compare_faces(ours, theirs.faces, 0x1p-18 * extent_of(ours));
  const auto* const listed =
      std::find_if(std::begin(kDifferences), std::end(kDifferences), [&](const Difference& d) { return d.file == name; });
  const Difference want = listed != std::end(kDifferences) ? *listed : Difference{"", 0, 0, 0, ""};
  std::string text;
  if (found.ours.size() != want.ours || found.theirs.size() != want.theirs || found.turned != want.turned) {
    text = std::to_string(ours.size()) + " faces, judge " + std::to_string(theirs.faces.size()) + "; ours alone " +
           std::to_string(found.ours.size()) + ", theirs alone " + std::to_string(found.theirs.size()) + ", turned " +
           std::to_string(found.turned);
    for (std::size_t i = 0; i < std::min<std::size_t>(2, found.ours.size()); ++i)
      text += "\n    ours " + std::to_string(found.ours[i]) + ": " + shown(ours[found.ours[i]]);
    for (std::size_t i = 0; i < std::min<std::size_t>(2, found.theirs.size()); ++i)
      text += "\n    theirs " + std::to_string(found.theirs[i]) + ": " + shown(theirs.faces[found.theirs[i]]);
  }
  if (theirs.metres_per_unit > 0 && std::fabs(theirs.metres_per_unit - soup->metres_per_unit) > 1e-6 * soup->metres_per_unit)
    text += " unit " + std::to_string(soup->metres_per_unit) + ", judge " + std::to_string(theirs.metres_per_unit);
  return {true, text};
}

}  // namespace

TEST_CASE("real files have the faces, places and units that assimp and lib3mf read") {
  const std::vector<std::filesystem::path> files = files_to_judge();
  if (files.empty()) WARN("skipped: no real meshes at hand");
  int compared = 0;
  for (const auto& path : files) {
    const Verdict verdict = judge(path);
    if (!verdict.text.empty()) UNSCOPED_INFO(path.string() << ": " << verdict.text);
    CHECK(verdict.text.empty());
    compared += verdict.is_compared ? 1 : 0;
  }
  if (!files.empty()) CHECK(compared > 20);
}
