// SPDX-License-Identifier: Apache-2.0
// Bakes the graphs that step_hash.c steps on, as C arrays. Usage: hash_graphs FOLDER writes graphs.h and graphs.c.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "meshes.hpp"

using namespace fdcg::test;
namespace bake = fdcg::bake;

namespace {

struct Choice {
  PolygonSoup soup;
  bake::CompileOptions options;
};

// Small, but of every kind: convex and concave edges, saddles, a busy corner with its tree, needles, open borders, faces that
// are not exactly planar, far from the origin, tiny, planes stored and derived, with and without a hierarchy, with
// normals at its corners.
std::vector<Choice> choices() {
  bake::CompileOptions stored, derived, bare, millimetres, shaded;
  derived.store_planes = false;
  bare.without = {"hierarchy", "source-map"};
  millimetres.metres_per_unit = 0.001;
  shaded.normals = bake::Normals::faces;
  const auto turned = [](const PolygonSoup& soup, double scale, double far) {
    return transformed(soup, random_rotation(7), scale, {far, -far, far / 2});
  };
  return {{cube(), stored},
          {turned(corner_pit(), 1, 0), derived},
          {turned(saddle_block(), 1, 1e4), bare},
          {turned(cone_pit(96), 20, 300), millimetres},
          {cone(200), derived},
          {turned(star_sphere(2, 0.3, 3), 1e-3, 0), stored},
          {turned(spiky_sphere(1, 1.5, 5), 1, 0), stored},
          {needle_strip(120, 0.02, 11), stored},
          {bumpy_patch(6, 0.1, 13), derived},
          {turned(star_sphere(2, 0.3, 3), 1, 0), shaded}};
}

void write_array(std::ostream& out, const std::string& name, std::span<const std::byte> bytes) {
  out << "FDCG_ALIGNED const unsigned char " << name << "[" << bytes.size() << "] = {";
  for (std::size_t i = 0; i < bytes.size(); ++i)
    out << (i % 32 == 0 ? "\n" : "") << std::to_integer<int>(bytes[i]) << ',';
  out << "};\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: hash_graphs FOLDER\n";
    return 2;
  }
  const std::string folder = argv[1];
  std::ofstream arrays(folder + "/graphs.c"), header(folder + "/graphs.h");
  arrays << "#include \"graphs.h\"\n#define FDCG_ALIGNED _Alignas(64)\n";
  std::string table;
  int count = 0;
  header << "#include <stdint.h>\n";
  for (Choice& choice : choices()) {
    for (const auto precision : {bake::Precision::f32, bake::Precision::f64}) {
      choice.options.precision = precision;
      const auto compiled = bake::compile(choice.soup, choice.options);
      if (!compiled || compiled->bytes.empty()) {
        std::cerr << choice.soup.name << ": "
                  << (compiled ? bake::report_text(compiled->report, false) : compiled.error().message) << "\n";
        return 1;
      }
      const std::string name = "graph_" + std::to_string(count++);
      write_array(arrays, name, compiled->bytes);
      header << "extern const unsigned char " << name << "[" << compiled->bytes.size() << "];\n";
      table += "  {\"" + choice.soup.name + "\", " + name + ", sizeof " + name + "},\n";
    }
  }
  header << "static const struct {\n  const char* name;\n  const unsigned char* bytes;\n  uint64_t size;\n} graphs[] = {\n"
         << table << "};\n";
  return arrays.flush() && header.flush() ? 0 : 1;
}
