// SPDX-License-Identifier: Apache-2.0
// Contenders that others bring: docs/rivals.md.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "contender.hpp"

namespace fdcg::test {

// A shared object with fdcg_rival_get (rivals/fdcg_rival.h), by its path. Throws std::runtime_error: it cannot be opened,
// speaks another ABI, says nothing of itself, or cannot load the body. step() throws where an answer is not finite.
std::unique_ptr<Contender> make_rival_of_library(const std::string& path, const bake::PolygonSoup& soup);

// A process that reads and writes lines, by its command, which a shell starts. It ends with its contender. Throws as above, and
// where the process ends or is silent for a minute (ten while it loads).
std::unique_ptr<Contender> make_rival_of_pipe(const std::string& command, const bake::PolygonSoup& soup);

// "pipe:COMMAND" or a path.
std::unique_ptr<Contender> make_rival(const std::string& specification, const bake::PolygonSoup& soup);

// What rivals get of a body: faces cut into fans, in order.
struct RivalMesh {
  std::vector<double> points_m;
  std::vector<std::uint32_t> corners;
  explicit RivalMesh(const bake::PolygonSoup& soup);
};

// Throws std::runtime_error where a name is not letters, digits and _, or the family is fdcg's.
void check_rival(const std::string& specification, const ContenderInfo& info);
// Throws std::runtime_error, naming the rival and the HIP, where a number is not finite.
void check_answer(const ContenderInfo& info, const Ground::Point& hip_m, const Feel& feel);

}  // namespace fdcg::test
