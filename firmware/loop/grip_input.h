// SPDX-License-Identifier: Apache-2.0
// grip_input.h - closing ratio of the jaws, from the grip input of the hand.
//
//   hold    the jaws follow the input
//   toggle  one press closes the jaws, the next opens them
//
// A press is a ratio above `close_ratio` after one below `open_ratio`. An input that is already
// pressed at the start does not count. A grip switch on the lines replaces the device's grip input.
#pragma once

#include <cmath>
#include <optional>

#include "model/contact/contact_settings.h"
#include "model/rt.h"

namespace tact::firmware::loop {

struct GripSettings {
  bool toggles = false;
  double close_ratio = model::contact::ContactParameters{}.grip_close_ratio;
  double open_ratio = model::contact::ContactParameters{}.grip_open_ratio;
};

class GripInput {
 public:
  explicit GripInput(const GripSettings& settings) : settings_(settings) {}

  /// `device`: ratio of its last sample; `line`: the grip switch, if one is wired. NaN stays NaN.
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
