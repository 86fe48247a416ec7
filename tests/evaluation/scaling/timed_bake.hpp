// SPDX-License-Identifier: Apache-2.0
// Compiling and opening, with the clock and the process's memory in view.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::test {

// A graph compiled in memory, and what it took. Ends the program where the mesh does not compile.
class TimedBake {
 public:
  // Compiles again and again, until `least_s` seconds have passed or five times: the least time counts, and its stages.
  TimedBake(const bake::PolygonSoup& soup, const bake::CompileOptions& options, double least_s);
  ~TimedBake() { fdcg_close(&view_); }
  TimedBake(const TimedBake&) = delete;
  TimedBake& operator=(const TimedBake&) = delete;

  [[nodiscard]] const fdcg_graph& view() const { return view_; }
  [[nodiscard]] std::size_t file_bytes() const { return bytes_.size(); }
  [[nodiscard]] double seconds() const { return seconds_; }
  // The least of the process's processor time, all threads together: what else the machine does is not in it.
  [[nodiscard]] double cpu_seconds() const { return cpu_seconds_; }
  // As the compiler's progress names them, in order.
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
  // By how much the process's resident memory grew at most while the first of them ran, the file included. NaN where the system
  // does not tell.
  [[nodiscard]] double peak_bytes() const { return peak_bytes_; }

  // The least time of opening the bytes in memory, until `least_s` seconds have passed or a thousand times.
  [[nodiscard]] double open_s(fdcg_verify verify, double least_s) const;

 private:
  void bake_once(const bake::PolygonSoup& soup, bake::CompileOptions options);

  std::vector<std::byte> bytes_;
  fdcg_graph view_ = {};
  double seconds_ = 1e30, cpu_seconds_ = 1e30, peak_bytes_ = 0;
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace fdcg::test
