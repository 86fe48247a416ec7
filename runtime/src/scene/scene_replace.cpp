// SPDX-License-Identifier: Apache-2.0
// Another graph for an object, under the fingers that touch it.
#include "base/config.hpp"
#include "base/message.hpp"
#include "fdcg/query.h"
#include "scene/scene_memory.hpp"
#include "step/admit.hpp"
#include "step/contact_internals.hpp"

namespace fdcg {
namespace {

World object_place(const fdcg_header& header, const double (&local)[3]) {
  return (vec(local) + vec(header.origin)) * header.metres_per_unit;
}

// Rounded as the graph's numbers are: a contact holds no others.
void put_local(const fdcg_header& header, World object_m, double (&local)[3]) {
  const World at = object_m * (1 / header.metres_per_unit) - vec(header.origin);
  store(at, local);
  if (header.real_bytes == sizeof(double)) return;
  for (double& x : local) {
    volatile float narrow = static_cast<float>(x);
    x = narrow;
  }
}

// False where the contact is to start anew.
bool rebind(const fdcg_header& before, const fdcg_graph& graph, fdcg_contact* contact) {
  if (contact->state == FDCG_FREE) return false;
  const World god_object = object_place(before, contact->god_object), hip = object_place(before, contact->hip);
  const double at[3] = {god_object.x, god_object.y, god_object.z};
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  if (fdcg_find_nearest(&graph, at, HUGE_VAL, &hit, nullptr) != FDCG_OK) return false;
  fdcg_contact moved = {};
  moved.started = 1;
  ContactInternals& inner = internals_of(moved);
  inner.on = mark_of(*graph.header);
  moved.state = hit.state;
  moved.feature = hit.feature;
  inner.seat_state = FDCG_FREE;
  inner.seat_feature = FDCG_NONE;
  moved.slipping = contact->slipping;
  inner.slip_m_per_s = internals_of(*contact).slip_m_per_s;
  inner.stiffness_n_per_m = internals_of(*contact).stiffness_n_per_m;
  moved.non_finite_ticks = contact->non_finite_ticks;
  moved.transition_bound_ticks = contact->transition_bound_ticks;
  moved.sweep_bound_ticks = contact->sweep_bound_ticks;
  put_local(*graph.header, vec(hit.point_m), moved.god_object);
  put_local(*graph.header, hip, moved.hip);
  *contact = moved;
  return true;
}

void rebind_fingers(fdcg_scene& scene, uint32_t object, const fdcg_header& before, const fdcg_graph& graph) {
  for (uint32_t f = 0; f < scene.finger_end; ++f) {
    Finger& finger = scene.fingers()[f];
    if (finger.is_used == 0) continue;
    fdcg_contact* contact = scene.first_contact(f);
    for (uint32_t s = 0; s < scene.config.touches_per_finger;
         ++s, contact = part_at<fdcg_contact>(contact, scene.contact_bytes)) {
      Slot& slot = scene.slots(f)[s];
      if (slot.object != object) continue;
      if (slot.is_held != 0 && rebind(before, graph, contact)) continue;
      slot.is_held = 0;
      slot.step = finger.step - 1;  // the contact is made anew where it is needed
    }
  }
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_scene_replace_graph(fdcg_scene* scene, fdcg_object_id id, const fdcg_graph* graph,
                                                fdcg_error* error) {
  using namespace fdcg;
  Object* const object = find_object(scene, id, error);
  if (object == nullptr) return FDCG_E_ARGUMENT;
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not open");
  if (object->step_shape != nullptr) return refuse(error, "object: is no graph, but a surface or a deformable mesh");
  rebind_fingers(*scene, id.index, *object->view.header, *graph);
  object->view = *graph;
  object->bounds = Bounds(*graph->header);
  settle_object(*scene, id.index, false);
  ++scene->look;
  return FDCG_OK;
}
