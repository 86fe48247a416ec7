// SPDX-License-Identifier: Apache-2.0
#include "accuracy_run.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "certificate.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "replay.hpp"
#include "result_law.hpp"
#include "ulp.hpp"

namespace fdcg::test {
namespace {

using bake::Vec3;

constexpr double kTieMoves_ulps = 64;  // a HIP moved by so much, for which the runtime's feature holds, makes a tie
constexpr int kTriesOfASize = 12;
constexpr double kRounding_ulps = 8;  // the bar on 99.9 % of the ticks

double largest_side(const bake::PolygonSoup& soup) {
  Vec3 low = soup.points.at(0), high = low;
  for (const Vec3& p : soup.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

// Far from the world's origin in no special direction.
Vec3 offset_of(const AccuracySetting& setting) {
  const double far = setting.offset_sizes * largest_side(*setting.soup);
  return {0.48 * far, -0.6 * far, 0.64 * far};
}

bake::CompileOptions options_of(const AccuracySetting& setting) {
  bake::CompileOptions options;
  options.precision = setting.precision;
  options.merge = setting.is_merged;
  options.store_planes = setting.is_stored;
  options.allow = {"boundary-edge"};
  options.jobs = 1;
  return options;
}

// Steps through the setting's way, the body moved and the way with it: call(HIP) at each tick, which says where the god-object
// is.
template <class Call>
void walk_along(const AccuracySetting& setting, const bake::PolygonSoup& soup, Hip god_object, Call call) {
  if (setting.hips == nullptr) {
    HipWalk walk(soup, setting.seed);
    for (std::uint64_t i = 0; i < setting.steps; ++i)
      god_object = call(walk.next(god_object));
    return;
  }
  const Vec3 offset = offset_of(setting);
  for (std::uint64_t i = 0; i < setting.steps && i < setting.hips->size(); ++i) {
    const Hip& hip = (*setting.hips)[i];
    call({hip[0] + offset.x, hip[1] + offset.y, hip[2] + offset.z});
  }
}

template <class Real>
AccuracyOutcome replayed(const AccuracySetting& setting, const bake::PolygonSoup& soup, const fdcg_graph& graph) {
  Replay<Real> replay(graph, contact_params(setting.mu_static, setting.mu_dynamic));
  walk_along(setting, soup, {}, [&](const Hip& hip) {
    replay.step(hip);
    return replay.god_object_m();
  });
  ReplayErrors& e = replay.errors;
  AccuracyOutcome out;
  out.steps = e.steps;
  out.contact_steps = e.contact_steps;
  out.ties = e.ties;
  out.wrong_features = e.wrong;
  out.carried = e.carried;
  out.ties_explained = e.ties_explained;
  out.ties_unexplained = e.ties_unexplained;
  out.one_step_ulps = std::move(e.one_step);
  out.accumulated_ulps = std::move(e.accumulated);
  out.error_and_conditioning = std::move(e.looked_at);
  out.worst_conditioning = e.worst_conditioning;
  out.first_wrong = e.first_wrong;
  out.first_unexplained = e.first_unexplained;
  out.worst = e.worst;
  return out;
}

AccuracyOutcome certified(const AccuracySetting& setting, const bake::PolygonSoup& soup, const fdcg_graph& graph) {
  constexpr double kDeviations = 4;
  const Certificate certificate(graph);
  const ReferenceSurface<long double> surface(graph);
  const double ulp = ulp_of_extent(*graph.header);
  const double most_moved = kTieMoves_ulps + kDeviations * graph.header->max_deviation / ulp;
  Contact contact(graph, contact_params(0, 0));
  AccuracyOutcome out;
  walk_along(setting, soup, {}, [&](const Hip& hip) {
    contact.step(hip);
    ++out.steps;
    if (contact.state.state == FDCG_FREE) return contact.god_object();
    ++out.contact_steps;
    const Hip local = surface.local(hip.data());
    const ResultLaw law = result_law(*graph.header, contact_params(0, 0), contact.state, hip, contact.result);
    if ((!law.is_of_contact || !law.is_of_spring) && out.wrong_features++ == 0)
      out.first_wrong = "result or force: " + contact.describe();
    if ((contact.result.flags & (FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND)) != 0) {
      ++out.carried;
      return contact.god_object();
    }
    const Certificate::Answer answer = certificate.check(local, contact.state);
    using Verdict = Certificate::Verdict;
    const bool is_doubtful = answer.verdict == Verdict::refused || answer.verdict == Verdict::wrong_feature;
    const bool is_near = is_doubtful && certificate.holds_nearby(local, contact.state, most_moved);
    if (is_doubtful && !is_near) {
      if (out.wrong_features++ == 0) {
        std::ostringstream text;
        text << "tick " << out.steps << ": " << contact.describe() << std::hexfloat << ", local HIP " << local[0] << ' '
             << local[1] << ' ' << local[2] << std::defaultfloat << ", off by " << answer.error_ulps << " ulps from state "
             << answer.feature.state << " feature " << answer.feature.index
             << (answer.verdict == Verdict::refused ? ": no minimum around" : "");
        out.first_wrong = text.str();
      }
    }
    if (answer.verdict == Verdict::tie || is_near) {
      ++out.ties;
    } else if (answer.error_ulps > kRounding_ulps && answer.error_ulps <= kRounding_ulps + answer.rim_ulps) {
      out.at_rim_ulps.push_back(static_cast<float>(answer.error_ulps));
    } else if (answer.verdict != Verdict::refused) {
      out.one_step_ulps.push_back(static_cast<float>(answer.error_ulps));
    }
    return contact.god_object();
  });
  return out;
}

}  // namespace

const char* name_of(Judge judge) {
  switch (judge) {
    case Judge::long_double:
      return "long double replay";
    case Judge::mpfr_256:
      return "256-bit replay";
    default:
      return "rational certificate";
  }
}

AccuracyOutcome run(const AccuracySetting& setting) {
  const bake::PolygonSoup soup = setting.offset_sizes == 0 ? *setting.soup : moved(*setting.soup, offset_of(setting));
  const CompiledMesh mesh(soup, options_of(setting));
  AccuracyOutcome out = setting.judge == Judge::certificate ? certified(setting, soup, mesh.view())
                        : setting.judge == Judge::mpfr_256  ? replayed<Mpfr256>(setting, soup, mesh.view())
                                                            : replayed<long double>(setting, soup, mesh.view());
  out.deviation_ulps = mesh.view().header->max_deviation / ulp_of_extent(*mesh.view().header);
  return out;
}

double percentile(std::vector<float>& values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(part * static_cast<double>(values.size()));
  return static_cast<double>(values[rank < 1 ? 0 : static_cast<std::size_t>(rank) - 1]);
}

}  // namespace fdcg::test
