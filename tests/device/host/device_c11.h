/* SPDX-License-Identifier: Apache-2.0 */
/* 0, or the number of the check that failed. */
#ifdef __cplusplus
extern "C" {
#endif

int refuses_from_c(void);
int runs_from_c(const char* scene, const char* moved_object);

#ifdef __cplusplus
}
#endif
