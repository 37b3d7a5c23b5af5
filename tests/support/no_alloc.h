// SPDX-License-Identifier: Apache-2.0
// no_alloc.h - proof that a stretch of code leaves the heap alone.
//
//     const NoAlloc guard;
//     law.respond(depth_m);
//     EXPECT_EQ(guard.calls(), 0u);
//
// Counts malloc and free of the thread that holds the guard, as tactd does for its own report
// (firmware/loop/alloc_counter.h), and so do ASan's and TSan's builds; RTSan's sees 0, and ends at
// a heap call in an RT_SAFE function by itself.
#pragma once

#include "firmware/loop/alloc_counter.h"

namespace tact::tests {

using NoAlloc = firmware::loop::HeapCallCounter;

}  // namespace tact::tests
