// SPDX-License-Identifier: Apache-2.0
#include "import/obj_appearance.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "base/file_bytes.hpp"
#include "import/beside.hpp"
#include "import/height_image.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kMostLibraries = 64;
constexpr std::string_view kBlanks = " \t";

}  // namespace

void ObjAppearance::add_colour(std::size_t point, const Colour& colour) {
  colours_.resize(point, Colour{1, 1, 1, 1});
  colours_.push_back(colour);
}

// One name with blanks in it, or several.
void ObjAppearance::add_libraries(std::string_view names) {
  if (names.empty() || add_library(std::string(names)) == Library::read) return;
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = std::min(names.find_first_of(kBlanks, at), names.size());
    if (end > at) note_unread(std::string(names.substr(at, end - at)));
    at = end + 1;
  }
}

void ObjAppearance::note_unread(const std::string& name) {
  const Library found = add_library(name);
  if (found == Library::read || file_ == nullptr) return;
  constexpr std::size_t kMostNotes = 16;
  if (unread_.size() >= kMostNotes) return;
  const std::string library = "its material library '" + readable_name(name) + "' ";
  unread_.push_back(
      found == Library::outside
          ? library +
                "was not read: it is not in the mesh's folder or beneath it; copy it there and name it without '..' or '/'"
      : found == Library::missing ? library + "is not there; put it beside the mesh, or remove the line mtllib"
                                  : library + "cannot be read; check its permissions, or that there are no more than 64");
}

ObjAppearance::Library ObjAppearance::add_library(const std::string& name) {
  if (libraries_.contains(name)) return Library::read;
  if (file_ == nullptr || libraries_.size() >= kMostLibraries) return Library::unreadable;
  if (!stays_beneath(name, name)) return Library::outside;
  const std::filesystem::path path = file_->parent_path() / name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return Library::missing;
  if (!lies_beneath(path, file_->parent_path())) return Library::outside;
  const Result<FileBytes> library = FileBytes::open(path);
  if (!library) return Library::unreadable;
  read_obj_materials(library->bytes(), std::filesystem::path(name).parent_path().string(), materials_);
  libraries_.insert(name);
  files_.push_back(path.string());
  return Library::read;
}

void ObjAppearance::add_corner(std::size_t corner, std::string_view more) {
  if (!more.starts_with('/')) return;
  std::int64_t number = 0;
  std::from_chars(more.data() + 1, more.data() + more.size(), number);  // of "//vn": none
  if (number < 0) number += static_cast<std::int64_t>(places_.size()) + 1;
  if (number <= 0) return;
  place_of_corner_.resize(corner, 0);
  place_of_corner_.push_back(number);
}

// Read once for materials that name it with the same options.
std::uint16_t ObjAppearance::image_of(const ObjMaterial& material, Appearance& look) {
  if (!wants_heights_ || material.heights.name.empty() || problem_) return LookMaterial::kNoImage;
  const std::string name = (std::filesystem::path(material.folder) / material.heights.name).string();
  const auto is_same = [&](const HeightImage& image) {
    return image.name == name && image.placing == material.heights.placing && image.range == material.heights.range &&
           image.wrap == material.heights.wrap;
  };
  const auto found = std::find_if(look.images.begin(), look.images.end(), is_same);
  if (found != look.images.end()) return static_cast<std::uint16_t>(found - look.images.begin());
  HeightImage image = material.heights;
  image.name = name;
  problem_ = read_height_image_beside(*file_, image, files_);
  if (problem_) return LookMaterial::kNoImage;
  look.images.push_back(std::move(image));
  return static_cast<std::uint16_t>(look.images.size() - 1);
}

std::optional<Failure> ObjAppearance::finish(PolygonSoup& soup) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  Appearance& look = soup.appearance;
  if (!place_of_corner_.empty() && !places_.empty()) {
    look.uv.resize(soup.corners.size(), {kNone, kNone});
    for (std::size_t i = 0; i < place_of_corner_.size(); ++i) {
      const std::int64_t number = place_of_corner_[i];
      if (number >= 1 && number <= static_cast<std::int64_t>(places_.size()))
        look.uv[i] = places_[static_cast<std::size_t>(number - 1)];
    }
  }
  if (!colours_.empty()) {
    look.colours.resize(soup.corners.size(), {1, 1, 1, 1});
    for (std::size_t i = 0; i < soup.corners.size(); ++i)
      if (soup.corners[i] < colours_.size()) look.colours[i] = colours_[soup.corners[i]];
  }
  look.face_material = soup.face_material;
  for (const std::string& name : soup.materials) {
    const auto found = materials_.find(name);
    const ObjMaterial material = found == materials_.end() ? ObjMaterial{} : found->second;
    look.materials.push_back({name, material.colour, image_of(material, look)});
  }
  soup.other_files = std::move(files_);
  soup.unread_files = std::move(unread_);
  return problem_;
}

}  // namespace fdcg::bake
