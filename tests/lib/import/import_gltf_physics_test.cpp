// SPDX-License-Identifier: Apache-2.0
// glTF's KHR_physics_rigid_bodies and KHR_implicit_shapes: materials, masses, and shapes by formula.
#include <cmath>

#include "../../support/gltf_scene.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using fdcg::test::GltfScene;
using fdcg::test::Json;
using fdcg::test::square_mesh;

namespace {

constexpr const char* kBodies = "KHR_physics_rigid_bodies";
constexpr const char* kShapes = "KHR_implicit_shapes";

Json with_physics(Json node, const Json& physics) {
  node["extensions"][kBodies] = physics;
  return node;
}

GltfScene scene_of(const std::vector<Json>& shapes, GltfScene scene = {}) {
  scene.json["extensions"][kShapes]["shapes"] = shapes;
  scene.json["extensionsRequired"] = {kBodies, kShapes};
  return scene;
}

Json collider(std::size_t shape) {
  return {{"collider", {{"geometry", {{"shape", shape}}}}}};
}

// The scene has a node of this transform whose collider is the shape, beside a mesh.
StatedShape placed(const Json& shape, const Json& node) {
  GltfScene scene = scene_of({shape}, square_mesh());
  scene.node({{"mesh", 0}});
  scene.node(with_physics(node, collider(0)));
  const PolygonSoup soup = import_text(scene.text());
  REQUIRE(soup.physics.shapes.size() == 1);
  return soup.physics.shapes[0];
}

// Where a pose takes a point.
Vec3 moved_by(const StatedShape& shape, const Vec3& p) {
  const auto [x, y, z, w] = shape.rotation_xyzw;
  const Vec3 t{2 * (y * p.z - z * p.y), 2 * (z * p.x - x * p.z), 2 * (x * p.y - y * p.x)};
  return {p.x + w * t.x + y * t.z - z * t.y + shape.translation_m[0],
          p.y + w * t.y + z * t.x - x * t.z + shape.translation_m[1],
          p.z + w * t.z + x * t.y - y * t.x + shape.translation_m[2]};
}

bool is_near(const Vec3& a, const Vec3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) < 1e-14;
}

}  // namespace

TEST_CASE("glTF physics: materials have the format's defaults where the file says nothing") {
  GltfScene scene = fdcg::test::square();
  scene.json["extensions"][kBodies]["physicsMaterials"] = {{{"name", "rubber"},
                                                            {"staticFriction", 0.9},
                                                            {"dynamicFriction", 0.8},
                                                            {"restitution", 0.25},
                                                            {"frictionCombine", "multiply"}},
                                                           Json::object()};
  const StatedPhysics physics = import_text(scene.text()).physics;
  REQUIRE(physics.materials.size() == 2);
  CHECK(physics.materials[0].name == "rubber");
  CHECK(physics.materials[0].static_friction == 0.9);
  CHECK(physics.materials[0].dynamic_friction == 0.8);
  CHECK(physics.materials[0].restitution == 0.25);
  CHECK(physics.materials[0].friction_combine == "multiply");
  CHECK(physics.materials[0].restitution_combine.empty());
  CHECK(physics.materials[1].name == "physicsMaterials[1]");
  CHECK(physics.materials[1].static_friction == 0.6);
  CHECK(physics.materials[1].restitution == 0);
  CHECK(import_text(fdcg::test::square().text()).physics.is_empty());
}

TEST_CASE("glTF physics: faces have the material of their collider, of what names them, or of their body") {
  GltfScene scene = square_mesh();
  scene.json["extensions"][kBodies]["physicsMaterials"] = {{{"name", "ice"}}, {{"name", "wood"}}, {{"name", "cork"}}};
  scene.json["materials"] = {{{"name", "seen"}}};
  scene.json["meshes"][0]["primitives"][0]["material"] = 0;
  const auto of = [](std::size_t material, const Json& geometry = Json::object()) {
    return Json{{"collider", {{"geometry", geometry}, {"physicsMaterial", material}}}};
  };
  scene.node(with_physics({{"mesh", 0}, {"name", "own"}}, of(0)));
  scene.node({{"mesh", 0}, {"name", "named"}});
  scene.node(with_physics({{"name", "namer"}}, of(1, {{"node", 1}})));
  scene.node({{"mesh", 0}, {"name", "in the body"}}, false);
  scene.node(with_physics({{"name", "shape of the body"}}, of(2)), false);
  scene.node(with_physics({{"name", "body"}, {"children", {3, 4}}}, {{"motion", {{"mass", 5}}}}));
  scene.node({{"mesh", 0}, {"name", "plain"}});
  const PolygonSoup soup = import_text(scene.text());
  std::vector<std::string> found;
  for (const Part& part : soup.parts)
    found.push_back(part.name.substr(0, part.name.find('/')) + ": " + soup.materials[soup.face_material[part.first_face]]);
  CHECK(found == std::vector<std::string>{"own: ice", "named: wood", "in the body: cork", "plain: seen"});
  REQUIRE(soup.physics.bodies.size() == 1);
  CHECK(soup.physics.bodies[0].node == "body");
  CHECK(soup.physics.bodies[0].mass_kg == 5);
}

