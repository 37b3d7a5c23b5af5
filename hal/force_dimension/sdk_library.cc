// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/sdk_library.h"

#include "hal/vendor_sdk/load_library.h"

namespace tact::hal::force_dimension {
namespace {

constexpr vendor_sdk::VendorSdk kVendor{.whose = "Force Dimension's",
                                        .source = "the SDK at forcedimension.com",
                                        .setting = "device.force_dimension.library",
                                        .file = "libdhd.so.3",
                                        .folder = "/opt/fd"};

// The place is the code of dhdErrorGetLast; in kForceOff it is that of status word 14.
constexpr std::array kErrors{
    "no error is given; start tactd again",
    "an error without a name; switch the device off and on",
    "communication failed; check the cable and the supply",
    "the device is busy; end the program that uses it",
    "the USB driver is missing; install libusb-1.0-0",
    "the device is gone; plug it in and switch it on",
    "the device does not offer this call; update its firmware or the SDK",
    "the device did not answer in time; keep other traffic off its USB hub",
    "the pose cannot be computed from the encoders; calibrate the device",
    "expert mode is off; update the SDK",
    "the library does not have this call yet; update the SDK",
    "the library is out of memory; close other programs",
    "the device is not ready; wait until its status light is steady",
    "a file of the library is missing; install the SDK again",
    "the device's configuration cannot be read; ask the vendor's support",
    "there is no device of this number; correct device.force_dimension.id",
    "the library calls this function outdated; use an older SDK",
    "the library lost a value; report it with the library's version",
    "the redundant encoders disagree; do not use the device, ask the vendor's support",
    "the call is not enabled on this device; update its firmware",
    "another program uses the device; end it",
    "a value is out of range; report it with the library's version",
    "the library's regulation does not run; start tactd again",
};

constexpr std::array kForceOff{
    "the device does not say why; press its force button and start tactd again",
    "its force button was pressed; press it again and start tactd again",
    "the handle moved too fast; lead it more slowly, then start tactd again",
    "no force arrived for device.force_dimension.watchdog_s; look at the loop's latency (tactd "
    "--strict), then start tactd again",
    "a program switched it off; end other programs on this device, then start tactd again",
    "USB failed; check cable and hub, then start tactd again",
    "the dead-man switch of the device is open; hold it and start tactd again",
};

/// A code that a newer library adds gets the first words.
template <std::size_t n>
const char* pick(const std::array<const char*, n>& table, int i) {
  return table[i >= 0 && i < static_cast<int>(n) ? static_cast<std::size_t>(i) : 0];
}

constexpr int kCommunication = 2, kNoDevice = 5;

}  // namespace

model::Result<SdkFunctions> load_sdk(const std::string& name, bool trusted) {
  auto library = vendor_sdk::load_library(name, trusted, kVendor);
  if (!library) return library.error();
  SdkFunctions sdk;
  library->need("dhdGetDeviceCount", sdk.device_count);
  library->need("dhdOpenID", sdk.open_id);
  library->need("dhdClose", sdk.close);
  library->need("dhdStop", sdk.stop);
  library->need("dhdGetSystemType", sdk.system_type);
  library->need("dhdGetStatus", sdk.status);
  library->need("dhdGetPositionAndOrientationFrame", sdk.pose);
  library->need("dhdSetForceAndTorqueAndGripperForce", sdk.set_force);
  library->need("dhdEnableForce", sdk.enable_force);
  library->need("dhdSetGravityCompensation", sdk.set_gravity_compensation);
  library->need("dhdEnableExpertMode", sdk.enable_expert_mode);
  library->need("dhdSetTimeGuard", sdk.set_time_guard);
  library->need("dhdSetWatchdog", sdk.set_watchdog);
  library->need("dhdErrorGetLast", sdk.error_get_last);
  if (auto error = library->lacks()) return *error;
  // Not needed for a force: an old library may lack them.
  library->find("dhdSetEffectorMass", sdk.set_effector_mass);
  library->find("dhdGetSerialNumber", sdk.serial_number);
  library->find("dhdGetGripperAngleRad", sdk.gripper_angle);
  library->find("dhdGetGripperGap", sdk.gripper_gap);
  library->find("dhdGetButtonMask", sdk.button_mask);
  return sdk;
}

const char* text_of_sdk_error(int code) { return pick(kErrors, code); }

model::Fault fault_of_sdk_error(int code) RT_SAFE {
  return code == kCommunication || code == kNoDevice ? model::Fault::kDeviceUnplugged
                                                     : model::Fault::kDeviceFailed;
}

const char* force_off_text(int cause) { return pick(kForceOff, cause); }

}  // namespace tact::hal::force_dimension
