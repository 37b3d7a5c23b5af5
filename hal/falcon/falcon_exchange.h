// SPDX-License-Identifier: Apache-2.0
// falcon_exchange.h - which reports answer a command: each command is answered once, in order.
//
// A report that no command waits for is a repetition. A command older than kLost_ns is not waited
// for any more, so a lost answer opens the door to a repetition for that long at most.
#pragma once

#include <array>
#include <cstdint>

#include "model/rt.h"

namespace tact::hal::falcon {

class FalconExchange {
 public:
  static constexpr std::int64_t kLost_ns = 8'000'000;
  static constexpr std::int64_t kResend_ns = 2'000'000;
  static constexpr std::size_t kMax = 3;  // under way at once; a round trip takes two frames

  /// May a command be sent: few are unanswered, or the oldest is so for too long?
  bool may_send(std::int64_t now_ns) const RT_SAFE {
    return count_ < kMax || now_ns - sent_ns_[first_] >= kResend_ns;
  }
  void sent(std::int64_t now_ns) RT_SAFE {
    if (count_ == kSlots) drop();
    sent_ns_[(first_ + count_++) % kSlots] = now_ns;
  }
  /// How many of these new reports answer a command.
  std::uint64_t answered(std::uint64_t reports, std::int64_t now_ns) RT_SAFE {
    while (count_ > 0 && now_ns - sent_ns_[first_] > kLost_ns) drop();
    std::uint64_t answers = 0;
    for (; answers < reports && count_ > 0; ++answers) drop();
    return answers;
  }

 private:
  static constexpr std::size_t kSlots = 16;
  void drop() RT_SAFE { first_ = (first_ + 1) % kSlots, --count_; }

  std::array<std::int64_t, kSlots> sent_ns_{};  // ring
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace tact::hal::falcon
