// SPDX-License-Identifier: Apache-2.0
#include "dhdc.h"
#include "fake_hand.hpp"

namespace {
fdcg::test::FakeHand hand;
double force[3];
bool is_open;
}  // namespace

int dhdGetDeviceCount() {
  return 1;
}
int dhdOpenID(char index) {
  is_open = index == 0;
  hand = {};
  return is_open ? 0 : -1;
}
int dhdClose(char) {
  is_open = false;
  return 0;
}
int dhdEnableForce(unsigned char, char) {
  return 0;
}
int dhdSetWatchdog(unsigned char, char) {
  return -1;
}
int dhdGetPosition(double* x, double* y, double* z, char) {
  hand.push(force);
  *x = hand.place_m[0], *y = hand.place_m[1], *z = hand.place_m[2];
  return is_open ? 0 : -1;
}
int dhdSetForce(double x, double y, double z, char) {
  force[0] = x, force[1] = y, force[2] = z;
  return is_open ? 0 : -1;
}
unsigned int dhdGetButtonMask(char) {
  return 2;
}
const char* dhdErrorGetLastStr() {
  return "no such device";
}
