// SPDX-License-Identifier: Apache-2.0
// Deformable meshes as objects of a scene.
#include "deform_upkeep.hpp"
#include "message.hpp"
#include "scene_memory.hpp"

namespace fdcg {
namespace {

// The scene's contact is the first member of a fdcg_deform_contact: fdcg_scene.contact_bytes.
void step_deform(const Object& object, const fdcg_params* params, fdcg_contact* contact, const double hip_object_m[3],
                 fdcg_result* result) {
  fdcg_deform_step(object.deform, params, reinterpret_cast<fdcg_deform_contact*>(contact), hip_object_m, result);
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_scene_add_deform(fdcg_scene* scene, fdcg_deform* deform, const fdcg_params* params,
                                             const fdcg_pose* pose, fdcg_object_id* object, fdcg_error* error) {
  using fdcg::Message;
  if (scene == nullptr || deform == nullptr) return Message(error, FDCG_E_ARGUMENT).text("scene or deform: null pointer");
  if (scene->config.has_deforms == 0) {
    return Message(error, FDCG_E_ARGUMENT)
        .text("scene: has no room for deformable meshes; set config.has_deforms to 1 before fdcg_scene_create");
  }
  fdcg::Object shape = {};
  shape.graph = fdcg_deform_graph(deform);
  shape.step_shape = fdcg::step_deform;
  shape.deform = deform;
  shape.bounds = fdcg::Bounds(deform->header);
  return fdcg::add_object(scene, shape, params, pose, object, error);
}
