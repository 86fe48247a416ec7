// SPDX-License-Identifier: Apache-2.0
// Static friction of the touches between two members together. A body pressed on by several points gives way when all of them
// have reached static friction, not when the least loaded of them has: until then a point beyond its cone moves on at
// mu_static, and what it cannot bear goes to the others. Once all slip, mu_dynamic holds for each, until all rest again.
#include "body/pile_memory.hpp"

namespace fdcg {
namespace {

// What the last step found between a member and one that it touches, both members' points counted.
struct Patch {
  uint32_t on;
  uint32_t pressing, at_limit;  // touches under load; those of them that friction does not hold
  bool was_slipping;
};

struct Patches {
  static constexpr uint32_t kMost = PileMember::kMostNear;  // touches with further members are judged one by one

  Patch list[kMost];
  uint32_t count = 0;

  Patch* find(uint32_t on) {
    for (uint32_t i = 0; i < count; ++i) {
      if (list[i].on == on) return list + i;
    }
    return nullptr;
  }
};

void count_touch(const PileTouch& touch, Patch* patch) {
  if (touch.is_pressing == 0 || !(touch.load_n > 0)) return;
  ++patch->pressing;
  patch->at_limit += touch.contact.slipping;
  patch->was_slipping = patch->was_slipping || touch.patch == PatchFriction::slips;
}

PatchFriction friction_of(const Patch& patch) {
  if (patch.pressing < 2) return PatchFriction::alone;
  if (patch.at_limit == patch.pressing) return PatchFriction::slips;
  return patch.was_slipping && patch.at_limit > 0 ? PatchFriction::slips : PatchFriction::holds;
}

}  // namespace

void judge_patches(fdcg_pile& pile, PileMember* owner) {
  if (owner->touch_count == 0) return;
  Patches patches;
  bool is_moving = owner->is_moving != 0 || !pile.skips(FDCG_PILE_OPT_STILL);
  for_each_touch(pile, owner, [&pile, &patches, &is_moving](PileTouch* touch) {
    is_moving = is_moving || (touch->on != kGround && pile.members()[touch->on].is_moving != 0);
    Patch* patch = patches.find(touch->on);
    if (patch == nullptr) {
      if (patches.count == Patches::kMost) return;
      patch = patches.list + patches.count++;
      *patch = {touch->on, 0, 0, false};
    }
    count_touch(*touch, patch);
  });
  if (!is_moving) return;  // no touch is stepped
  const auto own = static_cast<uint32_t>(owner - pile.members());
  for (uint32_t i = 0; i < patches.count; ++i) {
    Patch& patch = patches.list[i];
    if (patch.on == kGround) continue;
    for_each_touch(pile, pile.members() + patch.on, [&patch, own](PileTouch* touch) {
      if (touch->on == own) count_touch(*touch, &patch);
    });
  }
  for_each_touch(pile, owner, [&patches](PileTouch* touch) {
    const Patch* const patch = patches.find(touch->on);
    touch->patch = patch != nullptr ? friction_of(*patch) : PatchFriction::alone;
  });
}

}  // namespace fdcg
