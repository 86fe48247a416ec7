// SPDX-License-Identifier: Apache-2.0
#include "validate/check_rules.hpp"

namespace fdcg::bake::checks {

void not_orientable(const Subject& subject, Findings& out) {
  for (std::uint32_t p = 0; p < subject.patches.patches.size(); ++p) {
    if (!subject.patches.patches[p].is_orientable) out.at_patch(p);
  }
}

void inside_out(const Subject& subject, Findings& out) {
  for (const std::uint32_t p : inside_out_patches(subject.mesh, subject.patches))
    out.at_patch(p);
}

}  // namespace fdcg::bake::checks
