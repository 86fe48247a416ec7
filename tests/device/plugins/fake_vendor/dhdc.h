/* SPDX-License-Identifier: Apache-2.0 */
/* The functions of Force Dimension's dhdc.h that the plugin uses, by their documented names and types; fake_dhd.cpp is behind.
 */
#pragma once

#define DHD_ON 1

extern "C" {
int dhdGetDeviceCount();
int dhdOpenID(char index);
int dhdClose(char id);
int dhdEnableForce(unsigned char on, char id);
int dhdSetWatchdog(unsigned char duration, char id);
int dhdGetPosition(double* x, double* y, double* z, char id);
int dhdSetForce(double x, double y, double z, char id);
unsigned int dhdGetButtonMask(char id);
const char* dhdErrorGetLastStr();
}
