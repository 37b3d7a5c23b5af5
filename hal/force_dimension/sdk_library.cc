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

}  // namespace tact::hal::force_dimension
