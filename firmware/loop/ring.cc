// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/ring.h"

namespace tact::firmware::loop {

// dropped_ orders no other data: relaxed.
// Boost has no real-time marks; its fixed-capacity push copies into memory allocated before.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
void TickRing::push(const TickRecord& record) RT_SAFE {
  if (!queue_.push(record)) dropped_.fetch_add(1, std::memory_order_relaxed);
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

}  // namespace tact::firmware::loop
