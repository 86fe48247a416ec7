// SPDX-License-Identifier: Apache-2.0
// Scenes: objects with poses, fingers that feel all of them.
#include "fdcg/scene.h"

#include <algorithm>
#include <memory>

#include "bind.hpp"
#include "fdcg/surface.h"

namespace fdcg::python {
namespace {

// A scene, its memory, and the graphs whose bytes it reads.
class Scene {
 public:
  Scene(std::uint32_t objects, std::uint32_t fingers, std::uint32_t touches_per_finger) {
    fdcg_scene_config config = fdcg_make_scene_config();
    config.object_capacity = objects;
    config.finger_capacity = fingers;
    config.touches_per_finger = touches_per_finger;
    memory_.resize(fdcg_scene_bytes(&config) / sizeof(std::uint64_t) + 1);
    fdcg_error error;
    check(fdcg_scene_create(memory_.data(), memory_.size() * sizeof(std::uint64_t), &config, &scene, &error), error);
  }

  fdcg_object_id add(const py::object& shape, const std::optional<fdcg_params>& params, const fdcg_pose& pose) {
    const fdcg_params all = params ? *params : fdcg_make_params();
    fdcg_object_id object;
    fdcg_error error;
    if (py::isinstance<fdcg_surface>(shape)) {
      check(fdcg_scene_add_surface(scene, &shape.cast<const fdcg_surface&>(), &all, &pose, &object, &error), error);
      return object;
    }
    auto graph = shape.cast<std::shared_ptr<Graph>>();
    check(fdcg_scene_add_object(scene, &graph->view, &all, &pose, &object, &error), error);
    graphs_.push_back(std::move(graph));
    return object;
  }

  fdcg_scene* scene = nullptr;

 private:
  std::vector<std::uint64_t> memory_;
  std::vector<std::shared_ptr<Graph>> graphs_;
};

fdcg_pose make_pose(const py::object& translation_m, const std::array<double, 4>& rotation_xyzw, double scale) {
  fdcg_pose pose = fdcg_make_identity_pose();
  if (!translation_m.is_none()) {
    const Place place = place_from(translation_m, "translation_m");
    std::copy(place.begin(), place.end(), pose.translation_m);
  }
  std::copy(rotation_xyzw.begin(), rotation_xyzw.end(), pose.rotation_xyzw);
  pose.scale = scale;
  return pose;
}

fdcg_finger_id add_finger(Scene& scene, const py::object& hip_m) {
  fdcg_finger_id finger;
  fdcg_error error;
  check(fdcg_scene_add_finger(scene.scene, place_from(hip_m, "hip_m").data(), &finger, &error), error);
  return finger;
}

void move_finger(Scene& scene, fdcg_finger_id finger, const py::object& hip_m) {
  fdcg_error error;
  check(fdcg_scene_move_finger(scene.scene, finger, place_from(hip_m, "hip_m").data(), &error), error);
}

fdcg_finger_result result_of(const Scene& scene, fdcg_finger_id finger) {
  fdcg_finger_result result;
  fdcg_error error;
  check(fdcg_scene_get_result(scene.scene, finger, &result, &error), error);
  return result;
}

py::tuple force_of(const Scene& scene, fdcg_finger_id finger) {
  const fdcg_finger_result result = result_of(scene, finger);
  return py::make_tuple(result.force_n[0], result.force_n[1], result.force_n[2]);
}

// One finger along a path, a tick of the whole scene for each row.
py::array_t<double> follow(Scene& scene, fdcg_finger_id finger, const Places& hips_m) {
  const py::ssize_t count = rows_of(hips_m, "hips_m");
  result_of(scene, finger);  // it is in the scene
  py::array_t<double> forces({count, py::ssize_t{3}});
  double* const out = forces.mutable_data();
  const double* const hips = hips_m.data();
  py::gil_scoped_release others_run;
  fdcg_finger_result result;
  for (py::ssize_t i = 0; i < count; ++i) {
    fdcg_scene_move_finger(scene.scene, finger, hips + 3 * i, nullptr);
    fdcg_scene_step(scene.scene);
    fdcg_scene_get_result(scene.scene, finger, &result, nullptr);
    std::copy(result.force_n, result.force_n + 3, out + 3 * i);
  }
  return forces;
}

void set_pose(Scene& scene, fdcg_object_id object, const fdcg_pose& pose) {
  fdcg_error error;
  check(fdcg_scene_set_pose(scene.scene, object, &pose, &error), error);
}

void remove_object(Scene& scene, fdcg_object_id object) {
  fdcg_error error;
  check(fdcg_scene_remove_object(scene.scene, object, &error), error);
}

fdcg_surface checked(const fdcg_surface& surface) {
  fdcg_error error;
  check(fdcg_check_surface(&surface, &error), error);
  return surface;
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<fdcg_pose>(module, "Pose", "Where an object is: rotation, translation (metres), uniform scale.")
      .def(py::init(&make_pose), py::arg("translation_m") = py::none(),
           py::arg("rotation_xyzw") = std::array<double, 4>{0, 0, 0, 1}, py::arg("scale") = 1.0);
  py::class_<fdcg_object_id>(module, "ObjectId").def_readonly("index", &fdcg_object_id::index);
  py::class_<fdcg_finger_id>(module, "FingerId").def_readonly("index", &fdcg_finger_id::index);
  py::class_<fdcg_surface>(module, "Surface", "A surface without a mesh, centred in its frame.");
  module.def(
      "plane", [] { return checked(fdcg_make_plane()); }, "z = 0, solid below.");
  module.def(
      "sphere", [](double radius_m) { return checked(fdcg_make_sphere(radius_m)); }, py::arg("radius_m"));
  module.def(
      "box",
      [](const py::object& half_m) {
        const Place half = place_from(half_m, "half_m");
        return checked(fdcg_make_box(half[0], half[1], half[2]));
      },
      py::arg("half_m"), "By half of its sides.");
  module.def(
      "cylinder", [](double radius_m, double length_m) { return checked(fdcg_make_cylinder(radius_m, length_m)); },
      py::arg("radius_m"), py::arg("length_m"), "Along z.");
  py::class_<Scene>(module, "Scene", "Objects with poses, and fingers that feel all of them.")
      .def(py::init<std::uint32_t, std::uint32_t, std::uint32_t>(), py::arg("objects") = 64, py::arg("fingers") = 8,
           py::arg("touches_per_finger") = 4)
      .def("add", &Scene::add, py::arg("shape"), py::arg("params") = py::none(), py::arg("pose") = fdcg_make_identity_pose(),
           "Adds a graph or a surface; returns its id.")
      .def("remove", &remove_object, py::arg("object"))
      .def("set_pose", &set_pose, py::arg("object"), py::arg("pose"), "From the next step on.")
      .def("add_finger", &add_finger, py::arg("hip_m"), "World, metres; returns its id.")
      .def("move", &move_finger, py::arg("finger"), py::arg("hip_m"))
      .def(
          "step", [](Scene& scene) { fdcg_scene_step(scene.scene); }, "A tick of the whole scene.")
      .def("force_n", &force_of, py::arg("finger"), "Newtons on the finger, world, of the last step.")
      .def(
          "touch_count", [](const Scene& scene, fdcg_finger_id finger) { return result_of(scene, finger).touch_count; },
          py::arg("finger"))
      .def("follow", &follow, py::arg("finger"), py::arg("hips_m"), "A tick for each row of (n, 3); the forces, (n, 3).");
}

}  // namespace fdcg::python
