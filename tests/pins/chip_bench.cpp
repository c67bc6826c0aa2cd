// SPDX-License-Identifier: Apache-2.0
// The bench of the chip's tests, here for what stands below it.
#include "../chip/bench.cpp"
