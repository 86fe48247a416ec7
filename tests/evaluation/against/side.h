/* SPDX-License-Identifier: Apache-2.0 */
/* One build's library behind one name, whatever its structs look like: two of them are linked into one program. */
#ifndef FDCG_TEST_SIDE_H
#define FDCG_TEST_SIDE_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct side {
  void* (*open)(const char* path, char* why,
                unsigned why_bytes);                 /* a graph and a contact, the file verified in full; NULL: `why` */
  int (*step)(void* contact, const double hip_m[3]); /* whether it touches */
  void (*restart)(void* contact);                    /* as at the first tick */
  void (*close)(void* contact);
} side;

#ifdef __cplusplus
}
#endif

#endif
