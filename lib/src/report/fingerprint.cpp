// SPDX-License-Identifier: Apache-2.0
#include "report/fingerprint.hpp"

#include <bit>
#include <cmath>

namespace fdcg::bake {
namespace {

// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every input bit reaches every output bit.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ x >> 27) * 0x94D049BB133111EBULL;
  return x ^ x >> 31;
}

std::uint64_t canonical_bits(double x) {
  constexpr std::uint64_t kNan = 0x7FF8000000000000ULL;
  return std::isnan(x) ? kNan : std::bit_cast<std::uint64_t>(static_cast<float>(x) + 0.0);  // -0 + 0 = 0
}

}  // namespace

Fingerprint::Fingerprint(std::string_view rule) : rule_(0xCBF29CE484222325ULL) {  // FNV-1a
  for (const char c : rule)
    rule_ = (rule_ ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
}

void Fingerprint::add(const Vec3& point) {
  sum_ += mixed(canonical_bits(point.x) + mixed(canonical_bits(point.y) + mixed(canonical_bits(point.z))));
}

void Fingerprint::add_missing_corner() {
  sum_ += mixed(0);
}

std::uint64_t Fingerprint::value() const {
  return mixed(rule_ ^ mixed(sum_));
}

}  // namespace fdcg::bake
