// SPDX-License-Identifier: Apache-2.0
// fake_libusb.h - libusb's functions with a script behind them, for this room's test program.
//
// A program that defines them takes these instead of the library's. Synchronous transfers meet the
// Falcon of falcon_device.h; what asynchronous ones meet is told by the test.
#pragma once

#include <libusb-1.0/libusb.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <mutex>
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
  // Asynchronous
  std::mutex mutex;
  std::deque<libusb_transfer*> in, out, done;
  std::vector<Bytes> commands;
  int submit_error = 0, event_calls = 0, transfers = 0;
  bool hang_up = false, keeps_out = false;
  int out_stalls = 0;  // so many clears until OUT carries again
  std::vector<unsigned> cleared;
  std::vector<Bytes> taken;           // by the device
  int event_fd = -1, other_end = -1;  // a socket pair: what the library waits for

  void complete(libusb_transfer* transfer, libusb_transfer_status status, const Bytes& bytes = {}) {
    std::ranges::copy(bytes, transfer->buffer);
    transfer->actual_length = static_cast<int>(bytes.size());
    transfer->status = status;
    done.push_back(transfer);
    const char one = 1;
    static_cast<void>(::write(other_end, &one, 1));
  }
};
extern FakeUsb* fake_usb;  // of the test that runs

}  // namespace tact::tests
