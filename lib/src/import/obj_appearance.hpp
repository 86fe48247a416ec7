// SPDX-License-Identifier: Apache-2.0
// How an OBJ file looks: texture coordinates of its corners (vt), colours of its vertices, and its material libraries.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fdcg/bake.hpp"
#include "import/obj_materials.hpp"

namespace fdcg::bake {

class ObjAppearance {
 public:
  // `file`: where the OBJ is from; null: from memory, and no other file is read.
  ObjAppearance(const std::filesystem::path* file, bool wants_heights) : file_(file), wants_heights_(wants_heights) {}

  // Of a statement vt.
  void add_place(double u, double v) { places_.push_back({static_cast<float>(u), static_cast<float>(1 - v)}); }
  // Of the point with this number, in ascending order.
  void add_colour(std::size_t point, const Colour& colour);
  // What follows mtllib. Libraries that cannot be read, or are not beneath the folder, are named in the soup's unread_files.
  void add_libraries(std::string_view names);
  // Of a corner, right before it is added: "/vt" or "/vt/vn" after its vertex number, or nothing.
  void add_corner(std::size_t corner, std::string_view more);

  // When all is read. What is wrong with an image of heights; none: nothing.
  [[nodiscard]] std::optional<Failure> finish(PolygonSoup& soup);

 private:
  enum class Library { read, outside, missing, unreadable };
  Library add_library(const std::string& name);
  void note_unread(const std::string& name);
  std::uint16_t image_of(const ObjMaterial& material, Appearance& look);

  const std::filesystem::path* file_;
  bool wants_heights_;
  std::optional<Failure> problem_;
  std::vector<std::array<float, 2>> places_;
  std::vector<std::int64_t> place_of_corner_;  // counted from 1, 0: none; of the corners up to the last that has one
  std::vector<Colour> colours_;                // of the points up to the last that has one
  std::set<std::string, std::less<>> libraries_;
  std::vector<std::string> files_;
  std::vector<std::string> unread_;
  ObjMaterials materials_;
};

}  // namespace fdcg::bake
