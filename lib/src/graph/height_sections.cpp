// SPDX-License-Identifier: Apache-2.0
#include "graph/height_sections.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/height_levels.hpp"

namespace fdcg::bake {
namespace {

double range_of(const HeightImage& image, const CompileOptions& options) {
  return options.height_range_m != 0 ? options.height_range_m : image.range * options.metres_per_unit;
}

}  // namespace

std::string missing_for_heights(const PolygonSoup& soup, const CompileOptions& options) {
  const Appearance& look = soup.appearance;
  if (!(std::fabs(options.height_range_m) <= 1)) return "the height range is not within -1 to 1 m";
  if (look.images.empty())
    return soup.name +
           ": names no image of heights that is not flat (map_bump, bump or disp of OBJ's mtllib, normalTexture of glTF); name "
           "one with --heights IMAGE";
  if (look.uv.empty() && look.height_uv.empty())
    return soup.name +
           ": holds no texture coordinates, which say where on the mesh an image lies (vt of OBJ, u v or s t of PLY, "
           "TEXCOORD_0 of glTF)";
  for (const HeightImage& image : look.images) {
    if (range_of(image, options) == 0)
      return image.name +
             ": nothing says how high white is above black; give it with --height-range METRES (or -bm of OBJ's "
             "map_bump, in units of the mesh)";
  }
  return {};
}

Result<HeightSections> make_height_sections(const PolygonSoup& soup, std::vector<fdcg_node_place> place_of_face,
                                            const CompileOptions& options, unsigned jobs) {
  constexpr std::uint64_t kMostTexels = FDCG_NONE - 1;
  constexpr double kLeastStep_m = 1e-15, kMostStep_m = 1;  // fdcg_get_heights
  const std::vector<HeightImage>& images = soup.appearance.images;
  std::vector<std::uint32_t> map_of(images.size(), FDCG_NONE);
  for (const fdcg_node_place& place : place_of_face)
    if (place.map != FDCG_NONE) map_of[place.map] = 0;
  HeightSections sections;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (map_of[i] == FDCG_NONE) continue;
    HeightLevels levels = height_levels(images[i], range_of(images[i], options), jobs);
    const double step_m = levels.map.metres_per_step;
    if (step_m == 0) return Failure{2, images[i].name + ": the image is of one height; leave it out", {}};
    if (!(step_m >= kLeastStep_m && step_m <= kMostStep_m))
      return Failure{2, images[i].name + ": its heights are out of the format's range; change --height-range", {}};
    if (sections.maps.size() >= FDCG_MAX_HEIGHT_MAPS || sections.texels.size() + levels.texels.size() > kMostTexels)
      return Failure{2, soup.name + ": has more images of heights than the format holds; leave some out", {}};
    map_of[i] = static_cast<std::uint32_t>(sections.maps.size());
    levels.map.first = static_cast<std::uint32_t>(sections.texels.size());
    sections.maps.push_back(levels.map);
    sections.texels.insert(sections.texels.end(), levels.texels.begin(), levels.texels.end());
  }
  if (sections.maps.empty())
    return Failure{2, soup.name + ": no face is on an image of heights; its materials or texture coordinates are missing", {}};
  for (fdcg_node_place& place : place_of_face)
    if (place.map != FDCG_NONE) place.map = map_of[place.map];
  sections.place_of_face = std::move(place_of_face);
  return sections;
}

}  // namespace fdcg::bake
