// SPDX-License-Identifier: Apache-2.0
#include "contender_row.hpp"

#include <cstdio>

#include "table.hpp"

namespace fdcg::test {
namespace {

template <class... Values>
std::vector<std::string> cells(const Values&... values) {
  return {cell(values)...};
}

}  // namespace

const std::vector<std::string>& contender_columns() {
  static const std::vector<std::string> columns = {"body",
                                                   "group",
                                                   "faces",
                                                   "way",
                                                   "seed",
                                                   "rate_hz",
                                                   "mu_static",
                                                   "mu_dynamic",
                                                   "contender",
                                                   "family",
                                                   "precision",
                                                   "planes",
                                                   "merged",
                                                   "ticks",
                                                   "contact_ticks",
                                                   "rounds",
                                                   "mean_ns",
                                                   "least_mean_ns",
                                                   "batch_ns",
                                                   "p50_ns",
                                                   "p99_ns",
                                                   "p999_ns",
                                                   "max_ns",
                                                   "met_p999_ns",
                                                   "met_max_ns",
                                                   "cold_mean_ns",
                                                   "cold_p50_ns",
                                                   "cold_p99_ns",
                                                   "cold_max_ns",
                                                   "free_p50_ns",
                                                   "contact_p50_ns",
                                                   "contact_instructions",
                                                   "transitions",
                                                   "carried_ticks",
                                                   "astray_ticks",
                                                   "bytes_per_face",
                                                   "bake_s",
                                                   "tied_share",
                                                   "equal_share",
                                                   "in_floats_share",
                                                   "unjudged_share",
                                                   "god_object_rms_judged_m",
                                                   "god_object_rms_m",
                                                   "god_object_p50_m",
                                                   "god_object_p99_m",
                                                   "god_object_max_m",
                                                   "force_rms_n",
                                                   "force_max_n",
                                                   "force_share_p99",
                                                   "noticeable_share",
                                                   "direction_p99_deg",
                                                   "direction_max_deg",
                                                   "jump_n_per_ms",
                                                   "true_jump_n_per_ms",
                                                   "wrong_feature_share",
                                                   "push_throughs",
                                                   "push_through_share",
                                                   "phantom_share",
                                                   "creep_m",
                                                   "energy_work_j",
                                                   "energy_bound_j",
                                                   "reference"};
  return columns;
}

const char* name_of(BodyGroup group) {
  constexpr const char* kNames[] = {"sphere", "star", "torus", "awkward"};
  return kNames[static_cast<std::size_t>(group)];
}

std::vector<std::string> cells_of(const ContenderRow& row, const std::vector<TrueBody::Tick>& truth) {
  const Metrics& m = row.metrics;
  const ContenderInfo& info = row.info;
  const Timing& timing = row.timing;
  std::vector<float> in_free, in_contact;
  for (std::size_t i = 0; i < truth.size(); ++i)
    (truth[i].feel.in_contact ? in_contact : in_free).push_back(timing.tick_ns[i]);
  const Percentiles ticks(timing.tick_ns), free(std::move(in_free)), contact(std::move(in_contact)), cold(timing.cold_ns);
  double cold_mean = 0;
  for (const float ns : timing.cold_ns)
    cold_mean += ns / static_cast<double>(timing.cold_ns.size());
  std::printf("  %-26s %6.0f ns (p99 %6.0f)  error rms %8.2g m, max %8.2g m  off the feature %5.1f %%  pushed through %llu\n",
              info.name.c_str(), timing.mean_ns(), ticks.at(0.99), m.god_object_rms_m, m.god_object_max_m,
              100 * m.wrong_feature_share, static_cast<unsigned long long>(m.push_throughs));
  return cells(row.body.name, name_of(row.body.group), row.body.faces, row.along.way, row.along.seed, row.along.rate_hz,
               row.along.mu_static, row.along.mu_dynamic, info.name, info.family, info.precision, info.planes, info.merged,
               m.ticks, m.contact_ticks, timing.rounds, timing.mean_ns(), timing.least_mean_ns, timing.batch_ns, ticks.at(0.5),
               ticks.at(0.99), ticks.at(0.999), ticks.at(1), timing.met_p999_ns, timing.met_max_ns, cold_mean, cold.at(0.5),
               cold.at(0.99), cold.at(1), free.at(0.5), contact.at(0.5), row.contact_instructions, m.transitions,
               m.carried_ticks, m.astray_ticks, static_cast<double>(info.bytes) / row.body.faces, info.bake_s, m.tied_share,
               m.equal_share, m.in_floats_share, m.unjudged_share, m.judged_rms_m, m.god_object_rms_m, m.god_object_p50_m,
               m.god_object_p99_m, m.god_object_max_m, m.force_rms_n, m.force_max_n, m.force_share_p99, m.noticeable_share,
               m.direction_p99_deg, m.direction_max_deg, m.jump_n_per_ms, m.true_jump_n_per_ms, m.wrong_feature_share,
               m.push_throughs, m.push_through_share, m.phantom_share, row.creep_m, row.energy.work_j, row.energy.bound_j,
               row.along.reference);
}

}  // namespace fdcg::test
