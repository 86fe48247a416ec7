// SPDX-License-Identifier: Apache-2.0
#include "import/obj_materials.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "import/text_scanner.hpp"

namespace fdcg::bake {
namespace {

// A share of 0 to 1 at the cursor; false: there is none.
bool read_share(TextScanner& scan, float& share) {
  double value = 0;
  if (scan.line_done() || !scan.read_real(value) || !(value >= 0)) return false;
  share = static_cast<float>(std::min(value, 1.0));
  return true;
}

// The next word of a line, cut from its front.
std::string_view take_word(std::string_view& line) {
  constexpr std::string_view kBetween = " \t";
  line.remove_prefix(std::min(line.find_first_not_of(kBetween), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBetween));
  line.remove_prefix(word.size());
  return word;
}

// Up to `count` numbers at the front of a line; what is no number, or so large that products and sums of them are none, stays.
void take_numbers(std::string_view& line, double* numbers, std::size_t count) {
  constexpr double kLargest = 1e100;
  for (std::size_t k = 0; k < count; ++k) {
    std::string_view rest = line;
    const std::string_view word = take_word(rest);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !(std::fabs(value) <= kLargest)) return;
    numbers[k] = value;
    line = rest;
  }
}

// "-s 2 2 -bm 0.1 -clamp on name of the file.png", the coordinates of OBJ growing upwards.
HeightImage read_map(std::string_view line) {
  HeightImage map;
  double scale[3] = {1, 1, 1}, shift[3] = {0, 0, 0}, unused[3] = {}, base_gain[2] = {0, 0}, factor = 0;
  while (!line.empty()) {
    std::string_view rest = line;
    const std::string_view option = take_word(rest);
    if (!option.starts_with('-')) break;
    line = rest;
    if (option == "-s" || option == "-o" || option == "-t") {
      take_numbers(line, option == "-s" ? scale : option == "-o" ? shift : unused, 3);
    } else if (option == "-mm") {
      take_numbers(line, base_gain, 2);
    } else if (option == "-bm") {
      take_numbers(line, &factor, 1);
    } else if (take_word(line) == "on" && option == "-clamp") {
      map.wrap = {HeightImage::Wrap::clamp, HeightImage::Wrap::clamp};
    }
  }
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  map.name = line;
  map.placing = {scale[0], 0, shift[0], 0, scale[1], 1 - scale[1] - shift[1]};
  map.range = factor != 0 && base_gain[1] != 0 ? factor * base_gain[1] : factor != 0 ? factor : base_gain[1];
  return map;
}

}  // namespace

void read_obj_materials(std::string_view library, const std::string& folder, ObjMaterials& materials) {
  TextScanner scan(library, {.hash_comments = true, .continuation = true});
  ObjMaterial* current = nullptr;
  for (; scan.find_token(); scan.next_line()) {
    const std::string_view keyword = scan.read_word();
    if (keyword == "newmtl") {
      const auto [found, is_new] = materials.emplace(std::string(scan.read_rest_of_line()), ObjMaterial{});
      current = is_new ? &found->second : nullptr;
      if (is_new) current->folder = folder;
    } else if (current == nullptr) {
      continue;
    } else if (keyword == "Kd") {
      Colour read = current->colour;
      if (!read_share(scan, read[0])) continue;  // "spectral", "xyz"
      read[1] = read[2] = read[0];               // of one number alone: grey
      if (read_share(scan, read[1]) && !read_share(scan, read[2])) continue;
      std::copy_n(read.begin(), 3, current->colour.begin());
    } else if (keyword == "d" || keyword == "Tr") {
      float share = 0;
      if (read_share(scan, share)) current->colour[3] = keyword == "d" ? share : 1 - share;
    } else if (keyword == "map_bump" || keyword == "map_Bump" || keyword == "bump" || keyword == "disp") {
      HeightImage map = read_map(scan.read_rest_of_line());
      if (current->heights.name.empty()) current->heights = std::move(map);
    }
  }
}

}  // namespace fdcg::bake
