// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/sdk_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "hal/force_dimension/library_trust.h"

namespace tact::hal::force_dimension {
namespace {

using model::Error;

/// False when the library has no such symbol.
template <typename Function>
bool find(void* library, const char* symbol, Function& function) {
  void* found = dlsym(library, symbol);
  function = reinterpret_cast<Function>(found);  // what POSIX promises of dlsym
  return found != nullptr;
}

Error not_loaded(const std::string& why) {
  return Error{fmt::format(
      "Force Dimension's library cannot be loaded: {}; it belongs to its maker and is no part of "
      "tact: get the SDK at forcedimension.com, and let device.force_dimension.library name its "
      "libdhd.so.3 by path",
      why)};
}

}  // namespace

model::Result<SdkFunctions> load_sdk(const std::string& name, bool trusted) {
  const auto file = trusted ? model::Result<std::string>(name) : find_library(name);
  if (!file) return not_loaded(file.error().sentence);
  if (!trusted)
    if (const auto refused = distrust_library(*file)) return *refused;
  // NOW: no symbol is looked up in the loop. LOCAL: its names do not reach our other libraries.
  void* library = dlopen(file->c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* why = dlerror();
    return not_loaded(why == nullptr ? name : why);
  }
  SdkFunctions sdk;
  const char* missing = nullptr;
  const auto need = [&](const char* symbol, auto& function) {
    if (!find(library, symbol, function) && missing == nullptr) missing = symbol;
  };
  need("dhdGetDeviceCount", sdk.device_count);
  need("dhdOpenID", sdk.open_id);
  need("dhdClose", sdk.close);
  need("dhdStop", sdk.stop);
  need("dhdGetSystemType", sdk.system_type);
  need("dhdGetStatus", sdk.status);
  need("dhdGetPositionAndOrientationFrame", sdk.pose);
  need("dhdSetForceAndTorqueAndGripperForce", sdk.set_force);
  need("dhdEnableForce", sdk.enable_force);
  need("dhdSetGravityCompensation", sdk.set_gravity_compensation);
  need("dhdEnableExpertMode", sdk.enable_expert_mode);
  need("dhdSetTimeGuard", sdk.set_time_guard);
  need("dhdSetWatchdog", sdk.set_watchdog);
  need("dhdErrorGetLast", sdk.error_get_last);
  if (missing != nullptr) {
    dlclose(library);
    return Error{fmt::format(
        "{} has no function {}, so it is not Force Dimension's library or too old a one; let "
        "device.force_dimension.library name libdhd.so.3 of a current SDK",
        name, missing)};
  }
  // Not needed for a force: an old library may lack them.
  find(library, "dhdSetEffectorMass", sdk.set_effector_mass);
  find(library, "dhdGetSerialNumber", sdk.serial_number);
  return sdk;
}

}  // namespace tact::hal::force_dimension
