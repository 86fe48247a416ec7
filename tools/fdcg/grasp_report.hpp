// SPDX-License-Identifier: Apache-2.0
// The result of fdcg grasp, and its report as text and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fdcg/grasp.hpp"
#include "grasp_contacts.hpp"
#include "grasp_object.hpp"

namespace fdcg::tools {

struct GraspReport {
  std::string object;  // the file
  std::uint32_t faces = 0;
  std::string centre_from;          // "volume" or "option"
  std::optional<bake::Vec3> com_m;  // centre of mass; none: not known, and no load asked for
  std::string com_from;             // "volume" or "option"
  std::string torque_scale_from;    // "size" or "option"
  std::vector<NamedContact> asked;
  std::vector<SurfacePoint> found;  // one for each
  grasp::Grasp grasp;
  grasp::Closure closure;
  grasp::Effort effort = grasp::Effort::together;
  grasp::Epsilon epsilon;
  grasp::Wrench load;                   // of the margin
  std::string load_text;                // where it is from
  std::optional<double> grip_n;         // all contacts together
  std::optional<grasp::Margin> margin;  // none: neither a grip nor caps are given
  std::vector<std::string> warnings;
  bool has_far_contacts = false;  // one was moved so far that this is another grasp
};

// schemas/grasp-report.schema.json
std::string grasp_report_json(const GraspReport& report);
std::string grasp_report_text(const GraspReport& report);

}  // namespace fdcg::tools
