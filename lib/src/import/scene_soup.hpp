// SPDX-License-Identifier: Apache-2.0
// A soup out of a scene whose nodes may show a mesh several times, each time in another place (COLLADA, 3MF, X3D): limits,
// transforms, parts, materials, and the precision of coordinates that were printed as decimals.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/placing.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {

// Points as a text prints them, with how precisely.
struct PrintedPoints {
  std::vector<Vec3> points;
  PrintedPrecision precision;
};

// Throws json::Refusal where a limit is passed.
class SceneSoup {
 public:
  // A scene may hold 1024 points, and face corners, and 16 for each of `bytes`, all that it is read from; and 1024 nodes and
  // one for each four bytes.
  SceneSoup(PolygonSoup& soup, std::size_t bytes) : soup_(soup), bytes_(bytes) {}
  void grow_bytes(std::size_t more) { bytes_ += more; }

  void charge_node() { charge(nodes_, 1); }
  void charge_numbers(std::uint64_t count) { charge(numbers_, count); }  // read for points

  // Points at their place in the scene; null: as they are. Returns the number of the first.
  std::uint32_t add_points(const PrintedPoints& points, const Matrix* world);

  // The faces from the next one on, until the next call. A part without faces leaves no trace.
  void begin_part(const std::string& name, std::string_view material, std::uint32_t first_point);
  void set_material(std::string_view material);  // within a part; of the faces from the next one on

  // A face whose corners count from 0, or are invalid; `points`: how many there are from `first_point` on. A face of a mirrored
  // node is turned.
  void add_face(std::span<const std::uint32_t> corners, std::uint32_t first_point, std::size_t points, bool is_mirrored);

  // Counts what is left out. `what` is plural.
  void ignore(const std::string& what, std::uint64_t count = 1);

  // When all is there: quanta, materials, what was left out.
  void finish();

 private:
  struct Budget {
    const char* what;
    std::uint64_t cost;  // elements, of each
    std::uint64_t most;  // that the soup can number
    std::uint64_t used = 0;
  };
  void charge(Budget& budget, std::uint64_t more) const;
  void end_part();

  PolygonSoup& soup_;
  std::size_t bytes_;
  Budget points_{"points", 1, kMaxPoints}, corners_{"face corners", 1, kMaxCorners};
  Budget nodes_{"nodes", 64, kMaxCorners}, numbers_{"numbers", 1, std::uint64_t{1} << 40};
  std::map<std::string, std::uint64_t> ignored_;
  Rounding rounding_;
  bool has_floats_ = false;  // points that are not transformed
  MaterialList materials_;
};

}  // namespace fdcg::bake
