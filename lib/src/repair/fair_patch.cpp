// SPDX-License-Identifier: Apache-2.0
#include "repair/fair_patch.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/vec3.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kMostPatchPoints = 4000;

class PatchFairing {
 public:
  PatchFairing(std::span<const Vec3> outline, std::span<const Vec3> beyond, std::vector<std::array<std::uint32_t, 3>> triangles)
      : rim_(outline.size()), beyond_(beyond), points_(outline.begin(), outline.end()), triangles_(std::move(triangles)) {
    for (std::size_t i = 0; i < rim_; ++i) {
      const Vec3 &before = outline[(i + rim_ - 1) % rim_], &after = outline[(i + 1) % rim_];
      spacing_.push_back(0.5 * (length(outline[i] - before) + length(after - outline[i])));
    }
  }

  FairPatch run() {
    constexpr int kMostRounds = 16;
    for (int round = 0; round < kMostRounds && points_.size() < kMostPatchPoints && divide(); ++round)
      relax();
    smooth();
    return {{points_.begin() + static_cast<std::ptrdiff_t>(rim_), points_.end()}, std::move(triangles_)};
  }

 private:
  struct Side {
    std::uint32_t low, high, triangle, apex;
  };

  // Puts a point into each triangle that is large for the edges around.
  bool divide() {
    const double kAlpha = std::sqrt(2.0);
    const std::size_t count = triangles_.size();
    for (std::size_t t = 0; t < count; ++t) {
      const auto [a, b, c] = triangles_[t];
      const Vec3 middle = 1.0 / 3 * (points_[a] + points_[b] + points_[c]);
      const double spacing = (spacing_[a] + spacing_[b] + spacing_[c]) / 3;
      const bool is_large = std::all_of(triangles_[t].begin(), triangles_[t].end(), [&](std::uint32_t v) {
        const double reach = kAlpha * length(points_[v] - middle);
        return reach > spacing && reach > spacing_[v];
      });
      if (!is_large) continue;
      const auto v = static_cast<std::uint32_t>(points_.size());
      points_.push_back(middle);
      spacing_.push_back(spacing);
      triangles_[t] = {a, b, v};
      triangles_.push_back({b, c, v});
      triangles_.push_back({c, a, v});
    }
    return triangles_.size() != count;
  }

  [[nodiscard]] std::vector<Side> sides() const {
    std::vector<Side> sides;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
        sides.push_back({std::min(a, b), std::max(a, b), t, triangles_[t][(i + 2) % 3]});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
      return std::tie(p.low, p.high, p.triangle) < std::tie(q.low, q.high, q.triangle);
    });
    return sides;
  }
  [[nodiscard]] Vec3 normal(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return cross(points_[b] - points_[a], points_[c] - points_[a]);
  }
  [[nodiscard]] double angle(std::uint32_t at, std::uint32_t p, std::uint32_t q) const {
    const Vec3 a = points_[p] - points_[at], b = points_[q] - points_[at];
    return std::atan2(length(cross(a, b)), dot(a, b));
  }

  // Exchanges diagonals across from which the angles are large.
  void relax() {
    constexpr int kMostRounds = 8;
    constexpr double kHalfTurn = 3.14159265358979323846, kSlack = 1e-9;
    bool is_changed = true;
    for (int round = 0; round < kMostRounds && is_changed; ++round) {
      is_changed = false;
      const std::vector<Side> all = sides();
      std::vector<bool> is_touched(triangles_.size(), false);
      const auto has = [&](std::uint32_t a, std::uint32_t b) {
        const std::pair key{std::min(a, b), std::max(a, b)};
        const auto found = std::lower_bound(all.begin(), all.end(), key, [](const Side& s, const auto& k) {
          return std::pair{s.low, s.high} < k;
        });
        return found != all.end() && std::pair{found->low, found->high} == key;
      };
      for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const Side &s = all[i], &t = all[i + 1];
        if (s.low != t.low || s.high != t.high || is_touched[s.triangle] || is_touched[t.triangle]) continue;
        if (angle(s.apex, s.low, s.high) + angle(t.apex, s.low, s.high) <= kHalfTurn + kSlack || has(s.apex, t.apex)) continue;
        if (!exchange(s, t)) continue;
        is_touched[s.triangle] = is_touched[t.triangle] = is_changed = true;
      }
    }
  }
  bool exchange(const Side& s, const Side& t) {
    const auto& old = triangles_[s.triangle];
    const std::size_t at_low = static_cast<std::size_t>(std::find(old.begin(), old.end(), s.low) - old.begin());
    const bool is_up = old[(at_low + 1) % 3] == s.high;  // the first triangle runs from low to high
    const std::uint32_t p = is_up ? s.low : s.high, q = is_up ? s.high : s.low;
    const Vec3 one = normal(p, t.apex, s.apex), two = normal(t.apex, q, s.apex);
    if (!(dot(one, two) > 0) || !(dot(one, normal(p, q, s.apex)) > 0)) return false;
    triangles_[s.triangle] = {p, t.apex, s.apex};
    triangles_[t.triangle] = {t.apex, q, s.apex};
    return true;
  }

  void smooth() {
    if (points_.size() == rim_) return;
    std::vector<std::vector<std::uint32_t>> around(points_.size());
    for (const Side& side : sides()) {
      around[side.low].push_back(side.high);
      around[side.high].push_back(side.low);
    }
    for (auto& each : around) {
      std::sort(each.begin(), each.end());
      each.erase(std::unique(each.begin(), each.end()), each.end());
    }
    const auto pull = [&](std::uint32_t v) {  // towards the mean of its neighbours
      Vec3 sum;
      for (const std::uint32_t u : around[v])
        sum = sum + points_[u];
      double count = static_cast<double>(around[v].size());
      if (v < rim_) {
        sum = sum + beyond_[v];
        ++count;
      }
      return 1 / count * sum - points_[v];
    };
    constexpr int kFlatRounds = 50, kBentRounds = 300;
    for (int round = 0; round < kFlatRounds; ++round) {
      for (auto v = static_cast<std::uint32_t>(rim_); v < points_.size(); ++v)
        points_[v] = points_[v] + pull(v);
    }
    std::vector<Vec3> pulls(points_.size());
    for (int round = 0; round < kBentRounds; ++round) {
      for (std::uint32_t v = 0; v < points_.size(); ++v)
        pulls[v] = pull(v);
      for (auto v = static_cast<std::uint32_t>(rim_); v < points_.size(); ++v) {
        Vec3 mean;
        double weight = 0;
        const double count = static_cast<double>(around[v].size());
        for (const std::uint32_t u : around[v]) {
          mean = mean + 1 / count * pulls[u];
          weight += 1 / (count * static_cast<double>(around[u].size()));
        }
        points_[v] = points_[v] - 1 / (1 + weight) * (mean - pulls[v]);
      }
    }
  }

  std::size_t rim_;
  std::span<const Vec3> beyond_;
  std::vector<Vec3> points_;
  std::vector<double> spacing_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace

FairPatch fair_patch(std::span<const Vec3> outline, std::span<const Vec3> beyond,
                     std::vector<std::array<std::uint32_t, 3>> triangles) {
  return PatchFairing(outline, beyond, std::move(triangles)).run();
}

}  // namespace fdcg::bake
