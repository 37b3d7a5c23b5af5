// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/force_dimension_device.h"

#include <fmt/format.h>

#include "hal/force_dimension/sdk_worker.h"
#include "hal/vendor_sdk/library_device.h"

namespace tact::hal::force_dimension {
namespace {

constexpr double kDelay_s = 0.75e-3;  // a cycle of the thread before the loop, one after, and USB
constexpr const char* kOldType =
    "; needs a library that still knows this type; tact has met no such device";
constexpr const char* kUnbalanced =
    "; its weight acts on the hand: the library balances it only if mounted as delivered";
constexpr const char* kDampingKey = "device.force_dimension.damping_Ns_per_m";

DeviceInfo info_of(const SdkSession& session, const ForceDimensionSettings& settings) {
  const ForceDimensionType& type = session.type;
  return {.name = session.serial_number == 0
                      ? fmt::format("Force Dimension {}", type.name)
                      : fmt::format("Force Dimension {} no. {}", type.name, session.serial_number),
          .max_force_N = type.max_force_N,
          .max_torque_Nm = type.max_torque_Nm,
          .workspace_radius_m = type.radius_m,
          .workspace_half_length_m = type.half_length_m,
          .grip = {grip_of(session), grip_of(session) == GripKind::kForce ? kGripperForce_N : 0.0},
          .turns_with_base = type.wrist,
          .at_tool = model::DeviceAtTool{.damping_Ns_per_m = settings.damping_Ns_per_m,
                                         .friction_N = 0.0,  // the vendor states none
                                         .position_step_m = type.resolution_m,
                                         .delay_s = kDelay_s},
          .damping_key = kDampingKey,
          .caution = std::string(vendor_sdk::kNoGuardian) +
                     (session.balances_weight ? "" : kUnbalanced) + (type.old ? kOldType : "") +
                     vendor_sdk::assumed_damping_text(settings.damping_Ns_per_m,
                                                      ForceDimensionSettings{}.damping_Ns_per_m,
                                                      kDampingKey)};
}

}  // namespace

model::Result<std::unique_ptr<Device>> open_force_dimension(const model::DeviceSettings& settings,
                                                            double rate_Hz) {
  const auto session = open_sdk_session(settings.of<ForceDimensionSettings>(),
                                        settings.trust_library, mounting_of(settings));
  if (!session) return session.error();
  const auto worker = SdkWorker::start(*session, rate_Hz);
  if (!worker) return worker.error();
  return std::unique_ptr<Device>(new vendor_sdk::LibraryDevice(
      info_of(*session, settings.of<ForceDimensionSettings>()), *worker));
}

}  // namespace tact::hal::force_dimension
