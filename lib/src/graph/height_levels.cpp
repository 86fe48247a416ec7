// SPDX-License-Identifier: Apache-2.0
#include "graph/height_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "base/parallel.hpp"

namespace fdcg::bake {
namespace {

using Wrap = HeightImage::Wrap;

constexpr std::size_t kRowGrain = 16;
// Of a level k > 0, in waves a texel of 2^(k-1) of the image's: whole up to the first, gone from the second on.
constexpr double kWhole = 1 / 4.7, kGone = 0.25;
constexpr double kDecibels = 50;         // how far down what is gone is
constexpr std::uint32_t kLeastSide = 4;  // of the last level
constexpr double kLargest = 32767;       // of a texel

struct Grid {
  std::size_t width, height;
  std::vector<float> values;

  [[nodiscard]] float* row(std::size_t y) { return values.data() + y * width; }
  [[nodiscard]] const float* row(std::size_t y) const { return values.data() + y * width; }
};

std::size_t wrapped(std::int64_t at, std::size_t side, Wrap wrap) {
  const auto size = static_cast<std::int64_t>(side);
  if (wrap == Wrap::clamp) return static_cast<std::size_t>(std::clamp<std::int64_t>(at, 0, size - 1));
  const std::int64_t period = wrap == Wrap::mirror ? 2 * size : size;
  std::int64_t in = at % period;
  if (in < 0) in += period;
  return static_cast<std::size_t>(in < size ? in : period - 1 - in);
}

// J. F. Kaiser's window, 1 in the middle, x from -1 to 1.
double kaiser(double x) {
  const double beta = 0.5842 * std::pow(kDecibels - 21, 0.4) + 0.07886 * (kDecibels - 21);
  const auto bessel = [](double z) {
    double sum = 1, term = 1;
    for (int n = 1; n < 40; ++n)
      sum += term *= (z / (2 * n)) * (z / (2 * n));
    return sum;
  };
  return x * x >= 1 ? 0 : bessel(beta * std::sqrt(1 - x * x)) / bessel(beta);
}

// Weights of source texels for one texel of a level.
struct Window {
  std::vector<std::size_t> at;
  std::vector<double> weight;
};

// Along a side of `image` texels, from `source` texels to `count`, by a low-pass for texels of `size` of the image's.
std::vector<Window> windows(std::size_t image, std::size_t source, std::size_t count, double size, Wrap wrap) {
  const double cut = (kWhole + kGone) / 2 / size;  // waves a texel of the image
  const double reach = (kDecibels - 8) / (2.285 * 2 * std::numbers::pi * (kGone - kWhole)) / 2 * size;
  const double step = static_cast<double>(image) / static_cast<double>(source);
  std::vector<Window> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * static_cast<double>(image) / static_cast<double>(count);
    const auto first = static_cast<std::int64_t>(std::ceil((middle - reach) / step - 0.5));
    const auto last = static_cast<std::int64_t>(std::floor((middle + reach) / step - 0.5));
    double sum = 0;
    for (std::int64_t j = first; j <= last; ++j) {
      const double away = (static_cast<double>(j) + 0.5) * step - middle, turns = 2 * std::numbers::pi * cut * away;
      const double sinc = std::fabs(turns) < 1e-9 ? 1 : std::sin(turns) / turns;
      all[i].at.push_back(wrapped(j, source, wrap));
      all[i].weight.push_back(sinc * kaiser(away / reach));
      sum += all[i].weight.back();
    }
    for (double& weight : all[i].weight)
      weight /= sum;
  }
  return all;
}

Grid filtered(const Grid& from, const std::vector<Window>& columns, const std::vector<Window>& rows, unsigned jobs) {
  Grid across{columns.size(), from.height, std::vector<float>(columns.size() * from.height)};
  parallel_for(jobs, from.height, kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const float* const source = from.row(y);
      for (std::size_t x = 0; x < columns.size(); ++x) {
        double sum = 0;
        for (std::size_t k = 0; k < columns[x].at.size(); ++k)
          sum += columns[x].weight[k] * double{source[columns[x].at[k]]};
        across.row(y)[x] = static_cast<float>(sum);
      }
    }
  });
  Grid to{columns.size(), rows.size(), std::vector<float>(columns.size() * rows.size())};
  parallel_for(jobs, rows.size(), kRowGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<double> sums(to.width);
    for (std::size_t y = begin; y < end; ++y) {
      std::fill(sums.begin(), sums.end(), 0.0);
      for (std::size_t k = 0; k < rows[y].at.size(); ++k) {
        const float* const source = across.row(rows[y].at[k]);
        for (std::size_t x = 0; x < to.width; ++x)
          sums[x] += rows[y].weight[k] * double{source[x]};
      }
      std::transform(sums.begin(), sums.end(), to.row(y), [](double sum) { return static_cast<float>(sum); });
    }
  });
  return to;
}

