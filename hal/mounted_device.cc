// SPDX-License-Identifier: Apache-2.0
#include "hal/mounted_device.h"

namespace tact::hal {

Fault MountedDevice::read(Sample& sample, std::int64_t now_ns) RT_SAFE {
  of_base_.fresh = false;
  const Fault fault = device_->read(of_base_, now_ns);
  sample.fresh = of_base_.fresh;
  if (!of_base_.fresh) return fault;
  sample = of_base_;
  const Tool& base = of_base_.tool;
  Tool& tool = sample.tool;
  tool.position_m = mounting_.point_W(base.position_m);
  tool.velocity_mps = mounting_.velocity_W(base.velocity_mps);
  if (turns_tool_) {
    tool.orientation = mounting_.turn * base.orientation;
    tool.angular_velocity_radps = mounting_.direction_W(base.angular_velocity_radps);
  }
  return fault;
}

Fault MountedDevice::write(const Wrench& wrench) RT_SAFE {
  return device_->write({.force_N = mounting_.force_in_base(wrench.force_N),
                         .torque_Nm = turns_tool_ ? mounting_.direction_in_base(wrench.torque_Nm)
                                                  : wrench.torque_Nm});
}

}  // namespace tact::hal
