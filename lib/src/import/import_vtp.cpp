// SPDX-License-Identifier: Apache-2.0
// VTK polydata in XML (.vtp).
#include <array>
#include <string>
#include <vector>

#include "import/scene_soup.hpp"
#include "import/soup_reader.hpp"
#include "import/vtp_arrays.hpp"
#include "import/xml_file.hpp"

namespace fdcg::bake {
namespace {

using xml::Node;

class VtpReader {
 public:
  VtpReader(const MeshText& input, PolygonSoup& soup)
      : arrays_(input.bytes), file_(arrays_.file()), scene_(soup, input.bytes.size()) {}

  void read() {
    const Node root = file_.root();
    if (xml::attribute(root, "type") != "PolyData")
      file_.fail(root, "is of type '" + readable_name(xml::attribute(root, "type")) + "' and no PolyData; extract its surface");
    const Node data = xml::child(root, "PolyData");
    for (Node piece = xml::child(data, "Piece"); piece; piece = xml::next(piece))
      read_piece(piece);
    scene_.finish();
  }

 private:
  void read_piece(const Node& piece) {
    scene_.charge_node();
    const PrintedPoints points = read_points(piece);
    count_unpacked();
    first_ = scene_.add_points(points, nullptr);
    points_ = points.points.size();
    read_cells(piece, "Polys", false);
    read_cells(piece, "Strips", true);
    scene_.ignore("line elements", file_.count(piece, "NumberOfLines", 0));
    scene_.ignore("vertex elements", file_.count(piece, "NumberOfVerts", 0));
  }

  // What was unpacked may be shown.
  void count_unpacked() {
    scene_.grow_bytes(arrays_.unpacked_bytes() - unpacked_);
    unpacked_ = arrays_.unpacked_bytes();
  }

  // The array of this name, or the first where none is asked for. Empty: there is none.
  static Node array_of(const Node& parent, std::string_view name) {
    Node array = xml::child(parent, "DataArray");
    while (array && !name.empty() && xml::attribute(array, "Name") != name)
      array = xml::next(array);
    return array;
  }

  PrintedPoints read_points(const Node& piece) {
    PrintedPoints result;
    const Node array = array_of(xml::child(piece, "Points"), "");
    const std::uint64_t promised = file_.count(piece, "NumberOfPoints", 0);
    if (!array && promised == 0) return result;
    std::array<double, 3> xyz{};
    std::size_t at = 0;
    const std::uint64_t there = arrays_.for_each_real(array, [&](double value, const Printed& number) {
      result.precision.note(value, number);
      xyz[at++] = value;
      if (at < 3) return;
      result.points.push_back({xyz[0], xyz[1], xyz[2]});
      at = 0;
    });
    if (promised > kMaxPoints || there != 3 * promised) {
      file_.fail(array ? array : piece, "holds " + std::to_string(there) + " coordinates, and its piece promises " +
                                            std::to_string(promised) + " points; fetch or export the file again");
    }
    return result;
  }

  void read_cells(const Node& piece, const char* kind, bool is_strip) {
    const Node cells = xml::child(piece, kind), corner_array = array_of(cells, "connectivity"),
               end_array = array_of(cells, "offsets");
    if (!cells || (!corner_array && !end_array)) return;
    if (!corner_array || !end_array) file_.fail(cells, "needs the arrays 'connectivity' and 'offsets'; export the file again");
    std::vector<std::uint32_t> corners;
    arrays_.for_each_whole(corner_array, [&](std::int64_t value) {
      const bool is_known = value >= 0 && value < static_cast<std::int64_t>(kMaxPoints);
      corners.push_back(is_known ? static_cast<std::uint32_t>(value) : PolygonSoup::kInvalidVertex);
    });
    count_unpacked();
    std::uint64_t begin = 0, cell = 0;
    arrays_.for_each_whole(end_array, [&](std::int64_t value) {
      const auto end = static_cast<std::uint64_t>(value);
      if (value < 0 || end < begin || end > corners.size() || end - begin > kMaxFaceCorners) {
        file_.fail(end_array, "ends cell " + std::to_string(cell) + " at " + std::to_string(value) + "; it must be from " +
                                  std::to_string(begin) + " to " + std::to_string(corners.size()) + ", and " +
                                  std::to_string(kMaxFaceCorners) + " corners on at most");
      }
      const std::span<const std::uint32_t> own(corners.data() + begin, static_cast<std::size_t>(end - begin));
      if (is_strip) {
        add_strip(own);
      } else {
        scene_.add_face(own, first_, points_, false);
      }
      begin = end;
      ++cell;
    });
    if (begin != corners.size()) {
      file_.fail(corner_array, "holds " + std::to_string(corners.size()) + " corners, and the offsets end at " +
                                   std::to_string(begin) + "; fetch or export the file again");
    }
  }

  void add_strip(std::span<const std::uint32_t> strip) {
    if (strip.size() < 3) scene_.ignore("strips of fewer than three vertices");
    for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
      const std::array<std::uint32_t, 3> face = {strip[i], strip[i % 2 == 1 ? i + 2 : i + 1],
                                                 strip[i % 2 == 1 ? i + 1 : i + 2]};
      if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) {
        scene_.ignore("strip joints");
      } else {
        scene_.add_face(face, first_, points_, false);
      }
    }
  }

  vtp::Arrays arrays_;
  const xml::File& file_;
  SceneSoup scene_;
  std::size_t unpacked_ = 0;  // bytes of arrays_ that scene_ knows of
  std::uint32_t first_ = 0;   // point of the piece
  std::size_t points_ = 0;    // of the piece
};

}  // namespace

Result<PolygonSoup> read_vtp(const MeshText& input) {
  PolygonSoup soup;
  soup.name = input.name;
  soup.format = Format::vtk;
  soup.face_first.push_back(0);
  try {
    VtpReader(input, soup).read();
  } catch (const xml::Refusal& refusal) {
    return refuse(input.name, refusal.message, "unreadable");
  }
  return soup;
}

}  // namespace fdcg::bake