// In place: coefficients of the spline of third degree through a line of values (M. Unser, "Splines: a perfect fit for signal
// and image processing", 1999). What is beyond the ends decides by 1e-18 of itself and less.
void to_spline(std::vector<double>& line, Wrap wrap) {
  constexpr std::size_t kBeyond = 32;
  const double pole = std::numbers::sqrt3 - 2, gain = 6;
  const Wrap how = wrap == Wrap::repeat ? Wrap::repeat : Wrap::mirror;  // so that the border's coefficient lies beyond it, too
  std::vector<double> longer(line.size() + 2 * kBeyond);
  for (std::size_t i = 0; i < longer.size(); ++i)
    longer[i] = gain * line[wrapped(static_cast<std::int64_t>(i) - static_cast<std::int64_t>(kBeyond), line.size(), how)];
  for (std::size_t i = 1; i < longer.size(); ++i)
    longer[i] += pole * longer[i - 1];
  longer.back() *= pole / (pole * pole - 1);
  for (std::size_t i = longer.size() - 1; i-- > 0;)
    longer[i] = pole * (longer[i + 1] - longer[i]);
  std::copy_n(longer.begin() + kBeyond, line.size(), line.begin());
}

Grid spline_of(Grid grid, const std::array<Wrap, 2>& wrap, unsigned jobs) {
  parallel_for(jobs, grid.height, kRowGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<double> line(grid.width);
    for (std::size_t y = begin; y < end; ++y) {
      std::copy_n(grid.row(y), grid.width, line.begin());
      to_spline(line, wrap[0]);
      std::transform(line.begin(), line.end(), grid.row(y), [](double value) { return static_cast<float>(value); });
    }
  });
  parallel_for(jobs, grid.width, kRowGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<double> line(grid.height);
    for (std::size_t x = begin; x < end; ++x) {
      for (std::size_t y = 0; y < grid.height; ++y)
        line[y] = double{grid.row(y)[x]};
      to_spline(line, wrap[1]);
      for (std::size_t y = 0; y < grid.height; ++y)
        grid.row(y)[x] = static_cast<float>(line[y]);
    }
  });
  return grid;
}

// About the mean: that is where the mesh is.
Grid heights_of(const HeightImage& image) {
  double sum = 0;
  for (const float value : image.values)
    sum += double{value};
  const double mean = sum / static_cast<double>(image.values.size());
  Grid grid{image.width, image.height, image.values};
  for (float& value : grid.values)
    value = static_cast<float>(double{value} - mean);
  return grid;
}

}  // namespace

HeightLevels height_levels(const HeightImage& image, double range_m, unsigned jobs) {
  std::vector<Grid> splines;
  Grid level = heights_of(image);
  splines.push_back(spline_of(level, image.wrap, jobs));
  for (std::size_t width = image.width, height = image.height, size = 1; splines.size() < FDCG_MAX_HEIGHT_LEVELS;
       width = (width + 1) / 2, height = (height + 1) / 2, size *= 2) {
    const auto texel = static_cast<double>(size);
    level = filtered(level, windows(image.width, level.width, width, texel, image.wrap[0]),
                     windows(image.height, level.height, height, texel, image.wrap[1]), jobs);
    splines.push_back(spline_of(level, image.wrap, jobs));
    if (std::max(width, height) <= kLeastSide) break;
  }
  float largest = 0;
  for (const Grid& grid : splines)
    for (const float value : grid.values)
      largest = std::max(largest, std::fabs(value));
  HeightLevels result;
  result.map.metres_per_step = double{largest} * std::fabs(range_m) / kLargest;
  result.map.width = image.width;
  result.map.height = image.height;
  result.map.level_count = static_cast<std::uint32_t>(splines.size());
  for (std::size_t k = 0; k < 2; ++k)
    result.map.wrap[k] = static_cast<std::uint32_t>(image.wrap[k]);
  const double scale = largest > 0 ? std::copysign(kLargest, range_m) / double{largest} : 0;
  for (const Grid& grid : splines)
    for (const float value : grid.values)
      result.texels.push_back(static_cast<std::int16_t>(std::lround(scale * double{value})));
  return result;
}

}  // namespace fdcg::bake
