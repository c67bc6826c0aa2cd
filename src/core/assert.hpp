// SPDX-License-Identifier: Apache-2.0
// DPCHIP_ASSERT: programmer errors stop dev, sanitizer and fuzz builds; release builds trust the caller.
#pragma once

#if defined(DPCHIP_CHECKED)
#define DPCHIP_ASSERT(condition) ((condition) ? static_cast<void>(0) : __builtin_trap())
#else
#define DPCHIP_ASSERT(condition) static_cast<void>(0)
#endif
