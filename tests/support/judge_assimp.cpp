// SPDX-License-Identifier: Apache-2.0
// Assimp as a judge: its scene as it is, nothing joined, cut or turned upright.
#include <assimp/config.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>

#include "judge_scene.hpp"

namespace fdcg::test {
namespace {

using Transform = aiMatrix4x4t<double>;

Transform in_double(const aiMatrix4x4& m) {
  return {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4};
}

// Mirrored faces are turned, so that their outside stays outside: assimp leaves this to a step of its own.
void add_mesh(const aiMesh& mesh, const Transform& place, std::vector<PlacedFace>& faces) {
  const bool is_mirrored = place.Determinant() < 0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& from = mesh.mFaces[f];
    if (from.mNumIndices < 3) continue;  // points and lines
    PlacedFace face;
    for (unsigned k = 0; k < from.mNumIndices; ++k) {
      const aiVector3D& p = mesh.mVertices[from.mIndices[k]];
      const aiVector3t<double> at = place * aiVector3t<double>(p.x, p.y, p.z);
      face.push_back({at.x, at.y, at.z});
    }
    if (is_mirrored) std::reverse(face.begin() + 1, face.end());
    faces.push_back(std::move(face));
  }
}

void add_node(const aiScene& scene, const aiNode& node, const Transform& place, std::vector<PlacedFace>& faces) {
  for (unsigned m = 0; m < node.mNumMeshes; ++m)
    add_mesh(*scene.mMeshes[node.mMeshes[m]], place, faces);
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    add_node(scene, *node.mChildren[c], place * in_double(node.mChildren[c]->mTransformation), faces);
}

}  // namespace

// Of COLLADA the root's transform is the unit alone, since axes are left as they are: it is taken as that and left out.
JudgeScene read_with_assimp(const std::filesystem::path& path) {
  JudgeScene result;
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* const scene = importer.ReadFile(path.string(), 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    result.trouble = importer.GetErrorString();
    return result;
  }
  const std::string ending = path.extension().string();
  const bool is_collada = ending == ".dae" || ending == ".DAE" || ending == ".zae";
  const Transform root = in_double(scene->mRootNode->mTransformation);
  if (is_collada) result.metres_per_unit = root.a1;
  add_node(*scene, *scene->mRootNode, is_collada ? Transform() : root, result.faces);
  return result;
}

}  // namespace fdcg::test