TEST_CASE("glTF physics: two materials in a body leave its other meshes as they are seen") {
  GltfScene scene = square_mesh();
  scene.json["extensions"][kBodies]["physicsMaterials"] = {{{"name", "ice"}}, {{"name", "wood"}}};
  for (const int material : {0, 1})
    scene.node(with_physics({}, {{"collider", {{"geometry", Json::object()}, {"physicsMaterial", material}}}}), false);
  scene.node({{"mesh", 0}}, false);
  scene.node(with_physics({{"children", {0, 1, 2}}}, {{"motion", Json::object()}}));
  CHECK(import_text(scene.text()).materials.empty());
}

TEST_CASE("glTF physics: a mass of 0 is without end, and a centre of mass moves with its node") {
  GltfScene scene = square_mesh();
  scene.node({{"mesh", 0}});
  scene.node(with_physics({{"name", "heavy"}, {"translation", {1, 2, 3}}, {"rotation", {0, 0, 1, 0}}},
                          {{"motion", {{"mass", 0}, {"centerOfMass", {1, 0, 0}}}}}));
  const std::vector<PhysicsBody> bodies = import_text(scene.text()).physics.bodies;
  REQUIRE(bodies.size() == 1);
  CHECK(bodies[0].mass_kg == 0);
  CHECK(bodies[0].is_kinematic);
  CHECK(bodies[0].centre_of_mass_m == std::array<double, 3>{0, 2, 3});
}

TEST_CASE("glTF shapes: without a mesh a box is its six faces, where its node is") {
  GltfScene scene = scene_of({{{"type", "box"}, {"box", {{"size", {2, 4, 6}}}}}, {{"type", "sphere"}}});
  scene.json["extensions"][kBodies]["physicsMaterials"] = {{{"name", "wood"}}};
  Json wooden = collider(0);
  wooden["collider"]["physicsMaterial"] = 0;
  scene.node(with_physics({{"name", "crate"}, {"translation", {10, 0, 0}}}, wooden));
  scene.node(with_physics({{"scale", {-1, 1, 1}}}, collider(0)));
  scene.node(with_physics({}, collider(1)));
  const PolygonSoup soup = import_text(scene.text());
  check_invariants(soup);
  CHECK(soup.face_count() == 12);
  REQUIRE(soup.points.size() == 16);
  CHECK(soup.points[0] == Vec3{9, -2, -3});
  CHECK(soup.points[7] == Vec3{11, 2, 3});
  double volume = 0;
  for (const auto& face : faces_of(soup)) {
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      const Vec3 a = soup.points[face[0]], b = soup.points[face[k]], c = soup.points[face[k + 1]];
      volume += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
    }
  }
  CHECK(volume / 6 == Approx(2 * 48));
  CHECK(soup.materials == std::vector<std::string>{"wood"});
  CHECK(soup.parts[0].name == "crate/box");
  CHECK(ignored_of(soup) == std::vector<std::string>{"shapes of colliders that have no faces: 1"});
  REQUIRE(soup.physics.shapes.size() == 3);
  CHECK(soup.physics.shapes[0].has_faces);
  CHECK_FALSE(soup.physics.shapes[2].has_faces);
}

TEST_CASE("glTF shapes: beside a mesh they are surfaces of a scene, with their pose") {
  const StatedShape ball =
      placed({{"type", "sphere"}, {"sphere", {{"radius", 0.5}}}}, {{"scale", {2, 2, 2}}, {"translation", {1, 2, 3}}});
  CHECK(surface_json(ball) == R"({"kind":"sphere","radius_m":1})");
  CHECK(ball.translation_m == std::array<double, 3>{1, 2, 3});
  CHECK(surface_json(placed({{"type", "sphere"}}, {{"scale", {1, 2, 3}}})) == R"({"kind":"ellipsoid","half_m":[0.5,1,1.5]})");
  CHECK(surface_json(placed({{"type", "box"}, {"box", {{"size", {1, 2, 3}}}}}, {{"scale", {2, 2, 1}}})) ==
        R"({"kind":"box","half_m":[1,2,1.5]})");
  const Json pillar = {{"type", "cylinder"}, {"cylinder", {{"height", 3}, {"radiusBottom", 0.5}, {"radiusTop", 0.5}}}};
  CHECK(surface_json(placed(pillar, Json::object())) == R"({"kind":"cylinder","radius_m":0.5,"length_m":3})");
  CHECK(surface_json(placed({{"type", "capsule"}}, Json::object())) == R"({"kind":"capsule","radius_m":0.25,"length_m":0.5})");
  CHECK(surface_json(placed({{"type", "plane"}}, Json::object())) == R"({"kind":"plane"})");
  const StatedShape cone = placed({{"type", "cylinder"}, {"cylinder", {{"height", 1}, {"radiusBottom", 1}, {"radiusTop", 0}}}},
                                  {{"translation", {5, 0, 0}}});
  CHECK(surface_json(cone) == R"({"kind":"cone","radius_m":1,"top_radius_m":0,"length_m":1})");
  CHECK(is_near(moved_by(cone, {0, 0, 0.5}), {5, 0.5, 0}));  // its top is along the file's y
}

