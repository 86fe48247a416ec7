// SPDX-License-Identifier: Apache-2.0
// A material library of OBJ, with an image beside it: the bytes are the library, the mesh names two materials and has texture
// coordinates. Run: fdcg_fuzz_import_mtl -dict=tests/fuzz/import_mtl.dict -max_len=1024 FOLDER testdata/fuzz/import_mtl
#include <filesystem>
#include <fstream>
#include <string>

#include "fuzz_import.hpp"

namespace {

constexpr std::string_view kMesh =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 3/3 2/2\nusemtl b\nf 1/1 2/2 "
    "4/3\n";
// 2 x 1 texels of 8 bits, black and white
constexpr unsigned char kImage[] = {0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48,
                                    0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
                                    0x00, 0xD1, 0x49, 0x20, 0x56, 0x00, 0x00, 0x00, 0x0B, 0x49, 0x44, 0x41, 0x54, 0x78,
                                    0xDA, 0x63, 0x60, 0xF8, 0x0F, 0x00, 0x01, 0x02, 0x01, 0x00, 0xD1, 0x1A, 0xCB, 0x8F,
                                    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

void write(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// With the mesh and an image in it, removed at the end.
struct Folder {
  std::filesystem::path path;
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "fdcg-fuzz-XXXXXX").string();
    fdcg::bake::require(mkdtemp(name.data()) != nullptr, "a folder");
    path = name;
    write(path / "a.obj", kMesh);
    write(path / "a.png", {reinterpret_cast<const char*>(kImage), sizeof kImage});
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace fdcg::bake;
  static const Folder folder;
  write(folder.path / "a.mtl", {reinterpret_cast<const char*>(data), size});
  ImportOptions looking{Format::obj, {}};
  looking.appearance = true;
  looking.heights = size % 4 == 0 ? "" : "file";
  const Result<PolygonSoup> seen = import_mesh(folder.path / "a.obj", looking);
  if (seen) {
    require_sound(*seen);
    require_sound_look(*seen, true);
    require(seen->other_files.size() <= 3, "no file but the library and its image is read");
    for (const std::string& file : seen->other_files)
      require(std::filesystem::path(file).parent_path() == folder.path, "nothing beside the folder is read");
  } else {
    require(!looking.heights.empty(), "a library without images refuses nothing");
    require(seen.error().exit_code == 3 && seen.error().message.find('\n') == std::string::npos, "a refusal is one line");
    require(seen.error().message.size() < 4 * size + 1000, "a refusal is short");
  }
  return 0;
}
