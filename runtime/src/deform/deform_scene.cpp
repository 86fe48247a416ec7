// SPDX-License-Identifier: Apache-2.0
// Deformable meshes as objects of a scene.
#include "base/message.hpp"
#include "deform/deform_upkeep.hpp"
#include "scene/finger_tick.hpp"

namespace fdcg {
namespace {

// The scene's contact is the first member of a fdcg_deform_contact: fdcg_scene.contact_bytes.
void step_deform(const Object& object, const fdcg_params* params, fdcg_contact* contact, const double hip_object_m[3],
                 fdcg_result* result) {
  fdcg_deform_step(object.deform, params, reinterpret_cast<fdcg_deform_contact*>(contact), hip_object_m, result);
}

// A finger's first step: the meshes that it is within get their contacts at once. One made in the next tick, as on other
// objects, would have the HIP's last place, but not how vertices have moved since.
void start_on_deforms(fdcg_scene& scene, Finger& finger) {
  const auto index = static_cast<uint32_t>(&finger - scene.fingers());
  const Tick tick = {scene, finger, scene.slots(index), finger.hip, true};
  look(tick);
  fdcg_contact* contact = scene.first_contact(index);
  for (uint32_t s = 0; s < scene.config.touches_per_finger;
       ++s, contact = part_at<fdcg_contact>(contact, scene.contact_bytes)) {
    Slot& slot = tick.slots[s];
    if (slot.object == FDCG_NONE) continue;
    const Object& object = scene.objects()[slot.object];
    LocalWay way;
    if (object.deform == nullptr || !can_have_met(tick, object, &way)) continue;
    *reinterpret_cast<fdcg_deform_contact*>(contact) = {};
    fdcg_result result;
    step_object(object, &object.params, contact, way.to, &result);
    slot.step = finger.step + 1;
  }
  ++finger.step;
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
  shape.view = *fdcg_deform_get_graph(deform);
  shape.step_shape = fdcg::step_deform;
  shape.deform = deform;
  shape.bounds = fdcg::Bounds(deform->header);
  scene->start_on_deforms = fdcg::start_on_deforms;
  return fdcg::add_object(scene, shape, params, pose, object, error);
}
