// SPDX-License-Identifier: Apache-2.0
#include "mesh_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "drc_writer.hpp"
#include "gltf_writer.hpp"

namespace fdcg::test {
namespace {

using bake::PolygonSoup;
using bake::Vec3;

class Writer {
 public:
  Writer(const PolygonSoup& soup, bool comments) : soup_(soup), comments_(comments) {}

  MeshFile off() {
    end_line("OFF" + std::string(comments_ ? " # counts follow" : ""));
    end_line(std::to_string(soup_.points.size()) + " " + std::to_string(soup_.face_count()) + " 0");
    text_points("");
    text_faces("", true, 0);
    return file_;
  }

  MeshFile obj() {
    text_points("v ");
    text_faces("f", false, 1);
    return file_;
  }

  MeshFile ply(const std::string& format) {
    end_line("ply");
    end_line("format " + format + " 1.0");
    end_line("element vertex " + std::to_string(soup_.points.size()));
    for (const char* axis : {"x", "y", "z"})
      end_line("property " + std::string(format == "ascii" ? "double " : "float ") + axis);
    end_line("element face " + std::to_string(soup_.face_count()));
    end_line("property list uint int vertex_indices");
    end_line("end_header");
    if (format == "ascii") {
      comments_ = false;
      text_points("");
      text_faces("", true, 0);
    } else {
      const bool is_big = format == "binary_big_endian";
      for (const Vec3& p : soup_.points)
        put_point(p, is_big);
      for (std::size_t f = 0; f < soup_.face_count(); ++f) {
        put(soup_.face_first[f + 1] - soup_.face_first[f], is_big);
        for (std::uint32_t h = soup_.face_first[f]; h < soup_.face_first[f + 1]; ++h)
          put(index(h), is_big);
      }
    }
    return file_;
  }

  MeshFile stl_text() {
    end_line("solid seeded");
    for (std::size_t f = 0; f < soup_.face_count(); ++f) {
      file_.face_line.push_back(line_);
      end_line("facet normal 0 0 0");
      end_line("outer loop");
      for (std::uint32_t h = soup_.face_first[f]; h < soup_.face_first[f + 1]; ++h) {
        file_.point_line.push_back(line_);
        end_line("vertex " + text_of(soup_.points[soup_.corners[h]]));
      }
      end_line("endloop");
      end_line("endfacet");
    }
    end_line("endsolid seeded");
    return file_;
  }

  MeshFile stl_binary() {
    file_.bytes.assign(80, ' ');
    put(static_cast<std::uint32_t>(soup_.face_count()), false);
    for (std::size_t f = 0; f < soup_.face_count(); ++f) {
      put_point({}, false);
      for (std::uint32_t h = soup_.face_first[f]; h < soup_.face_first[f + 1]; ++h)
        put_point(soup_.points[soup_.corners[h]], false);
      file_.bytes.append(2, '\0');
    }
    return file_;
  }

 private:
  void end_line(const std::string& text) {
    file_.bytes += text;
    file_.bytes += '\n';
    ++line_;
  }

  // Shortest digits that read back as the same double.
  static std::string text_of(double x) {
    if (std::isnan(x)) return "nan";
    if (std::isinf(x)) return x < 0 ? "-inf" : "inf";
    char buffer[32];
    return {buffer, std::to_chars(std::begin(buffer), std::end(buffer), x).ptr};
  }
  static std::string text_of(const Vec3& p) { return text_of(p.x) + " " + text_of(p.y) + " " + text_of(p.z); }

  // Now and then, by the number of the line alone.
  void remark() {
    if (!comments_) return;
    if (line_ % 7 == 3) end_line("# line " + std::to_string(line_));
    if (line_ % 11 == 5) end_line("");
  }

  void text_points(const std::string& keyword) {
    for (const Vec3& p : soup_.points) {
      remark();
      file_.point_line.push_back(line_);
      end_line(keyword + text_of(p));
    }
  }

  void text_faces(const std::string& keyword, bool with_count, std::uint32_t first_index) {
    for (std::size_t f = 0; f < soup_.face_count(); ++f) {
      remark();
      file_.face_line.push_back(line_);
      std::string text = keyword;
      if (with_count) text += std::to_string(soup_.face_first[f + 1] - soup_.face_first[f]);
      for (std::uint32_t h = soup_.face_first[f]; h < soup_.face_first[f + 1]; ++h)
        text += " " + std::to_string(index(h) + first_index);
      end_line(text);
    }
  }

  [[nodiscard]] std::uint32_t index(std::uint32_t slot) const {
    const std::uint32_t corner = soup_.corners[slot];
    return corner == PolygonSoup::kInvalidVertex ? static_cast<std::uint32_t>(soup_.points.size()) + 7 : corner;
  }

  template <class T>
  void put(T value, bool is_big) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (is_big) std::reverse(std::begin(raw), std::end(raw));
    file_.bytes.append(raw, sizeof(T));
  }
  void put_point(const Vec3& p, bool is_big) {
    for (const double c : {p.x, p.y, p.z})
      put(static_cast<float>(c), is_big);
  }

  const PolygonSoup& soup_;
  bool comments_;
  MeshFile file_;
  std::uint32_t line_ = 1;
};

}  // namespace

const char* name_of(FileKind kind) {
  constexpr const char* kNames[] = {"off",
                                    "obj",
                                    "ply text",
                                    "ply little-endian",
                                    "ply big-endian",
                                    "stl text",
                                    "stl binary",
                                    "gltf",
                                    "glb",
                                    "glb with draco",
                                    "drc"};
  return kNames[static_cast<int>(kind)];
}

bool holds_polygons(FileKind kind) {
  return kind < FileKind::stl_text;
}
bool holds_vertices(FileKind kind) {
  return kind != FileKind::stl_text && kind != FileKind::stl_binary;
}
bool holds_bad_indices(FileKind kind) {
  return kind < FileKind::stl_text || kind == FileKind::gltf || kind == FileKind::glb;
}

MeshFile write_mesh(const bake::PolygonSoup& soup, FileKind kind, bool comments) {
  Writer writer(soup, comments);
  switch (kind) {
    case FileKind::off:
      return writer.off();
    case FileKind::obj:
      return writer.obj();
    case FileKind::ply_text:
      return writer.ply("ascii");
    case FileKind::ply_little:
    case FileKind::ply_big: {
      MeshFile file = writer.ply(kind == FileKind::ply_big ? "binary_big_endian" : "binary_little_endian");
      file.point_line.clear();
      file.face_line.clear();
      return file;
    }
    case FileKind::stl_text:
      return writer.stl_text();
    case FileKind::stl_binary:
      return writer.stl_binary();
    case FileKind::gltf:
      return {write_gltf(soup), {}, {}};
    case FileKind::glb:
      return {write_glb(soup), {}, {}};
    case FileKind::glb_draco:
      return {write_glb_draco(soup), {}, {}};
    case FileKind::drc:
      break;
  }
  return {write_drc(soup), {}, {}};
}

}  // namespace fdcg::test
