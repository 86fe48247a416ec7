// SPDX-License-Identifier: Apache-2.0
// Any bytes as the contacts of fdcg grasp: understood, with numbers that grasp::problem_of takes, or refused in one short line.
#include <cmath>

#include "fdcg/grasp.hpp"
#include "fuzz_json_file.hpp"
#include "grasp_contacts.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace fdcg;
  const auto contacts = tools::parse_contacts(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  if (!contacts) {
    tools::require_one_short_line(contacts.error());
    return 0;
  }
  grasp::Grasp grasp;
  grasp.torque_scale_m = 1e100;  // the object's affair: no point is too far, no torsion too large
  for (const tools::NamedContact& one : *contacts) {
    grasp::Contact contact;
    contact.point_m = one.point_m;
    contact.inward = one.inward.value_or(bake::Vec3{0, 0, 1});
    contact.mu = one.mu.value_or(0);
    contact.torsion_m = std::fmin(one.torsion_m.value_or(0), 1e100);
    if (one.cap_n) contact.cap_n = *one.cap_n;
    grasp.contacts.push_back(contact);
    if (one.name.find_first_of("\r\n") != std::string::npos) std::abort();
  }
  if (const auto problem = grasp::problem_of(grasp)) {
    std::fprintf(stderr, "taken, though %s\n", problem->c_str());
    std::abort();
  }
  return 0;
}
