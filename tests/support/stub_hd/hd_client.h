// SPDX-License-Identifier: Apache-2.0
// hd_client.h - the stand-in for the library of OpenHaptics, steered by a test.
#pragma once

#include <unistd.h>

#include <string>

#include "hal/phantom/phantom_device.h"
#include "model/scene/scene.h"
#include "tests/support/stub_hd/stub_hd.h"
#include "tests/support/stub_library.h"

namespace tact::tests {

inline const std::string kStubHdLibrary = std::string(TACT_BINARY_DIR) + "/libtact-stub-hd.so";

class StubHd : public StubLibrary {
 public:
  StubHd() : StubLibrary(kStubHdLibrary) {
    find("stub_hd_reset", reset);
    find("stub_hd_set_calibration", set_calibration);
    find("stub_hd_set_number", set_number);
    find("stub_hd_fail", fail);
    find("stub_hd_lose_force_output", lose_force_output);
    find("stub_hd_hold", hold);
    find("stub_hd_turn", turn);
    find("stub_hd_spin", spin);
    find("stub_hd_unsafe_calls", unsafe_calls);
    find("stub_hd_set_serial", set_serial);
    find("stub_hd_open_anyway", open_anyway);
    find("stub_hd_lean", lean);
    find("stub_hd_set_delay_us", set_delay_us);
    find("stub_hd_silence", silence);
    find("stub_hd_calls", calls);
    find("stub_hd_last_force", last_force);
    find("stub_hd_strongest_N", strongest_N);
    find("stub_hd_is_open", is_open);
    find("stub_hd_name", name);
    reset();
  }

  decltype(&stub_hd_reset) reset = nullptr;
  decltype(&stub_hd_set_calibration) set_calibration = nullptr;
  decltype(&stub_hd_set_number) set_number = nullptr;
  decltype(&stub_hd_fail) fail = nullptr;
  decltype(&stub_hd_lose_force_output) lose_force_output = nullptr;
  decltype(&stub_hd_hold) hold = nullptr;
  decltype(&stub_hd_turn) turn = nullptr;
  decltype(&stub_hd_spin) spin = nullptr;
  decltype(&stub_hd_unsafe_calls) unsafe_calls = nullptr;
  decltype(&stub_hd_set_serial) set_serial = nullptr;
  decltype(&stub_hd_open_anyway) open_anyway = nullptr;
  decltype(&stub_hd_lean) lean = nullptr;
  decltype(&stub_hd_set_delay_us) set_delay_us = nullptr;
  decltype(&stub_hd_silence) silence = nullptr;
  decltype(&stub_hd_calls) calls = nullptr;
  decltype(&stub_hd_last_force) last_force = nullptr;
  decltype(&stub_hd_strongest_N) strongest_N = nullptr;
  decltype(&stub_hd_is_open) is_open = nullptr;
  decltype(&stub_hd_name) name = nullptr;
};

/// Each process has a device of its own name.
inline model::scene::Scene phantom_scene() {
  model::scene::Scene scene;
  scene.path = "liver.toml";
  scene.rate_Hz = 1000.0;
  scene.device.kind = "phantom";
  scene.device.trust_library = true;
  scene.device.of<hal::phantom::PhantomSettings>().library = kStubHdLibrary;
  scene.device.of<hal::phantom::PhantomSettings>().name = "stub " + std::to_string(getpid());
  return scene;
}

}  // namespace tact::tests
