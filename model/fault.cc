#include "model/fault.h"

#include <array>

namespace tact::model {
namespace {

constexpr std::array kTable{
    FaultEntry{Fault::kNone, "none", "nothing limits the force", "nothing to do"},
    FaultEntry{Fault::kSampleHeld, "sample held", "the device gave no new sample this tick",
               "harmless when rare; if it repeats, check cable, hub and bus load"},
    FaultEntry{Fault::kSampleStale, "sample stale",
               "two or more samples in a row are missing; the force fades to zero",
               "check cable, hub and bus load"},
    FaultEntry{Fault::kNotArmed, "not armed", "the controller is not armed, the force is zero",
               "it arms by itself once the device gives good samples and no fault stands"},
    FaultEntry{Fault::kOutsideWorkspace, "outside workspace",
               "the tool left the permitted workspace, the force fades to zero",
               "bring the tool back, or widen limits.workspace_* in the scene"},
    FaultEntry{Fault::kForceLimited, "force limited", "the wanted force is above limits.force_N",
               "press less, or soften the law in the scene"},
    FaultEntry{Fault::kTorqueLimited, "torque limited",
               "the wanted torque is above limits.torque_Nm", "shorten the tool's lever arm"},
    FaultEntry{Fault::kSlewLimited, "slew limited",
               "the force changes faster than limits.slew_N_per_s",
               "harmless at a tear or a release; if it stays, soften the law"},
    FaultEntry{Fault::kRampingUp, "ramping up", "the force is being faded in after arming",
               "wait for limits.ramp_s"},
    FaultEntry{Fault::kLawSaturated, "law saturated",
               "the tissue is pressed or pulled beyond the law's working range",
               "press less, or give the law more range in the scene"},
    FaultEntry{Fault::kInternal, "internal", "a value that cannot occur occurred",
               "report it with the recording; do not use the device until it is explained"},
    FaultEntry{Fault::kForceNotFinite, "force not finite", "the model produced NaN or infinity",
               "report it with the recording; check the scene's parameters"},
    FaultEntry{Fault::kSampleNotFinite, "sample not finite", "the device reported NaN or infinity",
               "restart the device; if it repeats, its encoders or driver are broken"},
    FaultEntry{Fault::kDeviceLost, "device lost", "20 samples in a row are missing",
               "check power and cable, then start tactd again"},
    FaultEntry{Fault::kDeviceFailed, "device failed", "the device reported an error",
               "check power, cable and driver of the device, then start tactd again"},
    FaultEntry{Fault::kLoopLate, "loop late",
               "the loop missed its deadlines: 20 periods at once or 20 ticks in a row, 100 in a "
               "row without hard real time",
               "choose a smaller law (tact-plan names one) or a lower rate_Hz, and free the loop's "
               "core of other work, then start tactd again"},
    FaultEntry{Fault::kLawBroke, "law broke",
               "the tissue's law blew up and gives no force that can be trusted",
               "make its step shorter or its springs softer (spring_patch.substeps, integrator), "
               "then start tactd again"},
};

}  // namespace

std::span<const FaultEntry> fault_table() { return kTable; }

const FaultEntry& describe(Fault fault) {
  const FaultEntry* internal = nullptr;
  for (const FaultEntry& entry : kTable) {
    if (entry.fault == fault) return entry;
    if (entry.fault == Fault::kInternal) internal = &entry;
  }
  return *internal;
}

}  // namespace tact::model
