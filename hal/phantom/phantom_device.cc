// SPDX-License-Identifier: Apache-2.0
#include "hal/phantom/phantom_device.h"

#include <fmt/format.h>

#include "hal/phantom/phantom_worker.h"
#include "hal/vendor_sdk/library_device.h"

namespace tact::hal::phantom {
namespace {

// A cycle of the library before the loop, one after, and half of one for USB.
constexpr double kDelay_s = 2.5e-3;
constexpr const char* kDampingKey = "device.phantom.damping_Ns_per_m";

std::string caution_of(const PhantomSession& session, const PhantomSettings& settings) {
  const std::string for_long = session.continuous_force_N > 0.0
                                   ? fmt::format("{:g} N", session.continuous_force_N)
                                   : "not known, so choose limits.continuous_force_N yourself";
  const std::string stiffness = session.max_stiffness_N_per_m > 0.0
                                    ? fmt::format("{:g} N/m", session.max_stiffness_N_per_m)
                                    : "not known";
  return fmt::format(
      "{}; what its motors bear for long: {}; the stiffest law that its vendor advises: {}{}",
      vendor_sdk::kNoGuardian, for_long, stiffness,
      vendor_sdk::assumed_damping_text(settings.damping_Ns_per_m,
                                       PhantomSettings{}.damping_Ns_per_m, kDampingKey));
}

DeviceInfo info_of(const PhantomSession& session, const PhantomSettings& settings) {
  const std::string name = session.model.empty() ? "PHANTOM" : session.model;
  return {.name = session.serial_number.empty()
                      ? name
                      : fmt::format("{} no. {}", name, session.serial_number),
          .max_force_N = session.max_force_N,
          .max_torque_Nm = 0.0,
          .max_continuous_force_N = session.continuous_force_N,
          .workspace_radius_m = session.radius_m,
          .workspace_half_length_m = session.half_length_m,
          .grip = GripKind::kButton,
          .turns_with_base = session.wrist,
          .at_tool = model::DeviceAtTool{.damping_Ns_per_m = settings.damping_Ns_per_m,
                                         .friction_N = 0.0,  // the library reports none
                                         .position_step_m = settings.position_step_m,
                                         .delay_s = kDelay_s},
          .damping_key = kDampingKey,
          .caution = caution_of(session, settings)};
}

}  // namespace

model::Result<std::unique_ptr<Device>> open_phantom(const model::DeviceSettings& settings,
                                                    double rate_Hz) {
  if (rate_Hz > kPhantomRate_Hz)
    return model::Error{
        fmt::format("rate_Hz is {:g}, but the vendor SDK serves a PHANTOM {:g} times a second: set "
                    "rate_Hz to {:g} or less",
                    rate_Hz, kPhantomRate_Hz, kPhantomRate_Hz)};
  const auto session = open_phantom_session(settings.of<PhantomSettings>(), settings.trust_library);
  if (!session) return session.error();
  auto worker = PhantomWorker::start(*session, rate_Hz);
  if (!worker) return worker.error();
  return std::unique_ptr<Device>(
      new vendor_sdk::LibraryDevice(info_of(*session, settings.of<PhantomSettings>()), *worker));
}

}  // namespace tact::hal::phantom
