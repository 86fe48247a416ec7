// SPDX-License-Identifier: Apache-2.0
#include "import/obj_materials.hpp"

#include <algorithm>
#include <array>

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

}  // namespace

void read_obj_materials(std::string_view library, ObjMaterials& materials) {
  TextScanner scan(library, {.hash_comments = true, .continuation = true});
  Colour* current = nullptr;
  for (; scan.find_token(); scan.next_line()) {
    const std::string_view keyword = scan.read_word();
    if (keyword == "newmtl") {
      const auto [found, is_new] = materials.emplace(std::string(scan.read_rest_of_line()), Colour{1, 1, 1, 1});
      current = is_new ? &found->second : nullptr;
    } else if (current == nullptr) {
      continue;
    } else if (keyword == "Kd") {
      Colour read = *current;
      if (!read_share(scan, read[0])) continue;  // "spectral", "xyz"
      read[1] = read[2] = read[0];               // of one number alone: grey
      if (read_share(scan, read[1]) && !read_share(scan, read[2])) continue;
      std::copy_n(read.begin(), 3, current->begin());
    } else if (keyword == "d" || keyword == "Tr") {
      float share = 0;
      if (read_share(scan, share)) (*current)[3] = keyword == "d" ? share : 1 - share;
    }
  }
}

}  // namespace fdcg::bake
