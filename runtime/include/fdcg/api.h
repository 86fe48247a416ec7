/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/api.h
 * How the functions of these headers are declared.
 *
 * The static library hides its symbols: a plugin that links it exports none of them. The shared one, libfdcg, exports the
 * functions of these headers and nothing else, those that are inline in C and C++ too: other languages call them by name.
 */
#ifndef FDCG_API_H
#define FDCG_API_H

/** FDCG_BUILD_SHARED: while libfdcg itself is compiled. FDCG_USE_SHARED: in programs that link it; only Windows asks. */
#if defined(_WIN32) && defined(FDCG_BUILD_SHARED)
#define FDCG_API __declspec(dllexport)
#elif defined(_WIN32) && defined(FDCG_USE_SHARED)
#define FDCG_API __declspec(dllimport)
#elif defined(FDCG_BUILD_SHARED)
#define FDCG_API __attribute__((visibility("default")))
#else
#define FDCG_API
#endif

/** Before a function that a program compiles itself, since it knows the caller's size of a struct. */
#ifndef FDCG_INLINE
#define FDCG_INLINE static inline
#endif

#endif /* FDCG_API_H */
