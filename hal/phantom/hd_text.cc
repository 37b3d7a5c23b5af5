// SPDX-License-Identifier: Apache-2.0
#include "hal/phantom/hd_text.h"

#include <fmt/format.h>

namespace tact::hal::phantom {
namespace {

using model::Fault;

struct Row {
  unsigned code;
  Fault fault;
  const char* words;
};
constexpr Row kRows[] = {
    {0x0104, Fault::kDeviceFailed, "the device is not open any more; start tactd again"},
    {0x0200, Fault::kForceOff,
     "its motors are too warm; let them cool down, and lower limits.continuous_force_N"},
    {0x0201, Fault::kForceOff, "the force was above what it can show; lower limits.force_N"},
    {0x0202, Fault::kForceOff, "the force changed too fast for it; lower limits.slew_N_per_s"},
    {0x0203, Fault::kForceOff, "the stylus moved too fast; lead it more slowly"},
    {0x0204, Fault::kForceOff, "its forces failed; switch it off and on"},
    {0x0300, Fault::kDeviceFailed,
     "the device reports a fault of its own; switch it off and on, then calibrate it"},
    {0x0301, Fault::kDeviceFailed,
     "another program uses the device; end it, or unplug the device and plug it in"},
    {0x0302, Fault::kDeviceUnplugged,
     "the device does not answer; check its cable and its supply, and who may open it"},
    {0x0303, Fault::kDeviceUnplugged,
     "its connection is not set up; run the vendor's Touch_Setup, and check its cable"},
    {0x0304, Fault::kDeviceFailed,
     "the library found no clock for its scheduler; end other programs of OpenHaptics"},
    {0x0400, Fault::kDeviceFailed,
     "the library has begun a frame already; report it with the library's version"},
    {0x0401, Fault::kDeviceFailed,
     "the library has ended its frame already; report it with the library's version"},
    {0x0402, Fault::kDeviceFailed, "the library lost a frame; start tactd again"},
    {0x0501, Fault::kDeviceFailed, "the library's scheduler is full; start tactd again"},
    {0x0600, Fault::kDeviceFailed,
     "the library has no valid licence; install OpenHaptics as its vendor says"},
};

const Row* row_of(unsigned code) {
  for (const Row& row : kRows)
    if (row.code == code) return &row;
  return nullptr;
}

}  // namespace

std::string text_of_hd_error(unsigned code) {
  if (const Row* row = row_of(code)) return row->words;
  return fmt::format("the library reports error 0x{:04x}; report it with the library's version",
                     code);
}

Fault fault_of_hd_error(unsigned code) {
  const Row* row = row_of(code);
  return row != nullptr ? row->fault : Fault::kDeviceFailed;
}

}  // namespace tact::hal::phantom
