// SPDX-License-Identifier: Apache-2.0
// Neighbours' heights differ by the integral of a cubic through four slopes; the least squares of that are Poisson's equation
// on the grid, which harmonics take apart (as R. Frankot and R. Chellappa 1988, with free borders too).
#include "import/slope_integral.hpp"

#include <algorithm>

#include "base/harmonics.hpp"

namespace fdcg::bake {
namespace {

// From place i of a line to the next one; `at(j)` is the slope of place j.
template <class At>
double rise_after(std::size_t i, std::size_t count, bool repeats, const At& at) {
  if (repeats || (i > 0 && i + 2 < count)) {
    const double inner = at(i) + at((i + 1) % count);
    return (13 * inner - (at((i + count - 1) % count) + at((i + 2) % count))) / 24;
  }
  if (count == 2) return (at(0) + at(1)) / 2;
  const std::size_t a = i == 0 ? 0 : count - 1, b = i == 0 ? 1 : count - 2, c = i == 0 ? 2 : count - 3;
  return (5 * at(a) + 8 * at(b) - at(c)) / 12;  // a parabola through the three at the border
}

// Adds to each place's equation what the slopes of a line say.
template <class At, class Add>
void add_line(std::size_t count, bool repeats, double weight, const At& at, const Add& add) {
  const std::size_t rises = repeats ? count : count - 1;
  for (std::size_t i = 0; i < rises; ++i) {
    const double rise = weight * rise_after(i, count, repeats, at);
    add(i, -rise);
    add((i + 1) % count, rise);
  }
}

}  // namespace

std::vector<double> integrate_slopes(const SlopeGrid& slopes) {
  const std::size_t width = slopes.width, height = slopes.height;
  const double weights[2] = {1 / (slopes.step[0] * slopes.step[0]), 1 / (slopes.step[1] * slopes.step[1])};
  std::vector<double> heights(width * height, 0.0);
  for (std::size_t y = 0; y < height; ++y) {
    add_line(
        width, slopes.repeats[0], weights[0], [&](std::size_t x) { return double{slopes.along[y * width + x]}; },
        [&](std::size_t x, double by) { heights[y * width + x] += by; });
  }
  for (std::size_t x = 0; x < width; ++x) {
    add_line(
        height, slopes.repeats[1], weights[1], [&](std::size_t y) { return double{slopes.down[y * width + x]}; },
        [&](std::size_t y, double by) { heights[y * width + x] += by; });
  }
  const auto ends = [](bool repeats) { return repeats ? Harmonics::Ends::joined : Harmonics::Ends::free; };
  const Harmonics columns(width, ends(slopes.repeats[0])), rows(height, ends(slopes.repeats[1]));
  for (std::size_t y = 0; y < height; ++y)
    columns.forward(heights.data() + y * width);
  std::vector<double> line(height);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t y = 0; y < height; ++y)
      line[y] = heights[y * width + x];
    rows.forward(line.data());
    const double across = weights[0] * columns.stiffness(x);
    for (std::size_t y = 0; y < height; ++y) {
      const double stiffness = across + weights[1] * rows.stiffness(y);
      line[y] = stiffness > 0 ? line[y] / stiffness : 0;  // of the mean nothing is said
    }
    rows.backward(line.data());
    for (std::size_t y = 0; y < height; ++y)
      heights[y * width + x] = line[y];
  }
  for (std::size_t y = 0; y < height; ++y)
    columns.backward(heights.data() + y * width);
  return heights;
}

}  // namespace fdcg::bake
