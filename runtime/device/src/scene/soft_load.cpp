// SPDX-License-Identifier: Apache-2.0
#include "scene/soft_load.hpp"

#include <algorithm>
#include <cmath>

#include "shared/text.hpp"

namespace fdcg::dev {
namespace {

constexpr double kEdgesAcross = 2;  // the default radius, in mean edges: less is felt as a pit

struct Edges {
  double mean_m = 0;       // length
  double spread_m2 = 0;    // mean over the corners of the sum of their edges' squares: what a unit of time adds to the shares'
                           // mean square distance
  std::uint32_t most = 0;  // at one corner
};

Edges edges_of(const CornerNeighbours& corners, const std::vector<double>& place_m, double scale) {
  Edges edges;
  for (std::uint32_t corner = 0; corner < corners.count(); ++corner) {
    edges.most = std::max(edges.most, corners.first[corner + 1] - corners.first[corner]);
    for (std::uint32_t i = corners.first[corner]; i < corners.first[corner + 1]; ++i) {
      double square = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double along = place_m[3 * std::size_t{corners.neighbour[i]} + k] - place_m[3 * std::size_t{corner} + k];
        square += along * along;
      }
      edges.spread_m2 += square * scale * scale;
      edges.mean_m += std::sqrt(square) * scale;
    }
  }
  edges.mean_m /= std::max<double>(1, static_cast<double>(corners.neighbour.size()));
  edges.spread_m2 /= std::max<double>(1, corners.count());
  return edges;
}

}  // namespace

std::string SoftLoad::begin(const CornerNeighbours& corners, const std::vector<double>& place_m, double scale,
                            std::optional<double> radius_m) {
  corners_ = &corners;
  const std::size_t count = corners.count();
  force_n_.assign(3 * count, 0);
  next_n_ = force_n_;
  loaded_.clear();
  loaded_.reserve(count);
  is_loaded_.assign(count, 0);
  const Edges edges = edges_of(corners, place_m, scale);
  const double most_m = edges.most > 0 ? std::sqrt(kMostRounds * edges.spread_m2 / edges.most) : 0;
  radius_m_ = radius_m.value_or(std::min(kEdgesAcross * edges.mean_m, most_m));
  if (radius_m_ > most_m) {
    return "radius_m is " + shown_number(radius_m_) + ", and a load can be spread over " + shown_number(most_m) +
           " m of this mesh, whose edges are " + shown_number(edges.mean_m) + " m long on average, with at most " +
           std::to_string(edges.most) + " at a corner; lower radius_m, or give a coarser mesh";
  }
  rounds_ = 0;
  if (!(radius_m_ > 0)) return {};
  const double time = radius_m_ * radius_m_ / edges.spread_m2;
  rounds_ = std::clamp(2 * static_cast<int>(std::ceil(time * edges.most / 2)), 2, kMostRounds);
  share_ = time / rounds_;
  return {};
}

void SoftLoad::take_in(std::uint32_t corner) {
  if (is_loaded_[corner] != 0) return;
  is_loaded_[corner] = 1;
  loaded_.push_back(corner);
}

void SoftLoad::press(std::uint32_t corner, const double force_n[3], double share) {
  take_in(corner);
  for (std::size_t k = 0; k < 3; ++k)
    force_n_[3 * std::size_t{corner} + k] += share * force_n[k];
}

void SoftLoad::spread() {
  std::size_t inside = 0;  // of loaded_: those whose neighbours are all in it
  for (int round = 0; round < rounds_; ++round) {
    for (const std::size_t rim = loaded_.size(); inside < rim; ++inside) {
      const std::uint32_t corner = loaded_[inside];
      for (std::uint32_t i = corners_->first[corner]; i < corners_->first[corner + 1]; ++i)
        take_in(corners_->neighbour[i]);
    }
    for (const std::uint32_t corner : loaded_) {
      const double* const own = &force_n_[3 * std::size_t{corner}];
      double sum[3] = {};
      for (std::uint32_t i = corners_->first[corner]; i < corners_->first[corner + 1]; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          sum[k] += force_n_[3 * std::size_t{corners_->neighbour[i]} + k] - own[k];
      for (std::size_t k = 0; k < 3; ++k)
        next_n_[3 * std::size_t{corner} + k] = own[k] + share_ * sum[k];
    }
    for (const std::uint32_t corner : loaded_)
      std::copy_n(&next_n_[3 * std::size_t{corner}], 3, &force_n_[3 * std::size_t{corner}]);
  }
}

void SoftLoad::clear() {
  for (const std::uint32_t corner : loaded_) {
    is_loaded_[corner] = 0;
    std::fill_n(&force_n_[3 * std::size_t{corner}], 3, 0.0);
  }
  loaded_.clear();
}

}  // namespace fdcg::dev
