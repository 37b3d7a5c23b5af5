// SPDX-License-Identifier: Apache-2.0
// What the whole program says of a guardian. That it zeroes a device is seen on a real kernel
// (tests/rig/run, the cases *-killed): here is neither CAN nor USB.
#include <gtest/gtest.h>

#include "tests/system/tactd_fixture.h"

namespace tact::tests::guardian_reported_test {

class GuardianReport : public Tactd {};

TEST_F(GuardianReport, ADeviceThatCannotBeZeroedIsNamedAtEachStart) {
  const Outcome out = tactd(kLiver + " --no-telemetry --check" + kStubDevice);
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_TRUE(has(out, "if tactd is killed or the library hangs, nothing zeroes this device"))
      << out.output;
}

TEST_F(GuardianReport, SimulatedDeviceNeedsNoGuardian) {
  const Outcome out = tactd(kLiver + " --no-telemetry --check");
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_FALSE(has(out, "is killed")) << out.output;
  EXPECT_FALSE(has(out, "guardian")) << out.output;
}

}  // namespace tact::tests::guardian_reported_test
