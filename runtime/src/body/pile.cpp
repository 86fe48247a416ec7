// SPDX-License-Identifier: Apache-2.0
// A pile's memory; adding and removing members. pile_step.cpp is its tick.
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "body/pile_memory.hpp"

namespace fdcg {
namespace {

constexpr uint32_t kMost = 1000000;
constexpr double kMostRatio = 1000, kFarthest_m = 1e12;

fdcg_status check_range(const char* name, double value, double low, double high, fdcg_error* error) {
  if (value >= low && value <= high) return FDCG_OK;
  return refuse(error, name, value, low, high);
}

// In range; *config is then whole.
fdcg_status checked_config(const fdcg_pile_config* given, fdcg_pile_config* config, fdcg_error* error) {
  if (given == nullptr) return refuse(error, "config: null pointer");
  fdcg_status status =
      check_struct_bytes(given->struct_bytes, sizeof *given, "config", "; start from fdcg_make_pile_config()", error);
  if (status != FDCG_OK) return status;
  *config = in_full(*given, config, fdcg_pile_config_init);
  struct Range {
    const char* name;
    double value, low, high;
  };
  const Range ranges[] = {{"config.object_capacity", double(config->object_capacity), 1, kMost},
                          {"config.point_capacity", double(config->point_capacity), 1, kMost},
                          {"config.touch_capacity", double(config->touch_capacity), 1, kMost},
                          {"config.damping_ratio", config->damping_ratio, 0, kMostRatio},
                          {"config.leaving_ratio", config->leaving_ratio, 0, kMostRatio},
                          {"config.disabled_optimizations", double(config->disabled_optimizations), 0, FDCG_PILE_OPT_ALL},
                          {"config.reserved", double(config->reserved), 0, 0}};
  for (const Range& range : ranges) {
    if (status == FDCG_OK) status = check_range(range.name, range.value, range.low, range.high, error);
  }
  return status;
}

uint64_t lay_out(const fdcg_pile_config& config, fdcg_pile* pile) {
  MemoryLayout layout;
  layout.place(1, sizeof(fdcg_pile));
  pile->config = config;
  pile->members_at = layout.place(config.object_capacity, sizeof(PileMember));
  pile->points_at = layout.place(config.point_capacity, sizeof(PilePoint));
  pile->touches_at = layout.place(config.touch_capacity, sizeof(PileTouch));
  return layout.bytes();
}

template <class IsGone>
void drop_everywhere(fdcg_pile& pile, IsGone is_gone) {
  for (uint32_t m = 0; m < pile.member_end; ++m) {
    PileMember& member = pile.members()[m];
    for (uint32_t p = 0; p < member.point_count && member.touch_count > 0; ++p)
      drop_touches(pile, member, pile.points()[member.first_point + p], is_gone);
  }
}

// Releases the member's points; the points of later members move down.
void give_back_points(fdcg_pile& pile, PileMember& member) {
  const uint32_t first = member.first_point, count = member.point_count;
  if (count == 0) return;
  memmove(pile.points() + first, pile.points() + first + count, (pile.point_end - first - count) * sizeof(PilePoint));
  pile.point_end -= count;
  for (uint32_t m = 0; m < pile.member_end; ++m) {
    PileMember& other = pile.members()[m];
    if (other.point_count > 0 && other.first_point > first) other.first_point -= count;
  }
  member.point_count = 0;
}

fdcg_status check_points(const double (*points_m)[3], uint32_t count, fdcg_error* error) {
  for (uint32_t p = 0; p < count; ++p) {
    for (int k = 0; k < 3; ++k) {
      if (fabs(points_m[p][k]) <= kFarthest_m) continue;
      return Message(error, FDCG_E_ARGUMENT).say("points_m[", p, "][", k, "] is ", points_m[p][k], ", allowed -1e12 to 1e12");
    }
  }
  return FDCG_OK;
}

}  // namespace

void let_go(fdcg_pile& pile, uint32_t index) {
  PileMember& member = pile.members()[index];
  for (uint32_t p = 0; p < member.point_count; ++p)
    drop_touches(pile, member, pile.points()[member.first_point + p], [](const PileTouch&) { return true; });
  drop_everywhere(pile, [index](const PileTouch& touch) { return touch.on == index; });
}

void leave_pile(fdcg_pile& pile, uint32_t index) {
  let_go(pile, index);
  give_back_points(pile, pile.members()[index]);
  pile.members()[index].is_used = 0;
  ++pile.look;
}

}  // namespace fdcg

