// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "contender.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::test {
namespace {

class FdcgContender : public Contender {
 public:
  FdcgContender(const bake::PolygonSoup& soup, const FdcgVariant& variant) {
    bake::CompileOptions options;
    options.precision = variant.precision;
    options.store_planes = variant.is_stored;
    options.merge = variant.is_merged;
    options.without = {"source-map", "info"};
    options.jobs = 1;
    const auto begin = std::chrono::steady_clock::now();
    auto compiled = bake::compile(soup, options);
    if (!compiled) throw std::runtime_error(soup.name + ": " + compiled.error().message);
    if (compiled->bytes.empty()) throw std::runtime_error(soup.name + ": " + bake::report_text(compiled->report, false));
    bytes_ = std::move(compiled->bytes);
    fdcg_error error{};
    if (fdcg_open_memory(bytes_.data(), bytes_.size(), FDCG_VERIFY_TRUSTED, &graph_, &error) != FDCG_OK) {
      throw std::runtime_error(soup.name + ": " + error.message);
    }
    info_.bake_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    info_.bytes = bytes_.size();
    info_.precision = variant.precision == bake::Precision::f64 ? "f64" : "f32";
    info_.planes = variant.is_stored ? "stored" : "derived";
    info_.merged = variant.is_merged ? "yes" : "no";
    info_.family = "fdcg";
    info_.has_friction = true;
    info_.name = "fdcg_" + info_.precision + "_" + info_.planes + (variant.is_merged ? "" : "_unmerged");
    set_friction(0, 0);
  }

  void reset() override { contact_ = {}; }
  void set_friction(double mu_static, double mu_dynamic) override {
    params_ = fdcg_make_params();
    params_.mu_static = mu_static;
    params_.mu_dynamic = mu_dynamic;
    params_.stiffness_n_per_m = kStiffness_n_per_m;
    reset();
  }
  void step(const Ground::Point& hip_m, Feel& feel) override {
    fdcg_result result;
    fdcg_step(&graph_, &params_, &contact_, hip_m.data(), &result);
    feel.in_contact = result.state != FDCG_FREE;
    feel.transitions = result.transitions;
    feel.is_carried = (result.flags & (FDCG_RESULT_TRANSITION_BOUND | FDCG_RESULT_SWEEP_BOUND)) != 0;
    std::memcpy(feel.god_object.data(), result.god_object_m, sizeof result.god_object_m);
    std::memcpy(feel.force.data(), result.force_n, sizeof result.force_n);
  }

 private:
  std::vector<std::byte> bytes_;
  fdcg_graph graph_{};
  fdcg_params params_{};
  fdcg_contact contact_{};
};

}  // namespace

std::unique_ptr<Contender> make_fdcg(const bake::PolygonSoup& soup, const FdcgVariant& variant) {
  return std::make_unique<FdcgContender>(soup, variant);
}

}  // namespace fdcg::test
