// SPDX-License-Identifier: Apache-2.0
// Triangulation of any closed outline in space on its own corners.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// The most corners; the time is cubic in them: some 0.1 s.
inline constexpr std::size_t kMostLeastAreaCorners = 400;

// Of all triangulations of the outline without a new corner one of least area, after Barequet and Sharir (1995). No triangle
// has collinear corners. `is_barred(i, j)`: a diagonal that is taken only where nothing else is possible. Empty where there is
// none, or too many corners.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> least_area_triangles(
    std::span<const Vec3> outline, const std::function<bool(std::uint32_t, std::uint32_t)>& is_barred);

}  // namespace fdcg::bake
