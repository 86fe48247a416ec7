// SPDX-License-Identifier: Apache-2.0
// Shared by the readers of the mesh formats: filling the soup, its limits, and refusing a file.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "fdcg/bake.hpp"
#include "import/printed_precision.hpp"
#include "import/text_scanner.hpp"

namespace fdcg::bake {

// A mesh file to read. The referenced objects outlive the reader.
struct MeshText {
  std::string_view bytes;
  const std::string& name;
  const Progress& progress;
  const std::filesystem::path* file = nullptr;  // where the bytes are from; null: from memory
  bool wants_normals = false;                   // ImportOptions::normals
  bool wants_appearance = false;                // ImportOptions::appearance
  bool wants_heights = false;                   // ImportOptions::heights is "file"
  bool wants_haptics = false;                   // ImportOptions::haptic_materials
};

// One reader per format. Each fails with exit code 3 and one line; refusing a soup without faces is left to the caller. They
// set relative_quantum only where it is known from more than the points, and leave sha256 empty.
Result<PolygonSoup> read_off(const MeshText& input);
Result<PolygonSoup> read_obj(const MeshText& input);
Result<PolygonSoup> read_ply(const MeshText& input);
Result<PolygonSoup> read_stl(const MeshText& input);
Result<PolygonSoup> read_gltf(const MeshText& input);
Result<PolygonSoup> read_drc(const MeshText& input);
Result<PolygonSoup> read_dae(const MeshText& input);
Result<PolygonSoup> read_3mf(const MeshText& input);
Result<PolygonSoup> read_vtk(const MeshText& input);  // also XML
Result<PolygonSoup> read_vtp(const MeshText& input);
Result<PolygonSoup> read_x3d(const MeshText& input);

// Detection of formats by content.
bool is_off_keyword(std::string_view word);  // OFF, COFF, STCNOFF, 4OFF, ...
bool is_gltf_json(std::string_view bytes);   // an object that has an "asset"
bool is_glb(std::string_view bytes);
// The name of an XML text's first element, without prefix, in UTF-8 or UTF-16; empty: it is no XML.
std::string xml_root_name(std::string_view bytes);
bool has_binary_stl_size(std::string_view bytes);  // 84 + 50 n, with n where the format has it

// The message "`name`: `what`", on one line whatever the name contains. A remedy follows in `what` after a semicolon; else the
// usual one is appended.
Failure refuse(const std::string& name, const std::string& what, const char* rule = "unreadable");

// A name out of a file, for reports: control characters as '?', cut after some 48 bytes between two characters.
std::string readable_name(std::string_view name);

// Four bytes, the lowest first.
inline std::uint32_t load_u32(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i)
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

inline constexpr std::uint32_t kMaxFaceCorners = 65'536;
// Corner slots are numbered with 32 bits, of which the later stages keep the last few values for themselves.
inline constexpr std::size_t kMaxCorners = 0xFFFFFF00u;
inline constexpr std::size_t kMaxPoints = 0xFFFFFF00u;

// Collects the material of each run of consecutive faces.
class MaterialList {
 public:
  // The faces from the soup's next one on. Names with control characters are cleaned. Returns false where it is one too many.
  bool begin(PolygonSoup& soup, std::string_view name);
  // To be called when all faces are there.
  void finish(PolygonSoup& soup);

 private:
  void fill(PolygonSoup& soup) const;  // the faces since the last call have the material at hand
  std::map<std::string, std::uint16_t, std::less<>> index_of_;
  std::uint16_t current_ = PolygonSoup::kNoMaterial;
};

// Base of the readers. Their steps return false after fail(), which keeps the reason.
class SoupReader {
 protected:
  SoupReader(const MeshText& input, Format format) : input_(input) {
    soup_.name = input.name;
    soup_.format = format;
    soup_.face_first.push_back(0);
  }

  bool fail(const std::string& what) {
    failure_ = refuse(input_.name, what);
    return false;
  }
  bool fail_at_line(std::uint32_t line, const std::string& what) { return fail("line " + std::to_string(line) + ": " + what); }

  // Completes the face whose corners were pushed last.
  bool close_face() {
    const std::size_t count = soup_.corners.size() - soup_.face_first.back();
    if (count > kMaxFaceCorners) return fail_big_face(count);
    if (soup_.corners.size() > kMaxCorners) return fail("holds more than 4,294,967,040 face corners; cut the mesh into parts");
    soup_.face_first.push_back(static_cast<std::uint32_t>(soup_.corners.size()));
    return true;
  }
  bool fail_big_face(std::uint64_t count);

  // Counts what the file holds beside faces. `what` is plural.
  void ignore(std::string_view what, std::uint64_t count = 1);

  // The faces from the next one on are a part of this name, until the next call. To be called right before that face's corners,
  // unless takes_no_parts(): a file that changes parts all the time ends with one that takes the rest, which is said in
  // `ignored`, so that names stay a small multiple of the file.
  void begin_part(std::string name);
  [[nodiscard]] bool takes_no_parts() {
    if (has_further_parts_) ignore("further parts");
    return has_further_parts_;
  }

  // The faces from the next one on are of this material, until the next call; an empty name is none.
  void set_material(std::string_view name);

  // Reports progress to the caller, at most a hundred times.
  void advance(std::size_t offset) {
    if (offset >= next_report_) report(offset);
  }

  Result<PolygonSoup> result(bool is_read) {
    if (!is_read) return std::move(failure_);
    materials_.finish(soup_);
    return std::move(soup_);
  }

  const MeshText& input_;
  PolygonSoup soup_;

 private:
  void report(std::size_t offset);

  MaterialList materials_;
  Failure failure_;
  std::size_t next_report_ = 0;
  bool has_further_parts_ = false;
};

// For the text formats: a scanner, and the precision of the coordinates as printed.
class TextSoupReader : public SoupReader {
 protected:
  TextSoupReader(const MeshText& input, Format format, TextScanner::Syntax syntax)
      : SoupReader(input, format), scan_(input.bytes, syntax) {
    soup_.is_text = true;
  }

  bool fail_here(const std::string& what) { return fail_at_line(scan_.line(), what); }

  // Reads a coordinate at the cursor, and records its number of decimals.
  bool read_coordinate(double& value) {
    if (!scan_.read_real(value)) return false;
    precision_.note(value, printed(scan_));
    return true;
  }

  // Sets both quanta of the soup, when all points are there: as the numbers were printed, or those of floats where
  // `are_floats`.
  void set_quanta(bool are_floats = false);

  // "'x' is not a number", of the token at the cursor, with the remedy where there is one.
  [[nodiscard]] std::string not_a_number() const;

  TextScanner scan_;

 private:
  PrintedPrecision precision_;
};

}  // namespace fdcg::bake
