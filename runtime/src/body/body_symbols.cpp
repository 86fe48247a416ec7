// SPDX-License-Identifier: Apache-2.0
// Symbols of what is inline in body.h and pile.h, for languages that call by name.
#ifndef FDCG_BODY_H  // sources compiled as one have these functions without symbols
#include "fdcg/scene.h"
#undef FDCG_INLINE
#define FDCG_INLINE FDCG_API
#include "fdcg/body.h"
#include "fdcg/pile.h"
#undef FDCG_INLINE
#define FDCG_INLINE static inline
#endif
