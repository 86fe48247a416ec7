// SPDX-License-Identifier: Apache-2.0
#include "relief_option.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace fdcg::servo {
namespace {

constexpr const char* kReliefForm =
    "none of ridges=HEIGHT,WAVELENGTH, bumps=HEIGHT,WAVELENGTH, grain=RMS,SHORTEST,LONGEST (in metres) and image";

// Metres, of "0.0001,0.001"; empty: they are none.
std::vector<double> lengths_of(const std::string& text) {
  constexpr double kLongest_m = 10;  // fdcg_check_relief
  std::vector<double> lengths;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const auto length = tools::parse_number_between(text.substr(from, comma - from), 0, kLongest_m);
    if (!length) return {};
    lengths.push_back(*length);
    from = comma + 1;
  }
  return lengths;
}

std::optional<fdcg_waves> parse_waves(const std::string& text) {
  constexpr double kAcross[3] = {1, 0, 0}, kExponent = 1;
  const std::size_t at = std::min(text.find('='), text.size());
  const std::string kind = text.substr(0, at);
  const std::vector<double> m = at < text.size() ? lengths_of(text.substr(at + 1)) : std::vector<double>{};
  if (kind == "ridges" && m.size() == 2) return fdcg_make_ridges(m[0], m[1], kAcross);
  if (kind == "bumps" && m.size() == 2) return fdcg_make_bumps(m[0], m[1]);
  if (kind == "grain" && m.size() == 3) return fdcg_make_grain(m[0], m[1], m[2], kExponent, 0);
  return std::nullopt;
}

}  // namespace

void ReliefOption::declare(const tools::OptionGroup& group) {
  const auto take = [this](const std::string& text) {
    is_image_ = text == "image";
    if (is_image_) return;
    waves_ = parse_waves(text);
    if (!waves_) throw CLI::ValidationError("--relief", "'" + text + "' is " + kReliefForm);
    relief_ = fdcg_make_relief(&*waves_);
    fdcg_error error{};
    if (fdcg_check_relief(&relief_, &error) != FDCG_OK)
      throw CLI::ValidationError("--relief", "'" + text + "': " + error.message);
  };
  group.parsed("--relief", "KIND=M,M", take,
               "Heights that are felt and not in the mesh, metres: ridges=HEIGHT,WAVELENGTH across x, bumps=HEIGHT,WAVELENGTH, "
               "grain=RMS,SHORTEST,LONGEST, or the images of the graph's file: image.");
}

std::string ReliefOption::open(const fdcg_graph& graph) {
  if (!is_image_) return {};
  fdcg_error error{};
  if (fdcg_get_heights(&graph, &heights_, &error) != FDCG_OK) return error.message;
  relief_ = fdcg_make_height_relief(&heights_);
  return fdcg_check_relief(&relief_, &error) == FDCG_OK ? std::string() : error.message;
}

void ReliefOption::step(const fdcg_graph& graph, const fdcg_params& params, const double* hip_m, fdcg_contact* contact,
                        fdcg_result* result) {
  if (!std::isfinite(hip_m[0]) || !std::isfinite(hip_m[1]) || !std::isfinite(hip_m[2])) {
    fdcg_step(&graph, &params, contact, hip_m, result);
    std::copy_n(result->force_n, 3, flat_n_);
    return;
  }
  double moved_m[3];
  fdcg_effect_facts facts;
  fdcg_relief_move(&relief_, &state_, hip_m, params.tick_s, moved_m);
  fdcg_step(&graph, &params, contact, moved_m, result);
  std::copy_n(result->force_n, 3, flat_n_);
  if (fdcg_get_effect_facts(&graph, result, moved_m, 0, params.tick_s, &facts, nullptr) == FDCG_OK)
    fdcg_relief_turn(&relief_, &state_, &facts, result->force_n);
}

}  // namespace fdcg::servo
