// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_game.hpp"

#include <algorithm>
#include <cmath>

namespace fdcg::grasp {
namespace {

constexpr std::size_t kRows = kDimensions + 1;  // a row for each direction, one for the sum of weights
using Row = std::array<double, kRows>;
using Matrix = std::array<Row, kRows>;

// In place, by Gauss and Jordan with row pivots. False where it is singular.
bool invert(Matrix& m, std::size_t n) {
  Matrix inverse{};
  for (std::size_t i = 0; i < n; ++i)
    inverse[i][i] = 1;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < n; ++r) {
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    }
    if (!(std::abs(m[pivot][c]) > 1e-14)) return false;  // entries are of order one
    std::swap(m[c], m[pivot]);
    std::swap(inverse[c], inverse[pivot]);
    const double factor = 1 / m[c][c];
    for (std::size_t k = 0; k < n; ++k) {
      m[c][k] *= factor;
      inverse[c][k] *= factor;
    }
    for (std::size_t r = 0; r < n; ++r) {
      const double times = m[r][c];
      if (r == c || times == 0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        m[r][k] -= times * m[c][k];
        inverse[r][k] -= times * inverse[c][k];
      }
    }
  }
  m = inverse;
  return true;
}

// The primal simplex. Variables: t (free, always in the basis), a weight for each wrench, a surplus for each direction.
// Rows j < n: sum of weight * (wrench.g_j) - surplus_j - t = 0; row n: weights sum to 1. Largest t.
class Simplex {
 public:
  Simplex(const Body& body, std::span<const Vec6> directions) : body_(body), directions_(directions), n_(directions.size()) {}

  GameResult run(const Vec6& start, const Vec6& start_at, const GameOptions& options);

 private:
  struct Member {
    enum class Kind { t, weight, surplus } kind = Kind::t;
    std::size_t direction = 0;  // of a surplus
    Column column{};            // of a weight
    Row coefficients{};
  };

  [[nodiscard]] Member make_weight(const Vec6& wrench, const Vec6& at) const {
    Member member{Member::Kind::weight, 0, {wrench, at, 0}, {}};
    for (std::size_t j = 0; j < n_; ++j)
      member.coefficients[j] = dot(wrench, directions_[j]);
    member.coefficients[n_] = 1;
    return member;
  }
  [[nodiscard]] Member make_surplus(std::size_t j) const {
    Member member{Member::Kind::surplus, j, {}, {}};
    member.coefficients[j] = -1;
    return member;
  }
  void begin(const Vec6& start, const Vec6& start_at);
  bool refresh();        // inverse, values, prices
  void update_bounds();  // from the values and prices
  bool exchange(const Member& entering);

  const Body& body_;
  std::span<const Vec6> directions_;
  std::size_t n_;
  std::array<Member, kRows> basis_{};
  Matrix inverse_{};
  Row values_{}, prices_{};
  Vec6 best_at_{};  // the direction that the prices make
  SupportPoint best_{};
  GameResult result_;
};

void Simplex::begin(const Vec6& start, const Vec6& start_at) {
  const Member weight = make_weight(start, start_at);
  std::size_t least = 0;
  for (std::size_t j = 1; j < n_; ++j) {
    if (weight.coefficients[j] < weight.coefficients[least]) least = j;
  }
  basis_[0] = {};
  for (std::size_t j = 0; j < n_; ++j)
    basis_[0].coefficients[j] = -1;
  basis_[1] = weight;
  for (std::size_t j = 0, at = 2; j < n_; ++j) {
    if (j != least) basis_[at++] = make_surplus(j);
  }
  result_.lower = -std::numeric_limits<double>::infinity();
  result_.upper = std::numeric_limits<double>::infinity();
}

bool Simplex::refresh() {
  Matrix inverse{};
  for (std::size_t c = 0; c <= n_; ++c) {
    for (std::size_t r = 0; r <= n_; ++r)
      inverse[r][c] = basis_[c].coefficients[r];
  }
  if (!invert(inverse, n_ + 1)) return false;
  inverse_ = inverse;
  for (std::size_t c = 0; c <= n_; ++c) {
    values_[c] = inverse_[c][n_];  // the right-hand side is (0, .., 0, 1)
    prices_[c] = inverse_[0][c];   // the cost is that of t alone
  }
  return true;
}

