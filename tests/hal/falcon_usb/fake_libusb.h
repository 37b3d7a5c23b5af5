// SPDX-License-Identifier: Apache-2.0
// fake_libusb.h - libusb's functions with a script behind them, for this room's test program.
//
// A program that defines them takes these instead of the library's. Transfers meet the Falcon of
// falcon_device.h.
#pragma once

#include <libusb-1.0/libusb.h>

#include <cstdint>
#include <vector>

#include "tests/support/falcon_device.h"

namespace tact::tests {

struct FakePlug {
  std::uint16_t vendor = 0x0403, product = 0xCB48;
  std::uint8_t bus = 1, address = 4;
  std::vector<std::uint8_t> ports{2, 3};
};

struct FakeUsb {
  std::vector<FakePlug> plugs{FakePlug{}};
  FalconDevice falcon{.runs = true};
  int refused_opens = 0;  // so many end with open_error; 0: all, while there is one
  int opens = 0;
  int open_error = 0, claim_error = 0, driver_active = 0, control_error = 0, bulk_error = 0;
  std::vector<hal::falcon::FtdiRequest> controls;
  bool another_has_it = false;
  int contexts = 0, handles = 0, lists = 0, claims = 0, detach = -1;  // still held
};
extern FakeUsb* fake_usb;  // of the test that runs

}  // namespace tact::tests
