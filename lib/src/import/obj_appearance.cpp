// SPDX-License-Identifier: Apache-2.0
#include "import/obj_appearance.hpp"

#include <charconv>
#include <limits>
#include <utility>

#include "base/file_bytes.hpp"
#include "import/beside.hpp"

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
  if (names.empty() || add_library(std::string(names))) return;
  if (names.find_first_of(kBlanks) == std::string_view::npos) {
    ++missing_;
    return;
  }
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = std::min(names.find_first_of(kBlanks, at), names.size());
    if (end > at && !add_library(std::string(names.substr(at, end - at)))) ++missing_;
    at = end + 1;
  }
}

bool ObjAppearance::add_library(const std::string& name) {
  if (libraries_.contains(name)) return true;
  if (file_ == nullptr || libraries_.size() >= kMostLibraries || !stays_beneath(name, name)) return false;
  const std::filesystem::path path = file_->parent_path() / name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || !lies_beneath(path, file_->parent_path())) return false;
  const Result<FileBytes> library = FileBytes::open(path);
  if (!library) return false;
  read_obj_materials(library->bytes(), materials_);
  libraries_.insert(name);
  files_.push_back(path.string());
  return true;
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

void ObjAppearance::finish(PolygonSoup& soup) {
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
    look.materials.push_back({name, found == materials_.end() ? Colour{1, 1, 1, 1} : found->second});
  }
  soup.other_files = std::move(files_);
  if (missing_ > 0) soup.ignored.push_back({"material libraries that are not beneath the folder", missing_});
}

}  // namespace fdcg::bake
