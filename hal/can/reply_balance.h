// SPDX-License-Identifier: Apache-2.0
// reply_balance.h - two drives with one node id: more replies than requests.
//
//     b' = max(b + replies - requests, -1)     each tick
//
// A drive answers each request once. A reply that comes a tick late follows a tick without one, so
// b is at most 1; above it another drive answers, too.
#pragma once

#include <algorithm>

#include "model/rt.h"

namespace tact::hal::can {

class ReplyBalance {
 public:
  void add_reply() RT_SAFE { ++replies_; }
  /// Each tick, with the requests of the tick before. `is_complete`: nothing is left in the queue.
  void step(int requests, bool is_complete) RT_SAFE {
    balance_ = is_complete ? std::max(balance_ + replies_ - requests, kMinBalance) : kUnknown;
    replies_ = 0;
  }
  bool is_exceeded() const RT_SAFE { return balance_ > kMaxBalance; }

 private:
  static constexpr int kMinBalance = -1, kMaxBalance = 1;
  static constexpr int kUnknown = -32;  // longer than a queue that was cut short

  int balance_ = 0, replies_ = 0;
};

}  // namespace tact::hal::can
