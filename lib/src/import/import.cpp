// SPDX-License-Identifier: Apache-2.0
// Mesh file -> polygon soup: detects the format, reads the file and determines the precision of its coordinates.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/file_bytes.hpp"
#include "base/sha256.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/results.hpp"
#include "import/height_image.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

bool is_obj_keyword(std::string_view word) {
  constexpr std::array kKeywords = {"v", "vt", "vn", "vp",     "f",      "fo",     "l",  "p",
                                    "o", "g",  "s",  "mtllib", "usemtl", "cstype", "deg"};
  return std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end();
}

// Formats that are recognised by content but not read: the first bytes, the name, and the remedy.
struct ForeignKind {
  std::string_view start, remedy;
};
constexpr ForeignKind kForeignKinds[] = {
    {"\x1F\x8B", "is compressed with gzip; decompress it first (gunzip)"},
    {"BZh", "is compressed with bzip2; decompress it first (bunzip2)"},
    {"\xFD"
     "7zXZ",
     "is compressed with xz; decompress it first (unxz)"},
    {"\x28\xB5\x2F\xFD", "is compressed with zstd; decompress it first (unzstd)"},
    {"7z\xBC\xAF\x27\x1C", "is a 7z archive; unpack the mesh first"},
    {"Kaydara FBX Binary",
     "is FBX, which is not read; in Blender import it and export glTF, or convert it with 'assimp export'"},
    {"; FBX ", "is FBX text, which is not read; in Blender import it and export glTF, or convert it with 'assimp export'"},
    {"BLENDER", "is a Blender file, which is not read; in Blender export glTF, OBJ or PLY"},
    {"PXR-USDC", "is USD, which is not read; in Blender import it and export glTF, or OBJ or PLY"},
    {"#usda ", "is USD text, which is not read; in Blender import it and export glTF, or OBJ or PLY"},
    {"glTF\x01", "is GLB version 1; version 2 is read: convert the file"},
    {"version https://git-lfs.github.com/spec/", "is a Git LFS pointer and not the mesh itself; fetch it with 'git lfs pull'"},
    {"ISO-10303-21;",
     "is a STEP file, which holds exact surfaces and no mesh; in a CAD program (FreeCAD, gmsh) mesh it and export 3MF, STL or "
     "OBJ"},
};

const ForeignKind* foreign_kind(std::string_view bytes) {
  if (has_binary_stl_size(bytes)) return nullptr;  // which may start with anything
  const auto* const kind = std::find_if(std::begin(kForeignKinds), std::end(kForeignKinds),
                                        [bytes](const ForeignKind& k) { return bytes.starts_with(k.start); });
  return kind == std::end(kForeignKinds) ? nullptr : kind;
}

// As of a download or a copy that was cut off. A binary STL's header may be zeros.
bool starts_with_zeros(std::string_view bytes) {
  constexpr std::size_t kLooked = 512;
  return bytes.substr(0, kLooked).find_first_not_of('\0') == std::string_view::npos && !has_binary_stl_size(bytes);
}

// What to do about an XML file of a kind that is not read.
std::string xml_remedy(const std::string& root) {
  if (root == "robot" || root == "sdf")
    return "is a description of a robot or a world, which names meshes and is none; give it to 'fdcg validate', or name a mesh";
  if (root == "model") return "is a 3MF model out of its package; name the .3mf file";
  return "is XML (or HTML) with the root <" + readable_name(root) +
         ">, no mesh format that is read; export it as COLLADA, 3MF, glTF, OBJ or PLY";
}

std::optional<Format> format_by_content(std::string_view bytes) {
  if (bytes.starts_with("DRACO")) return Format::drc;
  if (bytes.starts_with("PK\x03\x04") && !has_binary_stl_size(bytes)) return Format::threemf;
  if (bytes.starts_with("# vtk DataFile")) return Format::vtk;
  const std::string root = xml_root_name(bytes);
  if (root == "COLLADA") return Format::dae;
  if (root == "VTKFile") return Format::vtk;
  if (root == "X3D") return Format::x3d;
  if (is_glb(bytes) || is_gltf_json(bytes)) return Format::gltf;
  if (has_binary_stl_size(bytes)) return Format::stl;
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::string_view text = bytes.substr(bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);
  if (text.size() > 3 && text.starts_with("ply") && kBlanks.find(text[3]) != std::string_view::npos) return Format::ply;
  TextScanner scan(bytes, {.hash_comments = true});
  if (!scan.find_token()) return std::nullopt;
  const std::string_view word = scan.read_word();
  if (is_off_keyword(word)) return Format::off;
  if (is_obj_keyword(word)) return Format::obj;
  if (word.size() == 5 && lower_case(word) == "solid") return Format::stl;
  return std::nullopt;
}

std::optional<Format> format_by_ending(const std::string& name) {
  const std::string ending = lower_case(std::filesystem::path(name).extension().string());
  constexpr std::pair<std::string_view, Format> kEndings[] = {
      {".off", Format::off},     {".obj", Format::obj},     {".ply", Format::ply}, {".stl", Format::stl},
      {".gltf", Format::gltf},   {".glb", Format::gltf},    {".drc", Format::drc}, {".dae", Format::dae},
      {".zae", Format::threemf}, {".3mf", Format::threemf}, {".vtk", Format::vtk}, {".vtp", Format::vtk},
      {".x3d", Format::x3d}};
  for (const auto& [known, format] : kEndings)
    if (ending == known) return format;
  return std::nullopt;
}

