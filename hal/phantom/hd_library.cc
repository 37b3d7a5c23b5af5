// SPDX-License-Identifier: Apache-2.0
#include "hal/phantom/hd_library.h"

#include <fmt/format.h>

#include "hal/vendor_sdk/load_library.h"

namespace tact::hal::phantom {
namespace {

constexpr vendor_sdk::VendorSdk kVendor{.whose = "3D Systems'",
                                        .source = "OpenHaptics at 3dsystems.com",
                                        .setting = "device.phantom.library",
                                        .file = "libHD.so",
                                        .folder = "/opt/openhaptics"};
constexpr int kMaxErrors = 64;  // a stack that never empties must not hold a thread

// What the error codes mean, for a person. Source: HD-1.
using model::Fault;

struct ErrorRow {
  unsigned code;
  Fault fault;
  const char* words;
};
constexpr ErrorRow kErrorRows[] = {
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

const ErrorRow* row_of(unsigned code) {
  for (const ErrorRow& row : kErrorRows)
    if (row.code == code) return &row;
  return nullptr;
}

}  // namespace

model::Result<HdFunctions> load_hd(const std::string& name, bool trusted) {
  auto library = vendor_sdk::load_library(name, trusted, kVendor);
  if (!library) return library.error();
  HdFunctions hd;
  library->need("hdInitDevice", hd.init_device);
  library->need("hdDisableDevice", hd.disable_device);
  library->need("hdMakeCurrentDevice", hd.make_current);
  library->need("hdBeginFrame", hd.begin_frame);
  library->need("hdEndFrame", hd.end_frame);
  library->need("hdGetError", hd.get_error);
  library->need("hdEnable", hd.enable);
  library->need("hdDisable", hd.disable);
  library->need("hdIsEnabled", hd.is_enabled);
  library->need("hdGetDoublev", hd.get_doubles);
  library->need("hdGetIntegerv", hd.get_integers);
  library->need("hdGetString", hd.get_string);
  library->need("hdSetDoublev", hd.set_doubles);
  library->need("hdCheckCalibration", hd.check_calibration);
  library->need("hdUpdateCalibration", hd.update_calibration);
  library->need("hdSetSchedulerRate", hd.set_scheduler_rate);
  library->need("hdScheduleAsynchronous", hd.schedule);
  library->need("hdUnschedule", hd.unschedule);
  library->need("hdStartScheduler", hd.start_scheduler);
  library->need("hdStopScheduler", hd.stop_scheduler);
  if (auto error = library->lacks()) return *error;
  return hd;
}

unsigned take_hd_errors(const HdFunctions& hd) {
  unsigned oldest = 0;
  for (int i = 0; i < kMaxErrors; ++i) {
    const unsigned code = hd.get_error().code;
    if (code == 0) break;
    oldest = code;
  }
  return oldest;
}

std::string text_of_hd_error(unsigned code) {
  if (const ErrorRow* row = row_of(code)) return row->words;
  return fmt::format("the library reports error 0x{:04x}; report it with the library's version",
                     code);
}

Fault fault_of_hd_error(unsigned code) {
  const ErrorRow* row = row_of(code);
  return row != nullptr ? row->fault : Fault::kDeviceFailed;
}

}  // namespace tact::hal::phantom
