// SPDX-License-Identifier: Apache-2.0
// grip_input.h - how far the jaws are closed, from what the hand presses.
//
//   hold    the jaws follow the hand: closed while it presses
//   toggle  one press closes them, the next opens them
//
// A press is a ratio above `close_ratio` after one below `open_ratio`. What is pressed when the
// loop starts is no press. A grip switch on the lines takes the place of the device's own.
#pragma once

#include <cmath>
#include <optional>

#include "model/rt.h"

namespace tact::firmware::loop {

struct GripSettings {
  bool toggles = false;
  double close_ratio = 0.7, open_ratio = 0.5;  // of contact
};

class GripInput {
 public:
  explicit GripInput(const GripSettings& settings) : settings_(settings) {}

  /// `device`: as its last sample has it; `line`: the grip switch, where one is wired. A ratio that
  /// is no number stays one.
  double step(double device, std::optional<bool> line) RT_SAFE {
    const double hand = line ? (*line ? 1.0 : 0.0) : device;
    if (!settings_.toggles) return hand;
    if (hand < settings_.open_ratio) pressed_ = false;
    if (hand > settings_.close_ratio && !pressed_) {
      pressed_ = true;
      closed_ = !closed_;
    }
    if (std::isnan(hand)) return hand;
    return closed_ ? 1.0 : 0.0;
  }

 private:
  GripSettings settings_;
  bool pressed_ = true, closed_ = false;
};

}  // namespace tact::firmware::loop
