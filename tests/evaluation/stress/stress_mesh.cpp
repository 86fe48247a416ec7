// SPDX-License-Identifier: Apache-2.0
#include "stress_mesh.hpp"

#include <stdexcept>
#include <utility>

#include "contact_rig.hpp"

namespace fdcg::test {
namespace {

bake::PolygonSoup mesh;
bool is_closed = false;

Body mesh_body(Random& random, bake::Precision precision) {
  Body body;
  body.soup = mesh;
  body.focus = {random.below(static_cast<std::uint32_t>(mesh.points.size())),
                random.below(static_cast<std::uint32_t>(mesh.points.size()))};
  body.options.precision = precision;
  body.options.store_planes = random.chance(0.5);
  body.options.jobs = 1;
  body.options.without = {"source-map", "info"};
  body.is_closed = is_closed;
  body.description = mesh.name + (body.options.store_planes ? "" : ", planes derived");
  return body;
}

}  // namespace

const StressCase& mesh_case(const std::string& file) {
  auto read = bake::import_mesh(file);
  if (!read) throw std::runtime_error(read.error().message);
  mesh = std::move(*read);
  is_closed = CompiledMesh(mesh).view().header->connection_type_count[FDCG_BOUNDARY] == 0;
  using enum Motion;
  static const StressCase made = {
      "mesh", "as the mesh, up to the stated deviation", mesh_body, {wander, slide, dive, on_planes, aim, jump}, true, 50};
  return made;
}

}  // namespace fdcg::test
