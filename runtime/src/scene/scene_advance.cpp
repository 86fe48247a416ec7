// SPDX-License-Identifier: Apache-2.0
// The objects of a scene from tick to tick: where they are, and how far they move.
#include "scene/scene_memory.hpp"

namespace fdcg {
namespace {

// It has no bounding sphere, and a rotation moves its points without bound: that invalidates the broad phase of all fingers.
void settle_endless(fdcg_scene& scene, const Pose& now, const Pose& last) {
  const World moved = now.translation - last.translation;
  scene.tick_travel = larger(scene.tick_travel, norm(moved));
  for (int k = 0; k < 3; ++k) {
    if (norm1(now.row[k] - last.row[k]) == 0) continue;
    ++scene.look;
    break;
  }
}

// The objects whose pose was set; and, once more, those that have come to rest.
void settle_changing(fdcg_scene& scene) {
  uint32_t* const changing = scene.changing();
  uint32_t still_changing = 0;
  for (uint32_t i = 0; i < scene.changing_count; ++i) {
    Object& object = scene.objects()[changing[i]];
    settle_object(scene, changing[i], true);
    if (--object.is_changing != 0) changing[still_changing++] = changing[i];
  }
  scene.changing_count = still_changing;
}

}  // namespace

void settle_object(fdcg_scene& scene, uint32_t index, bool has_way) {
  Object& object = scene.objects()[index];
  const Pose latest(object.asked, object.bounds);
  if (latest.scale != object.now.scale) ++scene.look;
  object.last = has_way ? object.now : latest;
  object.now = latest;
  if (object.bounds.is_endless) {
    settle_endless(scene, latest, object.last);
  } else {
    scene.tick_travel = larger(scene.tick_travel, largest_move(object.last, latest));
  }
  scan_object(scene, index);
}

void scan_object(fdcg_scene& scene, uint32_t index) {
  const Object& object = scene.objects()[index];
  const Pose &now = object.now, &last = object.last;
  const bool is_endless = object.bounds.is_endless, is_there = object.is_used != 0 && object.is_enabled != 0;
  const World centre = is_endless ? World{0, 0, 0} : now.centre;
  const double reach = is_endless ? Bounds::kEndless_m : larger(now.radius, last.radius) + norm(now.centre - last.centre);
  const double in_scan[4] = {centre.x, centre.y, centre.z, is_there ? reach : kNoReach};
  for (uint32_t array = 0; array < 4; ++array)
    scene.scan(array)[index] = in_scan[array];
  const double far = is_endless ? norm1(now.translation) : norm1(now.centre) + norm1(now.translation) + now.radius;
  scene.farthest = larger(scene.farthest, far);
}

}  // namespace fdcg

extern "C" void fdcg_scene_advance(fdcg_scene* scene) {
  if (scene == nullptr) return;
  fdcg::settle_place(scene);
  ++scene->tick;
  scene->tick_travel = 0;
  if (!scene->skips(FDCG_OPT_STILL)) {
    for (uint32_t i = 0; i < scene->object_end; ++i) {
      if (scene->objects()[i].is_used != 0) fdcg::settle_object(*scene, i, true);
    }
  } else if (scene->changing_count > 0) {
    fdcg::settle_changing(*scene);
  }
  if (scene->tick_travel > 0) {
    scene->travel = (scene->travel + scene->tick_travel) * (1 + 2 * fdcg::RealLimits<double>::kEpsilon);
  }
}
