// SPDX-License-Identifier: Apache-2.0
#include "hal/phantom/hd_library.h"

#include "hal/vendor_sdk/load_library.h"

namespace tact::hal::phantom {
namespace {

constexpr vendor_sdk::VendorSdk kVendor{.whose = "3D Systems'",
                                        .source = "OpenHaptics at 3dsystems.com",
                                        .setting = "device.phantom.library",
                                        .file = "libHD.so",
                                        .folder = "/opt/openhaptics"};
constexpr int kMaxErrors = 64;  // a stack that never empties must not hold a thread

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

}  // namespace tact::hal::phantom
