// SPDX-License-Identifier: Apache-2.0
// The bodies and ways on which two builds are compared (against.py): writes a body's mesh and the ways of a hand over it.
//   fdcg_against_ways BODY TICKS FOLDER   BODY: 12, 70k, 1M or 3M faces
// FOLDER/mesh.ply, and for each speed FOLDER/SPEED.way: three doubles a tick.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "bench_graph.hpp"

using namespace fdcg::test;

namespace {

constexpr double kDepth_m = 1e-3, kTick_s = 1e-3;
constexpr const char* kSpeeds_m_per_s[] = {"0.02", "0.05", "0.1", "0.2", "0.5", "1"};

struct BodyCase {
  const char* name;
  Body body;
  int parts;
};
constexpr BodyCase kBodies[] = {
    {"12", Body::cube, 0}, {"70k", Body::sphere, 59}, {"1M", Body::sphere, 224}, {"3M", Body::sphere, 387}};

template <class Number>
void put(std::ofstream& file, Number number) {
  file.write(reinterpret_cast<const char*>(&number), sizeof number);
}

void write_mesh(const fdcg::bake::PolygonSoup& soup, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << soup.points.size()
       << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << soup.face_count()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& point : soup.points)
    put(file, point.x), put(file, point.y), put(file, point.z);
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    put(file, std::uint8_t{3});
    for (std::size_t k = 0; k < 3; ++k)
      put(file, static_cast<std::int32_t>(soup.corners[soup.face_first[f] + k]));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int ticks = argc == 4 ? std::atoi(argv[2]) : 0;
  for (const BodyCase& body : kBodies) {
    if (ticks <= 0 || std::strcmp(argv[1], body.name) != 0) continue;
    const std::string folder = std::string(argv[3]) + "/";
    write_mesh(make_body(body.body, body.parts), folder + "mesh.ply");
    const Surface surface(body.body, body.parts);
    for (const char* const speed : kSpeeds_m_per_s) {
      std::ofstream file(folder + speed + ".way", std::ios::binary);
      for (const Point& hip : slide(surface, std::atof(speed) * kTick_s, kDepth_m, ticks))
        for (const double x : hip)
          put(file, x);
      if (!file.flush()) return 3;
    }
    return 0;
  }
  std::fprintf(stderr, "usage: fdcg_against_ways BODY TICKS FOLDER; BODY is 12, 70k, 1M or 3M\n");
  return 2;
}
