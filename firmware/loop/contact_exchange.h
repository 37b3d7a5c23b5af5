// SPDX-License-Identifier: Apache-2.0
// contact_exchange.h - hands a contact that was prepared beside the loop to the loop, without a
// lock. An ordinary thread offers, the loop's thread takes.
#pragma once

#include <atomic>
#include <cstdint>

#include "firmware/loop/controller.h"

namespace tact::firmware::loop {

/// A contact with other numbers of the law.
struct OfferedContact {
  std::uint32_t variant = 0;  // see TickInput
  model::contact::Contact contact;
};

class ContactExchange {
 public:
  /// Replaces an offer that the loop has not taken, and returns that one; else null.
  OfferedContact* offer(OfferedContact& offered) {
    return offered_.exchange(&offered, std::memory_order_acq_rel);
  }
  /// True until the loop has taken the newest offer.
  bool is_pending() const { return offered_.load(std::memory_order_acquire) != nullptr; }

  /// Loop side: uses the offer, if there is one and the tool is out of contact. If another thread
  /// replaces the offer in between, a later tick takes that one.
  void take(Controller& controller, TickInput& input) RT_SAFE {
    OfferedContact* offered = offered_.load(std::memory_order_acquire);
    if (offered == nullptr || !controller.is_clear()) return;
    if (!offered_.compare_exchange_strong(offered, nullptr, std::memory_order_acq_rel)) return;
    controller.use(offered->contact);
    input.variant = offered->variant;
  }

 private:
  std::atomic<OfferedContact*> offered_{nullptr};
};

}  // namespace tact::firmware::loop
