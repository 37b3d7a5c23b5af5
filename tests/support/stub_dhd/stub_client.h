// SPDX-License-Identifier: Apache-2.0
// stub_client.h - a test's grip on the stand-in for Force Dimension's library.
#pragma once

#include <string>

#include "hal/force_dimension/force_dimension_device.h"
#include "model/scene/scene.h"
#include "tests/support/stub_dhd/stub_dhd.h"
#include "tests/support/stub_library.h"

namespace tact::tests {

inline const std::string kStubLibrary = std::string(TACT_BINARY_DIR) + "/libtact-stub-dhd.so";

class StubDhd : public StubLibrary {
 public:
  StubDhd() : StubLibrary(kStubLibrary) {
    find("stub_dhd_reset", reset);
    find("stub_dhd_set_type", set_type);
    find("stub_dhd_set_count", set_count);
    find("stub_dhd_set_status", set_status);
    find("stub_dhd_fail", fail);
    find("stub_dhd_set_pose_answer", set_pose_answer);
    find("stub_dhd_hold", hold);
    find("stub_dhd_spin", spin);
    find("stub_dhd_turn", turn);
    find("stub_dhd_grip", grip);
    find("stub_dhd_set_delay_us", set_delay_us);
    find("stub_dhd_ignore_watchdog", ignore_watchdog);
    find("stub_dhd_calls", calls);
    find("stub_dhd_last_force", last_force);
    find("stub_dhd_last_grip_N", last_grip_N);
    find("stub_dhd_settings", settings);
    find("stub_dhd_strongest_N", strongest_N);
    find("stub_dhd_switched_with_force", switched_with_force);
    find("stub_dhd_is_open", is_open);
    reset();
    ignore_watchdog(1);
  }

  decltype(&stub_dhd_reset) reset = nullptr;
  decltype(&stub_dhd_set_type) set_type = nullptr;
  decltype(&stub_dhd_set_count) set_count = nullptr;
  decltype(&stub_dhd_set_status) set_status = nullptr;
  decltype(&stub_dhd_fail) fail = nullptr;
  decltype(&stub_dhd_set_pose_answer) set_pose_answer = nullptr;
  decltype(&stub_dhd_hold) hold = nullptr;
  decltype(&stub_dhd_spin) spin = nullptr;
  decltype(&stub_dhd_turn) turn = nullptr;
  decltype(&stub_dhd_grip) grip = nullptr;
  decltype(&stub_dhd_set_delay_us) set_delay_us = nullptr;
  decltype(&stub_dhd_ignore_watchdog) ignore_watchdog = nullptr;
  decltype(&stub_dhd_calls) calls = nullptr;
  decltype(&stub_dhd_last_force) last_force = nullptr;
  decltype(&stub_dhd_last_grip_N) last_grip_N = nullptr;
  decltype(&stub_dhd_settings) settings = nullptr;
  decltype(&stub_dhd_strongest_N) strongest_N = nullptr;
  decltype(&stub_dhd_switched_with_force) switched_with_force = nullptr;
  decltype(&stub_dhd_is_open) is_open = nullptr;
};

inline model::scene::Scene stub_scene() {
  model::scene::Scene scene;
  scene.path = "liver.toml";
  scene.rate_Hz = 1000.0;
  scene.device.kind = "force-dimension";
  scene.device.of<hal::force_dimension::ForceDimensionSettings>().library = kStubLibrary;
  scene.device.trust_library = true;
  return scene;
}

}  // namespace tact::tests