TEST_CASE("glTF shapes: the pose is the node's, turned, mirrored or not") {
  const Json pillar = {{"type", "cylinder"}, {"cylinder", {{"height", 2}, {"radiusBottom", 1}, {"radiusTop", 0.5}}}};
  for (const std::array<double, 4>& q :
       {std::array<double, 4>{0.5, 0.5, 0.5, 0.5}, {0.6, 0, 0, 0.8}, {0, 1, 0, 0}, {0, 0, 0.8, -0.6}}) {
    for (const double mirror : {1.0, -1.0}) {
      const StatedShape shape = placed(pillar, {{"rotation", q}, {"scale", {mirror, 1, 1}}, {"translation", {1, 2, 3}}});
      CAPTURE(q[0], q[1], q[2], q[3], mirror);
      const auto [x, y, z, w] = q;
      const Vec3 top{2 * (x * y - w * z) + 1, 1 - 2 * (x * x + z * z) + 2, 2 * (y * z + w * x) + 3};  // of (0, 1, 0)
      CHECK(is_near(moved_by(shape, {0, 0, 1}), top));
      const auto [a, b, c, d] = shape.rotation_xyzw;
      CHECK(a * a + b * b + c * c + d * d == Approx(1).epsilon(1e-14));
    }
  }
}

TEST_CASE("glTF shapes: what no surface has is said") {
  const auto problem = [](const Json& shape, const Json& node = Json::object()) { return placed(shape, node).problem; };
  const Json tapered = {{"type", "capsule"}, {"capsule", {{"radiusTop", 0.5}}}};
  CHECK(problem(tapered) == "is a capsule of two radii");
  CHECK(problem({{"type", "capsule"}}, {{"scale", {1, 2, 1}}}) == "is a capsule stretched along its axis");
  CHECK(problem({{"type", "cylinder"}}, {{"scale", {1, 1, 2}}}).starts_with("is stretched across its axis"));
  CHECK(problem({{"type", "plane"}, {"plane", {{"sizeX", 1}, {"sizeZ", 2}}}}).starts_with("is a plane with an end"));
  CHECK(problem({{"type", "torus"}}).starts_with("is of the kind 'torus'"));
  CHECK(problem({{"type", "box"}}, {{"matrix", {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}).starts_with("is sheared"));
  GltfScene scene = scene_of({{{"type", "sphere"}}});
  scene.node(with_physics({{"name", "ball"}}, collider(0)));
  CHECK(refusal(scene.text()) ==
        "mesh: holds no mesh but a shape of node 'ball', which has no faces; a scene of fdcg-servo has it as "
        "\"surface\": {\"kind\":\"sphere\",\"radius_m\":0.5}");
}

TEST_CASE("glTF physics: what is wrong in it is left out with a word, and the mesh is read") {
  const auto ignored = [](const Json& extension) {
    GltfScene scene = fdcg::test::square();
    scene.json["extensions"] = extension;
    const PolygonSoup soup = import_text(scene.text());
    CHECK(soup.physics.is_empty());
    REQUIRE(soup.ignored.size() == 1);
    return soup.ignored[0].what;
  };
  CHECK(ignored({{kBodies, {{"physicsMaterials", {{{"staticFriction", -1}}}}}}})
            .find("physicsMaterials[0].staticFriction is -1") != std::string::npos);
  CHECK(ignored({{kShapes, {{"shapes", {{{"type", "sphere"}, {"sphere", {{"radius", 0}}}}}}}}}).find("radius is 0") !=
        std::string::npos);
  CHECK(ignored({{kBodies, 7}}).starts_with("physics extensions left out, since"));
}

TEST_CASE("glTF: required extensions that leave the triangles alone are no reason to refuse") {
  for (const char* const name :
       {"KHR_physics_rigid_bodies", "KHR_implicit_shapes", "EXT_mesh_manifold", "KHR_materials_unlit", "KHR_texture_transform",
        "KHR_lights_punctual", "KHR_mesh_quantization", "KHR_xmp_json_ld", "EXT_texture_webp", "KHR_technique_webgl",
        "KHR_animation_pointer", "KHR_node_visibility", "EXT_structural_metadata"}) {
    CAPTURE(name);
    GltfScene scene = fdcg::test::square();
    scene.json["extensionsRequired"] = {name};
    CHECK(import_text(scene.text()).face_count() == 2);
  }
  GltfScene scene = fdcg::test::square();
  scene.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  CHECK(refusal(scene.text()).find("EXT_mesh_gpu_instancing, which may change the triangles") != std::string::npos);
}
