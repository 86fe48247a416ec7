// SPDX-License-Identifier: Apache-2.0
#include "tick/soft.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"

namespace fdcg::dev {
namespace {

constexpr double kStill = 1e-9;  // of the depth: so near its place, a corner that nothing pushes is put there

void less(const double a[3], const double b[3], double difference[3]) {
  for (int i = 0; i < 3; ++i)
    difference[i] = a[i] - b[i];
}

// Barycentric coordinates of a point, clamped to 0 to 1 with sum 1; a third each if the triangle has no area.
void shares_in(const double (&corner)[3][3], const double point[3], double share[3]) {
  double a[3], b[3], p[3];
  less(corner[1], corner[0], a);
  less(corner[2], corner[0], b);
  less(point, corner[0], p);
  const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), pa = dot(p, a), pb = dot(p, b);
  const double area = aa * bb - ab * ab;
  share[0] = share[1] = share[2] = 1.0 / 3;
  if (!(area > 1e-12 * aa * bb)) return;
  share[1] = std::clamp((bb * pa - ab * pb) / area, 0.0, 1.0);
  share[2] = std::clamp((aa * pb - ab * pa) / area, 0.0, 1.0 - share[1]);
  share[0] = 1 - share[1] - share[2];
}

}  // namespace

std::string SoftObject::begin(const fdcg_graph& graph, const SoftConfig& config, const fdcg_pose& pose) {
  graph_ = &graph;
  config_ = config;
  pose_ = pose;
  rows_of(pose.rotation_xyzw, turn_);
  fdcg_error error{};
  fdcg_deform_config deform = fdcg_make_deform_config();
  deform.margin_m = config.depth_m / pose.scale;
  memory_.assign(static_cast<std::size_t>(fdcg_deform_bytes(&graph) / sizeof(std::uint64_t) + 1), 0);
  if (fdcg_deform_create(memory_.data(), memory_.size() * sizeof(std::uint64_t), &graph, &deform, &deform_, &error) !=
      FDCG_OK) {
    return error.message;
  }
  const std::uint32_t count = graph.header->corner_count;
  rest_m_.assign(3 * static_cast<std::size_t>(count), 0);
  moved_m_ = rest_m_;
  corners_ = {};
  for (std::uint32_t corner = 0; corner < count; ++corner) {
    fdcg_deform_place(deform_, corner, rest_m_.data() + 3 * static_cast<std::size_t>(corner), nullptr);
    std::uint32_t fan[FDCG_DEFORM_MOST_FAN];
    const std::uint32_t edges = fdcg_get_fan(&graph, corner, fan, FDCG_DEFORM_MOST_FAN);
    for (std::uint32_t i = 0; i < edges; ++i) {
      const fdcg_connection_info edge = fdcg_get_connection(&graph, fan[i] >> 1);
      corners_.neighbour.push_back(edge.corner[(fan[i] & 1) == 0 ? 1 : 0]);
    }
    corners_.first.push_back(static_cast<std::uint32_t>(corners_.neighbour.size()));
  }
  return load_.begin(corners_, rest_m_, pose.scale, config.radius_m);
}

// Applies the reaction force to the corners of the face, of one of the edge's faces, or to the corner itself.
void SoftObject::press(const fdcg_touch& touch) {
  if (touch.state == FDCG_FREE) return;
  double pressed_n[3], off_m[3], god_object_m[3];
  less(touch.god_object_m, pose_.translation_m, off_m);
  for (int i = 0; i < 3; ++i) {
    pressed_n[i] = -(turn_[i] * touch.force_n[0] + turn_[3 + i] * touch.force_n[1] + turn_[6 + i] * touch.force_n[2]);
    god_object_m[i] = (turn_[i] * off_m[0] + turn_[3 + i] * off_m[1] + turn_[6 + i] * off_m[2]) / pose_.scale;
  }
  if (touch.state == FDCG_VERTEX) return load_.press(touch.feature, pressed_n, 1);
  const std::uint32_t node = touch.state == FDCG_FACE ? touch.feature : fdcg_get_connection(graph_, touch.feature).node[0];
  std::uint32_t corner[3];
  double place_m[3][3], share[3];
  for (std::uint32_t i = 0; i < 3; ++i) {
    corner[i] = fdcg_get_side(graph_, node, i).corner;
    fdcg_deform_place(deform_, corner[i], place_m[i], nullptr);
  }
  shares_in(place_m, god_object_m, share);
  for (int i = 0; i < 3; ++i)
    load_.press(corner[i], pressed_n, share[i]);
}

// Gauss-Seidel: corners in the graph's order, each with its neighbours' latest positions, so that the bits are reproducible.
void SoftObject::relax(double tick_s) {
  const double give = config_.damping_n_s_per_m / tick_s, scale = pose_.scale;
  double deepest = 0;
  load_.spread();
  for (std::uint32_t corner = 0; corner < corners_.count(); ++corner) {
    const std::size_t at = 3 * static_cast<std::size_t>(corner);
    const std::uint32_t first = corners_.first[corner], end = corners_.first[corner + 1];
    const double* const pressed_n = load_.force_n(corner);
    double pull[3] = {pressed_n[0] / scale, pressed_n[1] / scale, pressed_n[2] / scale};
    for (std::uint32_t i = first; i < end; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        pull[k] += config_.tension_n_per_m * moved_m_[3 * static_cast<std::size_t>(corners_.neighbour[i]) + k];
    const double held = give + config_.stiffness_n_per_m + config_.tension_n_per_m * (end - first);
    double now_m[3], place_m[3], square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double wanted = (give * moved_m_[at + k] + pull[k]) / held;
      now_m[k] = std::clamp(wanted, -config_.depth_m / scale, config_.depth_m / scale);
      square += now_m[k] * now_m[k];
    }
    const bool is_still = square * scale * scale < kStill * kStill * config_.depth_m * config_.depth_m;
    if (is_still) now_m[0] = now_m[1] = now_m[2] = 0;
    if (std::equal(now_m, now_m + 3, moved_m_.data() + at)) continue;
    for (std::size_t k = 0; k < 3; ++k)
      place_m[k] = rest_m_[at + k] + now_m[k];
    if (fdcg_deform_move(deform_, corner, place_m, nullptr) != FDCG_OK) continue;  // beyond the margin: it stays
    std::copy_n(now_m, 3, moved_m_.data() + at);
  }
  for (std::size_t at = 0; at < moved_m_.size(); at += 3)
    deepest = std::max(deepest, dot(moved_m_.data() + at, moved_m_.data() + at));
  deepest_m_ = std::sqrt(deepest) * scale;
  load_.clear();
}

}  // namespace fdcg::dev