Result<PolygonSoup> read_as(Format format, const MeshText& input) {
  constexpr Result<PolygonSoup> (*kReaders[])(const MeshText&) = {read_off, read_obj, read_ply, read_stl, read_gltf,
                                                                  read_drc, read_dae, read_3mf, read_vtk, read_x3d};
  return kReaders[static_cast<int>(format)](input);
}

bool is_float(double c) {
  if (!std::isfinite(c)) return true;  // tells nothing about the precision
  return std::fabs(c) <= FLT_MAX && static_cast<double>(static_cast<float>(c)) == c;
}

double relative_quantum(const std::vector<Vec3>& points) {
  const bool all_floats =
      std::all_of(points.begin(), points.end(), [](const Vec3& p) { return is_float(p.x) && is_float(p.y) && is_float(p.z); });
  return all_floats ? 0x1p-24 : 0x1p-53;
}

// `file`: where the bytes are from; null: from memory. `sha256`: their hash; empty: not known.
Result<PolygonSoup> import_bytes(std::string_view bytes, const std::string& name, const ImportOptions& options,
                                 const std::filesystem::path* file, const std::string& sha256) {
  if (bytes.empty()) return refuse(name, "is empty; export the mesh again", "empty-mesh");
  if (starts_with_zeros(bytes)) return refuse(name, "starts with zeros alone, so that it is no mesh; fetch or export it again");
  if (const ForeignKind* const kind = foreign_kind(bytes)) return refuse(name, std::string(kind->remedy));
  std::optional<Format> format = options.format;
  if (!format) format = format_by_content(bytes);
  const bool is_xml = format == Format::dae || format == Format::vtk || format == Format::x3d;
  if (!is_xml && (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")))
    return refuse(name, "is UTF-16 text; save it as UTF-8 or plain ASCII");
  if (!is_xml && !has_binary_stl_size(bytes)) {
    if (const std::string root = xml_root_name(bytes); !root.empty() || bytes.starts_with('<'))
      return refuse(name, xml_remedy(root));
    if (format != Format::threemf && bytes.starts_with("PK\x03\x04"))
      return refuse(name, "is a ZIP archive (3MF files are, too); unpack the mesh first, or leave out its format");
  }
  if (!format) format = format_by_ending(name);
  if (!format) {
    return refuse(
        name,
        "is of no known mesh format; OFF, OBJ, PLY, STL, glTF, GLB, Draco, COLLADA, 3MF, VTK and X3D are read: export it "
        "as one of them");
  }

  Sha256Task hash(sha256.empty() ? bytes : std::string_view());
  const bool has_own_heights = options.heights == kHeightsOfFile;
  Result<PolygonSoup> soup =
      read_as(*format, {bytes, name, options.progress, file, options.normals, options.appearance || options.haptic_materials,
                        has_own_heights, options.haptic_materials});
  if (!soup) return soup;
  if (!options.heights.empty() && !has_own_heights) {
    if (const auto failure = add_heights_for_all(options.heights, *soup)) return *failure;
  }
  if (soup->face_count() == 0) {
    return refuse(name, "holds no face, " + std::to_string(soup->points.size()) + " vertices; export the mesh with its faces",
                  "empty-mesh");
  }
  if (soup->relative_quantum == 0) soup->relative_quantum = relative_quantum(soup->points);
  soup->sha256 = sha256.empty() ? hash.finish() : sha256;
  if (soup->sha256.empty()) return Failure{4, name + ": OpenSSL computes no SHA-256", {}};
  if (options.progress) options.progress("import", 1.0);
  return soup;
}

Result<PolygonSoup> import_guarded(std::string_view bytes, const std::string& name, const ImportOptions& options,
                                   const std::filesystem::path* file, const std::string& sha256) {
  try {
    return import_bytes(bytes, name, options, file, sha256);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return refuse(
      name, "needs more memory than there is (" + std::to_string(bytes.size()) + " bytes of file); cut the mesh into parts");
}

}  // namespace

Result<PolygonSoup> import_mesh(const std::filesystem::path& path, const ImportOptions& options) {
  const Result<FileBytes> file = FileBytes::open(path);
  if (!file) return file.error();
  return import_guarded(file->bytes(), path.string(), options, &path, {});
}

Result<PolygonSoup> import_memory(std::string_view bytes, std::string name, const ImportOptions& options) {
  return import_guarded(bytes, name, options, nullptr, {});
}

Result<MeshFile> MeshFile::open(const std::filesystem::path& path) {
  Result<FileBytes> bytes = FileBytes::open(path);
  if (!bytes) return bytes.error();
  MeshFile file;
  file.path_ = path;
  file.bytes_ = std::make_shared<const FileBytes>(std::move(*bytes));
  file.sha256_ = sha256_of(file.bytes_->bytes());
  return file;
}

Result<PolygonSoup> MeshFile::import(const ImportOptions& options) const {
  return import_guarded(bytes_->bytes(), path_.string(), options, &path_, sha256_);
}

}  // namespace fdcg::bake
