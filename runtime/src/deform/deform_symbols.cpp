// SPDX-License-Identifier: Apache-2.0
// Symbols of what is inline in deform.h, for languages that call by name.
#ifndef FDCG_DEFORM_H  // sources compiled as one have these functions without symbols
#include "fdcg/scene.h"
#undef FDCG_INLINE
#define FDCG_INLINE FDCG_API
#include "fdcg/deform.h"
#undef FDCG_INLINE
#define FDCG_INLINE static inline
#endif
