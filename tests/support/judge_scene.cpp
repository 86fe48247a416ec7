// SPDX-License-Identifier: Apache-2.0
#include "judge_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <unordered_map>

namespace fdcg::test {
namespace {

using bake::Vec3;

bool is_near(const Vec3& a, const Vec3& b, double tolerance) {
  const auto one = [tolerance](double x, double y) { return x == y || std::fabs(x - y) <= tolerance || (x != x && y != y); };
  return one(a.x, b.x) && one(a.y, b.y) && one(a.z, b.z);
}

bool is_same_loop(const PlacedFace& a, const PlacedFace& b, double tolerance) {
  for (std::size_t turn = 0; turn < b.size(); ++turn) {
    std::size_t k = 0;
    while (k < a.size() && is_near(a[k], b[(k + turn) % b.size()], tolerance))
      ++k;
    if (k == a.size()) return true;
  }
  return a.empty();
}

// A face's place in a grid, by the mean of its corners. Of corners that are not finite there is one place for all.
using Cell = std::array<long long, 3>;
Cell cell_of(const PlacedFace& face, double size) {
  Vec3 mean;
  const double share = 1 / static_cast<double>(std::max<std::size_t>(face.size(), 1));
  for (const Vec3& p : face)
    mean = {mean.x + p.x * share, mean.y + p.y * share, mean.z + p.z * share};
  Cell cell{};
  const std::array<double, 3> xyz = {mean.x, mean.y, mean.z};
  for (std::size_t k = 0; k < 3; ++k)
    cell[k] = std::isfinite(xyz[k]) ? std::llround(std::clamp(xyz[k] / size, -1e15, 1e15)) : 0;
  return cell;
}

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::size_t hash = 0;
    for (const long long c : cell)
      hash = (hash ^ static_cast<std::size_t>(c)) * 0x9E3779B97F4A7C15u;
    return hash;
  }
};

class Matcher {
 public:
  Matcher(const std::vector<PlacedFace>& ours, double tolerance) : ours_(ours), tolerance_(tolerance) {
    for (std::size_t f = 0; f < ours.size(); ++f)
      grid_[cell_of(ours[f], size())].push_back(f);
  }

  // Takes a face's partner out. False: it has none.
  bool take(const PlacedFace& face) {
    const Cell centre = cell_of(face, size());
    for (long long i = 0; i < 27; ++i) {
      const auto found = grid_.find({centre[0] + i % 3 - 1, centre[1] + i / 3 % 3 - 1, centre[2] + i / 9 - 1});
      if (found == grid_.end()) continue;
      std::vector<std::size_t>& there = found->second;
      const auto partner = std::find_if(there.begin(), there.end(), [&](std::size_t f) {
        return ours_[f].size() == face.size() && is_same_loop(ours_[f], face, tolerance_);
      });
      if (partner == there.end()) continue;
      there.erase(partner);
      return true;
    }
    return false;
  }

  [[nodiscard]] std::vector<std::size_t> left() const {
    std::vector<std::size_t> faces;
    for (const auto& [cell, list] : grid_)
      faces.insert(faces.end(), list.begin(), list.end());
    std::sort(faces.begin(), faces.end());
    return faces;
  }

 private:
  [[nodiscard]] double size() const { return std::max(4 * tolerance_, 1e-300); }

  const std::vector<PlacedFace>& ours_;
  double tolerance_;
  std::unordered_map<Cell, std::vector<std::size_t>, CellHash> grid_;
};

}  // namespace

std::vector<PlacedFace> faces_in_place(const bake::PolygonSoup& soup) {
  std::vector<PlacedFace> faces(soup.face_count());
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    for (std::uint32_t c = soup.face_first[f]; c < soup.face_first[f + 1]; ++c) {
      if (soup.corners[c] < soup.points.size()) faces[f].push_back(soup.points[soup.corners[c]]);
    }
    if (faces[f].size() != soup.face_first[f + 1] - soup.face_first[f]) faces[f].clear();
  }
  return faces;
}

FaceDifference compare_faces(const std::vector<PlacedFace>& ours, const std::vector<PlacedFace>& theirs, double tolerance) {
  Matcher matcher(ours, tolerance);
  FaceDifference difference;
  std::vector<std::size_t> rest;
  for (std::size_t f = 0; f < theirs.size(); ++f) {
    if (!matcher.take(theirs[f])) rest.push_back(f);
  }
  for (const std::size_t f : rest) {
    PlacedFace turned = theirs[f];
    std::reverse(turned.begin(), turned.end());
    if (matcher.take(turned)) {
      ++difference.turned;
    } else {
      difference.theirs.push_back(f);
    }
  }
  difference.ours = matcher.left();
  return difference;
}

double extent_of(const std::vector<PlacedFace>& faces) {
  double largest = 0;
  for (const PlacedFace& face : faces) {
    for (const Vec3& p : face) {
      for (const double c : {p.x, p.y, p.z}) {
        if (std::isfinite(c)) largest = std::max(largest, std::fabs(c));
      }
    }
  }
  return largest;
}

std::string shown(const PlacedFace& face) {
  std::ostringstream text;
  text.precision(9);
  for (const Vec3& p : face)
    text << '(' << p.x << ' ' << p.y << ' ' << p.z << ')';
  return text.str();
}

}  // namespace fdcg::test