using namespace fdcg;

extern "C" void fdcg_pile_config_init(fdcg_pile_config* config, uint32_t struct_bytes) {
  fdcg_pile_config defaults = {};
  defaults.object_capacity = 64;
  defaults.point_capacity = defaults.touch_capacity = 128;
  defaults.damping_ratio = 1;
  defaults.leaving_ratio = 4;
  fill_defaults(config, defaults, struct_bytes);
}

extern "C" uint64_t fdcg_pile_bytes(const fdcg_pile_config* config) {
  fdcg_pile pile;
  return checked_config(config, &pile.config, nullptr) == FDCG_OK ? lay_out(pile.config, &pile) : 0;
}

extern "C" fdcg_status fdcg_pile_create(void* memory, uint64_t bytes, const fdcg_pile_config* config, fdcg_pile** pile,
                                        fdcg_error* error) {
  if (pile == nullptr) return refuse(error, "pile: null pointer");
  *pile = nullptr;
  if (memory == nullptr) return refuse(error, "memory: null pointer");
  fdcg_pile layout = {};
  const fdcg_status status = checked_config(config, &layout.config, error);
  if (status != FDCG_OK) return status;
  layout.bytes = lay_out(layout.config, &layout);
  if (const fdcg_status room = check_room(memory, bytes, layout.bytes, error); room != FDCG_OK) return room;
  memset(memory, 0, layout.touches_at);  // a touch is set when it comes into use
  memcpy(memory, &layout, sizeof layout);
  *pile = static_cast<fdcg_pile*>(memory);
  for (uint32_t t = 0; t < layout.config.touch_capacity; ++t)
    (*pile)->touches()[t].next = t + 1 < layout.config.touch_capacity ? t + 1 : FDCG_NONE;
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_pile_set_ground(fdcg_pile* pile, const double normal[3], double offset_m, const fdcg_params* params,
                                            fdcg_error* error) {
  if (pile == nullptr) return refuse(error, "pile: null pointer");
  if (params != nullptr) {
    if (normal == nullptr) return refuse(error, "normal: null pointer");
    const World up = {normal[0], normal[1], normal[2]};
    const double length = norm(up);
    fdcg_status status = check_range("normal's length", length, 1 - kUnitTolerance, 1 + kUnitTolerance, error);
    if (status == FDCG_OK) status = check_range("offset_m", offset_m, -kFarthest_m, kFarthest_m, error);
    if (status == FDCG_OK) status = fdcg_check_params(params, error);
    if (status != FDCG_OK) return status;
    fdcg_params room;
    pile->ground_params = in_full(*params, &room, fdcg_params_init);
    pile->ground_params.friction_flags &= FDCG_FRICTION_STRIBECK | FDCG_FRICTION_VISCOUS | FDCG_FRICTION_LAG;
    pile->ground_params.materials = nullptr;  // the ground has no faces, and no pointer outside the pile's memory is kept
    pile->ground_params.material_count = 0;
    pile->ground_normal = {up.x / length, up.y / length, up.z / length};
    pile->ground_offset_m = offset_m;
  }
  pile->has_ground = params != nullptr ? 1 : 0;
  ++pile->look;
  drop_everywhere(*pile, [](const PileTouch& touch) { return touch.on == kGround; });
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_pile_add(fdcg_pile* pile, const fdcg_scene* scene, fdcg_object_id object,
                                     const double (*points_m)[3], uint32_t point_count, fdcg_error* error) {
  if (pile == nullptr || scene == nullptr) return refuse(error, "pile or scene: null pointer");
  if (points_m == nullptr && point_count > 0) return refuse(error, "points_m: null pointer");
  const bool is_there = object.index < scene->object_end && scene->objects()[object.index].is_used != 0 &&
                        scene->objects()[object.index].generation == object.generation;
  if (!is_there) return refuse(error, "object: not in this scene, or removed");
  if (scene->objects()[object.index].deform != nullptr)
    return refuse(error, "object: is a deformable mesh, which bodies do not meet; leave it out of the pile");
  if (object.index >= pile->config.object_capacity) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("object.index is ", object.index, ", config.object_capacity is ", pile->config.object_capacity,
             "; make it as large as the scene's");
  }
  if (const fdcg_status status = check_points(points_m, point_count, error); status != FDCG_OK) return status;
  PileMember& member = pile->members()[object.index];
  const uint32_t others = pile->point_end - (member.is_used != 0 ? member.point_count : 0);
  if (point_count > pile->config.point_capacity - others) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("point_count is ", point_count, ", config.point_capacity leaves ", pile->config.point_capacity - others);
  }
  if (member.is_used != 0) leave_pile(*pile, object.index);
  member = {};
  member.object = object;
  member.is_used = member.is_enabled = 1;
  member.first_point = pile->point_end;
  member.point_count = point_count;
  const World centre = scene->objects()[object.index].bounds.centre;
  for (uint32_t p = 0; p < point_count; ++p) {
    PilePoint& point = pile->points()[pile->point_end++];
    memcpy(point.at, points_m[p], sizeof point.at);
    point.touch = FDCG_NONE;
    const double away = norm(vec(point.at) - centre) * (1 + 0x1p-40);
    if (away > member.radius_m) member.radius_m = away;
  }
  if (object.index >= pile->member_end) pile->member_end = object.index + 1;
  member.look = member.seen_look = pile->look++;  // of before: none yet
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_pile_remove(fdcg_pile* pile, fdcg_object_id object, fdcg_error* error) {
  if (pile == nullptr) return refuse(error, "pile: null pointer");
  if (object.index >= pile->member_end || pile->members()[object.index].is_used == 0 ||
      pile->members()[object.index].object.generation != object.generation) {
    return refuse(error, "object: not in the pile");
  }
  leave_pile(*pile, object.index);
  return FDCG_OK;
}

extern "C" uint32_t fdcg_pile_get_touches(const fdcg_pile* pile, fdcg_pile_touch* touches, uint32_t capacity) {
  if (pile == nullptr) return 0;
  if (touches == nullptr) capacity = 0;
  uint32_t count = 0;
  for (uint32_t m = 0; m < pile->member_end; ++m) {
    const PileMember& member = pile->members()[m];
    for (uint32_t p = 0; p < member.point_count && member.touch_count > 0; ++p) {
      for (uint32_t t = pile->points()[member.first_point + p].touch; t != FDCG_NONE; t = pile->touches()[t].next) {
        const PileTouch& touch = pile->touches()[t];
        if (touch.is_pressing == 0 || count++ >= capacity) continue;
        fdcg_pile_touch& to = touches[count - 1];
        to = {};
        to.object = member.object;
        if (touch.on != kGround) to.on = pile->members()[touch.on].object;
        put(touch.force_n + touch.damper_n, to.force_n);
        put(touch.god_object, to.god_object_m);
        put(touch.normal, to.normal);
        to.load_n = touch.load_n;
        to.stiffness_n_per_m = touch.stiffness_n_per_m;
        to.point = p;
        to.state = touch.contact.state;
        to.feature = touch.contact.feature;
        to.slipping = touch.contact.slipping;
        to.softened = touch.is_softened;
      }
    }
  }
  return count;
}

extern "C" fdcg_pile_counts fdcg_pile_get_counts(const fdcg_pile* pile) {
  return pile != nullptr ? pile->counts : fdcg_pile_counts{};
}
