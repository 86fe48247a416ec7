// SPDX-License-Identifier: Apache-2.0
// Each refusal names the place in the JSON, the value, the limit and what to do; and the files that a glTF file may lead to.
#include <unistd.h>

#include "../../support/gltf_scene.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;

namespace {

// Without the name of the file, and without the remedy that is the same for all.
std::string gist(const std::string& message) {
  const std::string remedy = "; correct the file or export it again";
  const std::string gist = message.substr(6);
  return gist.ends_with(remedy) ? gist.substr(0, gist.size() - remedy.size()) : gist;
}

// The gist of the refusal of the square's document with the value at `pointer` changed.
std::string with(const std::string& pointer, const Json& value) {
  GltfScene scene = square();
  Json whole = Json::parse(scene.text());
  whole[Json::json_pointer(pointer)] = value;
  return gist(refusal(whole.dump()));
}
std::string without(const std::string& pointer, const std::string& key) {
  Json whole = Json::parse(square().text());
  whole.at(Json::json_pointer(pointer)).erase(key);
  return gist(refusal(whole.dump(), Format::gltf));
}

// A folder for one test, removed after it.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("fdcg-gltf-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_ / "deep er");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace

TEST_CASE("what is wrong in the JSON is refused by its path") {
  CHECK(without("", "asset") == "asset is missing");
  CHECK(with("/asset/version", "1.0") == "is glTF 1.0; version 2.0 is read: convert the file");
  CHECK(with("/asset/version", 1) == "is glTF 1; version 2.0 is read: convert the file");
  CHECK(with("/asset/minVersion", "2.1") == "is glTF for readers of version 2.1; version 2.0 is read: convert the file");
  CHECK(
      with("/extensionsRequired", {"KHR_texture_transform", "EXT_mesh_gpu_instancing"}) ==
      "extensionsRequired[1]: the file needs the extension EXT_mesh_gpu_instancing, which may change the triangles and is not "
      "read; export it without");
  CHECK(with("/scene", 1) == "scene is 1, but the file has 1 scenes");
  CHECK(with("/scene", -1) == "scene is -1; it must be an integer from 0 to 9007199254740991");
  CHECK(with("/scene", 0.5) == "scene is 0.5; it must be an integer from 0 to 9007199254740991");
  CHECK(with("/scene", "0") == "scene is \"0\"; it must be an integer from 0 to 9007199254740991");
  CHECK(with("/scenes/0/nodes/0", 1) == "scenes[0].nodes[0] is 1, but the file has 1 nodes");
  CHECK(with("/scenes/0/nodes/1", 0) == "scenes[0].nodes[1] lists nodes[0] a second time; export the scene again");
  CHECK(with("/nodes/0/mesh", 3) == "nodes[0].mesh is 3, but the file has 1 meshes");
  CHECK(with("/nodes/0/children", {0}) == "nodes[0] is its own ancestor; export the scene again");
  CHECK(with("/nodes/0/children", 0) == "nodes[0].children is 0; it must be a list: [ ... ]");
  CHECK(with("/nodes/0/matrix", {1, 2, 3}) == "nodes[0].matrix has 3 numbers, not 16");
  CHECK(with("/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2}) ==
        "nodes[0].matrix: its last row is not 0, 0, 0, 1; export the scene again");
  CHECK(with("/nodes/0/rotation", {0, 0, 0, 0}) ==
        "nodes[0].rotation is no rotation: its length is not that of a unit quaternion");
  CHECK(with("/meshes/0/primitives", Json::object()) == "meshes[0].primitives is an object; it must be a list: [ ... ]");
  CHECK(without("/meshes/0/primitives/0", "attributes") == "meshes[0].primitives[0].attributes is missing");
  CHECK(with("/meshes/0/primitives/0/mode", 7) ==
        "meshes[0].primitives[0].mode is 7; use one of the modes, 0 (points) to 6 (fan)");
  CHECK(with("/meshes/0/primitives/0/attributes/POSITION", 7) ==
        "meshes[0].primitives[0].attributes.POSITION is 7, but the file has 2 accessors");
  CHECK(with("/meshes/0/primitives/0/attributes/POSITION", 1) ==
        "meshes[0].primitives[0].attributes.POSITION: accessors[1] is not of VEC3 of floats, nor of 8- or 16-bit integers "
        "(KHR_mesh_quantization)");
  CHECK(with("/meshes/0/primitives/0/indices", 0) ==
        "meshes[0].primitives[0].indices: accessors[0] is not of SCALAR of unsigned 8-, 16- or 32-bit integers");
  CHECK(with("/accessors/0/componentType", 5124) ==
        "accessors[0].componentType is 5124; the types are 5120 to 5123, 5125 and 5126");
  CHECK(with("/accessors/0/type", "VEC9") ==
        "accessors[0].type is \"VEC9\"; the types are SCALAR, VEC2 to VEC4 and MAT2 to MAT4");
  CHECK(with("/accessors/0/bufferView", 2) == "accessors[0].bufferView is 2, but the file has 2 bufferViews");
  CHECK(with("/bufferViews/1/buffer", 1) == "bufferViews[1].buffer is 1, but the file has 1 buffers");
  CHECK(with("/bufferViews/0/byteStride", 8) ==
        "bufferViews[0].byteStride is 8, less than the 12 bytes of a value of accessors[0]");
}

TEST_CASE("no accessor, view or buffer reaches beyond its bytes, however large the numbers") {
  CHECK(with("/accessors/0/count", 5) ==
        "truncated: accessors[0] promises 5 values of 12 bytes, bufferViews[0] holds 4 from byte 0 on; fetch or export the "
        "file again");
  CHECK(with("/accessors/0/byteOffset", 1).starts_with("truncated: accessors[0] promises 4 values of 12 bytes"));
  CHECK(with("/accessors/0/byteOffset", 9007199254740991).starts_with("truncated: accessors[0] promises 4 values"));
  CHECK(with("/accessors/0/count", 9007199254740991).starts_with("truncated: accessors[0] promises 9007199254740991 values"));
  CHECK(with("/accessors/0/count", 1e300).starts_with("accessors[0].count is 1e+300; it must be an integer"));
  CHECK(with("/bufferViews/1/byteLength", 25) ==
        "bufferViews[1]: needs 25 bytes from byte 48 on, buffers[0] has 72; fetch or export the file again");
  CHECK(with("/bufferViews/1/byteOffset", 9007199254740991).starts_with("bufferViews[1]: needs 24 bytes from byte 90071992"));
  CHECK(with("/buffers/0/byteLength", 73) ==
        "truncated: buffers[0].byteLength promises 73 bytes, there are 72; fetch or export the file again");
  const Json sparse = {{"count", 1},
                       {"indices", {{"bufferView", 1}, {"componentType", kU32}, {"byteOffset", 20}}},
                       {"values", {{"bufferView", 0}}}};
  const auto changed = [&sparse](const char* pointer, const Json& value) {
    Json other = sparse;
    other[Json::json_pointer(pointer)] = value;
    return with("/accessors/0/sparse", other);
  };
  CHECK(changed("/count", 5) == "accessors[0].sparse.count is 5, more than the accessor's 4");
  CHECK(changed("/count", 2).starts_with("truncated: accessors[0].sparse.indices promises 2 values"));
  CHECK(changed("/values/byteOffset", 40).starts_with("truncated: accessors[0].sparse.values promises 1 values of 12 bytes"));
  CHECK(changed("/indices/componentType", kF32) ==
        "accessors[0].sparse.indices.componentType is not the type of an unsigned integer");
  Json unsorted = sparse;
  unsorted["count"] = 3;
  unsorted["indices"]["byteOffset"] = 4;  // 1, 2, 0
  CHECK(with("/accessors/0/sparse", unsorted) ==
        "accessors[0].sparse.indices: value 2 is 0, neither above the one before it nor below the accessor's count 4");
}

TEST_CASE("broken, truncated or too deeply nested JSON is refused with its place") {
  const std::string text = square().text();
  const std::string remedy = "; fetch or export the file again";
  const std::string cut = refusal(text.substr(0, text.size() - 1));
  CHECK(cut.starts_with("mesh: truncated: it is no JSON: line 1, column " + std::to_string(text.size()) + ": unexpected end"));
  CHECK(cut.ends_with(remedy));
  const std::string broken = refusal("{\n\"asset\":}", Format::gltf);
  CHECK(broken.starts_with("mesh: is no JSON: line 2, column 9: "));
  CHECK(broken.ends_with(remedy));
  CHECK(refusal("{\"asset\":" + std::string(200, '[')) == "mesh: nests deeper than 128 levels; write it flatter" + remedy);
  CHECK(refusal("{\"asset\":1e999}") == "mesh: is no JSON: number overflow parsing '1e999'" + remedy);
  CHECK(refusal("[]", Format::gltf) == "mesh: is a list of 0; it must be an object: { ... }");
}

TEST_CASE("a GLB is refused where its lengths, its version or its first chunk are wrong") {
  const std::string glb = square().glb();
  REQUIRE(import_text(glb).face_count() == 2);
  const auto changed = [&glb](std::size_t at, char byte) {
    std::string other = glb;
    other[at] = byte;
    return refusal(other);
  };
  CHECK(changed(4, 1) == "mesh: is GLB version 1; version 2 is read: convert the file");
  CHECK(changed(11, 1).starts_with("mesh: truncated: the GLB header promises "));
  CHECK(changed(14, 1).starts_with("mesh: truncated: byte 20: GLB chunk 0 promises "));
  CHECK(changed(16, 'X') == "mesh: its first GLB chunk is not JSON; export the file again");
  CHECK(refusal("glTF") == "mesh: truncated: a GLB starts with 20 bytes, the file has 4; fetch or export the file again");
  CHECK(refusal(glb + "x").starts_with("mesh: contradicts itself: the GLB header promises "));
  CHECK(import_text(glb + std::string(4, '\0')).face_count() == 2);
}

TEST_CASE("a GLB without the chunk of its buffer is refused with that reason") {
  GltfScene scene = square();
  scene.json["buffers"] = {{{"byteLength", scene.buffer().size()}}};
  CHECK(refusal(glb_container(scene.json.dump(), std::nullopt)) ==
        "mesh: buffers[0]: has neither a uri nor a binary chunk, so that its bytes are nowhere; export the file again");
  CHECK(import_text(glb_container(scene.json.dump(), scene.buffer())).face_count() == 2);
}

TEST_CASE("buffers in files beside or beneath the glTF file are read, by their percent-encoded names") {
  const Folder folder;
  GltfScene scene = square();
  for (const auto& [uri, name] :
       {std::pair("square.bin", "square.bin"), std::pair("a%20b%C3%A4.bin", "a b\xC3\xA4.bin"),
        std::pair("deep%20er/b.bin", "deep er/b.bin"), std::pair("./deep er/c.bin", "deep er/c.bin")}) {
    INFO(uri);
    folder.write(name, scene.buffer());
    scene.json["buffers"] = {{{"byteLength", scene.buffer().size()}, {"uri", uri}}};
    const Result<PolygonSoup> soup = import_mesh(folder.write("square.gltf", scene.json.dump()));
    REQUIRE(soup);
    CHECK(soup->face_count() == 2);
    CHECK(soup->other_files.size() == 1);
    CHECK(std::filesystem::path(soup->other_files[0]).filename() == std::filesystem::path(name).filename());
    CHECK(refusal(scene.json.dump()).find("is a file of its own, but this one is not read from a folder") != std::string::npos);
  }
  folder.write("short.bin", scene.buffer().substr(1));
  scene.json["buffers"][0]["uri"] = "short.bin";
  const Result<PolygonSoup> cut = import_mesh(folder.write("square.gltf", scene.json.dump()));
  REQUIRE_FALSE(cut);
  CHECK(cut.error().message.ends_with(
      "square.gltf: truncated: buffers[0].byteLength promises 72 bytes, there are 71; fetch or export the file again"));
}

TEST_CASE("referenced files that are missing, elsewhere or no regular files are refused by name") {
  const Folder folder;
  GltfScene scene = square();
  const auto message = [&](const std::string& uri) {
    scene.json["buffers"] = {{{"byteLength", 72}, {"uri", uri}}};
    const Result<PolygonSoup> soup = import_mesh(folder.write("a.gltf", scene.json.dump()));
    REQUIRE_FALSE(soup);
    CHECK(soup.error().exit_code == 3);
    return soup.error().message;
  };
  CHECK(
      message("gone.bin")
          .ends_with(
              "a.gltf: buffers[0].uri: the file 'gone.bin' is missing; put it into the folder of this one, or export as GLB"));
  CHECK(message("deep%20er").find("the file 'deep%20er' is missing") != std::string::npos);
  for (const char* uri : {"../a.gltf", "deep er/../../a.bin", "/etc/hostname", "http://x.org/a.bin", "file:///etc/hostname",
                          "C:a.bin", "%2E%2E/a.bin", "%2Fetc/hostname", "a%2", "a%zz", "", "..%5Ca.bin", "a%00.bin"}) {
    INFO(uri);
    CHECK(message(uri).find("is no file in or beneath the folder of this one") != std::string::npos);
  }
  for (const char* uri : {"data:;base64,A", "data:;base64,A*==", "data:no-comma", "data:,%4"}) {
    INFO(uri);
    CHECK(message(uri).find("buffers[0].uri: its data is damaged") != std::string::npos);
  }
}

TEST_CASE("invalid Draco data is refused with its primitive") {
  std::string glb = write_glb_draco(import_text(square().text()));
  const std::size_t at = glb.rfind("DRACO");
  glb[at] = 'X';
  CHECK(refusal(glb).starts_with("mesh: meshes[0].primitives[0]: its Draco data is not Draco data that libdraco reads: "));
  glb[at] = 'D';
  CHECK(import_text(glb).face_count() == 2);
}
