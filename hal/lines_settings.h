// SPDX-License-Identifier: Apache-2.0
// lines_settings.h - which lines of a GPIO chip a scene wires, for any device (gpio/).
#pragma once

#include <array>
#include <string>

#include "hal/device_facts.h"

namespace tact::hal {

inline constexpr std::array kEventKeys{"event_0", "event_1", "event_2", "event_3",
                                       "event_4", "event_5", "event_6", "event_7"};

/// Lines of one chip, by offset; -1: not wired.
struct LinesSettings {
  static constexpr Section kSection{"lines", "safety lines"};

  std::string chip;  // label or path; empty: no lines
  int estop_a = -1, estop_b = -1;
  int dead_man = -1;
  int enable = -1, heartbeat = -1, led = -1, scope = -1, sync = -1;
  int grip = -1;                 // foot or hand switch that closes the jaws
  bool grip_closes_low = false;  // at the low level; else at the high one
  int clutch = -1;               // switch that parts tool and handle
  std::array<int, kEventKeys.size()> event{-1, -1, -1, -1, -1, -1, -1, -1};
  bool wired() const { return !chip.empty(); }

  void visit(model::ParameterVisitor& k) {
    const auto line = [&k](const char* key, const char* meaning, int& offset) {
      k.whole(key, {-1.0, 511.0}, meaning, offset);
    };
    k.text("chip", "label of the GPIO chip, as gpiodetect shows it, or its path", chip,
           model::Need::kOptional);
    line("estop_a", "in, high = good, channel A of the e-stop; -1: none", estop_a);
    line("estop_b", "in, high = good, channel B", estop_b);
    line("dead_man", "in, high = held", dead_man);
    line("grip", "in, a foot or hand switch that closes the jaws", grip);
    using model::Choice;
    constexpr std::array kGripLevels{Choice{"high", "the jaws close at the high level"},
                                     Choice{"low", "at the low level"}};
    k.choice("grip_closes", kGripLevels, "polarity of the grip line", grip_closes_low,
             model::Need::kOptional);
    line("clutch", "in, high = pressed: the tool stays, the handle moves", clutch);
    line("enable", "out, high = the drives may have power", enable);
    line("heartbeat", "out, toggles after every healthy tick", heartbeat);
    line("led", "out, high = armed", led);
    line("scope", "out, high from wake to write", scope);
    line("sync", "out, high in odd seconds of CLOCK_MONOTONIC", sync);
    for (std::size_t i = 0; i < event.size(); ++i)
      line(kEventKeys[i], "in, a bit of the event word in the log; event_0 is the lowest",
           event[i]);
    // One channel could fail unseen (RT-16).
    if ((estop_a < 0) != (estop_b < 0))
      k.refuse({"estop_a", "estop_b"},
               "device.lines needs both channels of the e-stop, estop_a and estop_b, or none");
  }
};

}  // namespace tact::hal
