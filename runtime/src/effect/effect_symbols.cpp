// SPDX-License-Identifier: Apache-2.0
// Symbols of what is inline in effect.h, relief.h and heights.h, for languages that call by name.
#ifndef FDCG_EFFECT_H  // sources compiled as one have these functions without symbols
#include "fdcg/fdcg.h"
#undef FDCG_INLINE
#define FDCG_INLINE FDCG_API
#include "fdcg/heights.h"
#include "fdcg/relief.h"
#undef FDCG_INLINE
#define FDCG_INLINE static inline
#endif
