// no_alloc.h - proof that a stretch of code leaves the heap alone.
//
//     const NoAlloc guard;
//     law.respond(depth_m);
//     EXPECT_EQ(guard.calls(), 0u);
//
// Counts malloc and free of the thread that holds the guard, as tactd does for its own report
// (firmware/alloc_counter.h). Sanitizer builds cannot count and see 0.
#pragma once

#include "firmware/alloc_counter.h"

namespace tact::tests {

using NoAlloc = firmware::HeapWatch;

}  // namespace tact::tests