void Simplex::update_bounds() {
  // lower: the weights are not negative, so they give a wrench of the body whatever their rounding
  double sum = 0;
  Vec6 wrench{};
  for (std::size_t c = 1; c <= n_; ++c) {
    if (basis_[c].kind == Member::Kind::weight) sum += std::max(0.0, values_[c]);
  }
  for (std::size_t c = 1; c <= n_; ++c) {
    if (basis_[c].kind == Member::Kind::weight) add_scaled(wrench, std::max(0.0, values_[c]) / sum, basis_[c].column.wrench);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Vec6& g : directions_)
    least = std::min(least, dot(wrench, g));
  if (sum > 0 && least > result_.lower) {
    result_.lower = least;
    result_.wrench = wrench;
    result_.column_count = 0;
    for (std::size_t c = 1; c <= n_; ++c) {
      if (basis_[c].kind != Member::Kind::weight) continue;
      Column& column = result_.columns[result_.column_count++];
      column = basis_[c].column;
      column.weight = std::max(0.0, values_[c]) / sum;
    }
  }
  // upper: weights of the directions, not negative
  double total = 0;
  std::array<double, kRows> shares{};
  for (std::size_t j = 0; j < n_; ++j)
    total += shares[j] = std::max(0.0, -prices_[j]);
  Vec6 direction{};
  for (std::size_t j = 0; j < n_; ++j)
    add_scaled(direction, shares[j] /= total, directions_[j]);
  best_at_ = direction;  // kept bit for bit: where supports are equal, rounding decides which contact presses
  best_ = body_.support(direction);
  if (total > 0 && best_.value < result_.upper) {
    result_.upper = best_.value;
    result_.direction = direction;
    result_.shares = shares;
  }
}

// The ratio test: the entering variable replaces the one that reaches zero first.
bool Simplex::exchange(const Member& entering) {
  std::size_t leaving = 0;
  double step = std::numeric_limits<double>::infinity(), pivot = 0;
  for (std::size_t c = 1; c <= n_; ++c) {
    double falls = 0;
    for (std::size_t r = 0; r <= n_; ++r)
      falls += inverse_[c][r] * entering.coefficients[r];
    if (!(falls > 1e-11)) continue;
    const double ratio = std::max(0.0, values_[c]) / falls;
    if (ratio < step * (1 - 1e-12) || (ratio <= step && falls > pivot)) step = ratio, leaving = c, pivot = falls;
  }
  if (leaving == 0) return false;
  basis_[leaving] = entering;
  return true;
}

GameResult Simplex::run(const Vec6& start, const Vec6& start_at, const GameOptions& options) {
  begin(start, start_at);
  for (int pivot = 0; pivot < options.max_pivots && refresh(); ++pivot) {
    update_bounds();
    if (result_.lower >= options.prune_above || result_.upper < options.open_below) break;
    if (result_.upper - result_.lower <= options.gap) break;
    std::size_t cheapest = n_;
    for (std::size_t j = 0; j < n_; ++j) {
      if (prices_[j] > 1e-12 && (cheapest == n_ || prices_[j] > prices_[cheapest])) cheapest = j;
    }
    // Negative weights first: the prices give a direction only if there are none.
    const bool is_surplus = cheapest < n_;
    if (!is_surplus && !(best_.value > prices_[n_])) break;  // no wrench improves
    if (!exchange(is_surplus ? make_surplus(cheapest) : make_weight(best_.wrench, best_at_))) break;
  }
  return result_;
}

}  // namespace

GameResult play(const Body& body, std::span<const Vec6> directions, const Vec6& start, const Vec6& start_at,
                const GameOptions& options) {
  return Simplex(body, directions).run(start, start_at, options);
}

std::array<Vec6, kDimensions> around(const Vec6& unit_direction, double reach, std::size_t dimensions) {
  // A reflection takes the first axis to the direction; the corners are those of a regular simplex in the other axes.
  Vec6 mirror = unit_direction;
  const double sign = mirror[0] > 0 ? 1 : -1;
  mirror[0] += sign;
  const double squared = dot(mirror, mirror);
  const auto reflect = [&](Vec6 v) {
    add_scaled(v, -2 * dot(mirror, v) / squared, mirror);
    return v;
  };
  std::array<Vec6, kDimensions> corners{};
  const auto n = dimensions - 1;  // corners j <= n in n coordinates, each at distance 1 from the origin, sum zero
  for (std::size_t j = 0; j <= n; ++j) {
    Vec6 s{};
    double left = 1;  // of the squared length
    for (std::size_t k = 0; k < std::min(j + 1, n); ++k) {
      const auto rest = static_cast<double>(n - k);
      const double head = std::sqrt(left);
      s[k + 1] = k == j ? head : -head / rest;
      left *= 1 - 1 / (rest * rest);
    }
    corners[j] = scaled(reach, reflect(s));
    add_scaled(corners[j], 1, unit_direction);
  }
  return corners;
}

}  // namespace fdcg::grasp
