// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of fuzz_load anew, after a change of the format: fdcg_fuzz_load_seeds testdata/fuzz/load
#include <cstdio>
#include <fstream>
#include <string>

#include "fdcg/bake.hpp"
#include "meshes.hpp"

using namespace fdcg;
using namespace fdcg::test;

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: %s DIRECTORY\n", arguments[0]);
    return 2;
  }
  const std::string directory = arguments[1];
  const auto write = [&](const char* name, const bake::PolygonSoup& soup, bake::Precision precision, bool store_planes,
                         bool visual = false) {
    bake::CompileOptions options;
    options.visual = visual;
    options.heights = !soup.appearance.images.empty();
    options.precision = precision;
    options.store_planes = store_planes;
    options.without = {"info"};
    if (!store_planes) options.without.insert("hierarchy");
    const auto compiled = bake::compile(soup, options);
    if (!compiled) return false;
    std::ofstream out(directory + "/" + name, std::ios::binary);
    out.write(reinterpret_cast<const char*>(compiled->bytes.data()), static_cast<std::streamsize>(compiled->bytes.size()));
    return out.good();
  };
  constexpr auto f64 = bake::Precision::f64, f32 = bake::Precision::f32;
  const auto with_heights = [](bake::PolygonSoup soup, bake::HeightImage::Wrap wrap) {
    bake::HeightImage image;
    image.name = "steps";
    image.width = 5, image.height = 3, image.range = 0.01;
    for (std::uint32_t i = 0; i < 15; ++i)
      image.values.push_back(static_cast<float>(i * 7 % 15) / 15);
    image.wrap = {wrap, wrap};
    soup.appearance.images = {image};
    soup.appearance.all_heights = 0;
    for (const std::uint32_t corner : soup.corners)
      soup.appearance.uv.push_back({static_cast<float>(soup.points[corner].x), static_cast<float>(soup.points[corner].y)});
    return soup;
  };
  const auto inexact = rounded_to_float(transformed(grid_box(2, 2, 1, {1, 1, 0.5}), random_rotation(3)));
  const bool is_written =
      write("busy-corner-f64", cone(40), f64, true) && write("busy-corner-f32", cone(40), f32, true) &&
      write("inexact-f64", inexact, f64, false) && write("inexact-f32", inexact, f32, true) &&
      write("l-f64", l_prism(), f64, true) && write("l-f32-derived", l_prism(), f32, false) &&
      write("open-patch-f64", plane_grid(2, 2), f64, true) && write("open-patch-f32", plane_grid(2, 2), f32, true) &&
      write("triangles-f64", star_sphere(1, 0.1, 1), f64, true) && write("triangles-f32", star_sphere(1, 0.1, 1), f32, true) &&
      write("open-triangles-f64", bumpy_patch(3, 0.05, 1), f64, true) &&
      write("open-triangles-f32", bumpy_patch(3, 0.05, 1), f32, true) &&
      write("heights-f64", with_heights(l_prism(), bake::HeightImage::Wrap::mirror), f64, true) &&
      write("heights-f32", with_heights(plane_grid(2, 2), bake::HeightImage::Wrap::repeat), f32, false) &&
      write("visual-f64", l_prism(), f64, true, true) && write("visual-f32", plane_grid(2, 2), f32, false, true);
  return is_written ? 0 : 4;
}
