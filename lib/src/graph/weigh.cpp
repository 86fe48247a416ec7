// SPDX-License-Identifier: Apache-2.0
#include "graph/weigh.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "base/vec3.hpp"
#include "graph/solid_mass.hpp"
#include "shared/mass_record.hpp"  // the values that the runtime accepts

namespace fdcg::bake {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

std::string inside_out_patches_in(const Report& report) {
  for (const Issue& issue : report.issues) {
    if (issue.rule != "inside-out" || issue.total == 0) continue;
    return std::to_string(issue.total) + (issue.total == 1 ? " closed patch is" : " closed patches are") +
           " inside out; turn them with --orient";
  }
  return {};
}

}  // namespace

std::string check_mass_options(const CompileOptions& options) {
  constexpr double kLargest = 1e30;
  const auto is_out = [](double x) { return x != 0 && !(x >= 1 / kLargest && x <= kLargest); };
  if (is_out(options.density_kg_per_m3))
    return "the density is " + number(options.density_kg_per_m3) + " kg per cubic metre; it must be 1e-30 to 1e30";
  if (is_out(options.mass_kg)) return "the mass is " + number(options.mass_kg) + " kg; it must be 1e-30 to 1e30";
  if (options.density_kg_per_m3 != 0 && options.mass_kg != 0) return "a density and a mass are given; give one of them";
  if (options.without.contains("mass") && (options.density_kg_per_m3 != 0 || options.mass_kg != 0))
    return "a density or a mass is given, and mass is to be left out; drop one of them";
  return {};
}

Result<std::optional<fdcg_mass_record>> weigh(const Mesh& mesh, const Topology& topology, const Regions& regions,
                                              const CompileOptions& options, unsigned jobs, Compiled& compiled) {
  if (options.without.contains("mass")) return std::optional<fdcg_mass_record>{};
  Solid solid;
  solid.reason = inside_out_patches_in(compiled.report);
  if (solid.reason.empty()) solid = measure_solid(mesh, topology, jobs);
  fdcg_mass_record record{};
  if (solid.reason.empty()) {
    record.volume = solid.mass.volume;
    for (int k = 0; k < 3; ++k)
      record.centroid[k] = component(solid.mass.centroid, k);
    std::copy(solid.mass.inertia.begin(), solid.mass.inertia.end(), record.inertia);
    const Vec3& origin = mesh.origin;
    const double from[3] = {origin.x, origin.y, origin.z};
    const double volume_m3 = mass_in_metres(record, from, options.metres_per_unit).volume_m3;
    const bool has_mass = options.mass_kg != 0;
    record.density_kg_per_m3 = has_mass ? options.mass_kg / volume_m3 : options.density_kg_per_m3;
    record.mass_kg = has_mass ? options.mass_kg : options.density_kg_per_m3 * volume_m3;
    record.deviation = deviation_from_regions(mesh, regions);
    if (const char* fault = mass_fault(mass_in_metres(record, from, options.metres_per_unit)); fault != nullptr)
      solid.reason = std::string(fault) + ": numbers of this size fit no double in metres; scale the mesh";
  }
  if (solid.reason.empty()) return std::optional(record);
  if (options.density_kg_per_m3 != 0 || options.mass_kg != 0)
    return Failure{1,
                   compiled.report.file + ": it has no mass: " + solid.reason + ", or compile it without --density and --mass"};
  compiled.no_mass = solid.reason;
  return std::optional<fdcg_mass_record>{};
}

}  // namespace fdcg::bake
