// SPDX-License-Identifier: Apache-2.0
// The whole program on a PHANTOM, by the stand-in for its library: limits that do not fit the
// device, and a library that hangs in the middle of a run.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/support/stub_hd/hd_client.h"
#include "tests/system/tactd_fixture.h"

namespace tact::tests::phantom_run_test {

class PhantomRun : public Tactd {
 protected:
  Outcome run(const std::string& options) {
    return tactd(
        kLiver +
        " --no-telemetry --no-seccomp --trust-library --set 'device.kind=\"phantom\"' --set "
        "'device.phantom.library=\"" +
        kStubHdLibrary + "\"' --set 'device.phantom.name=\"stub " + std::to_string(getpid()) +
        "\"' " + options);
  }
};

TEST_F(PhantomRun, IsRefusedWhereItsContinuousForceIsBelowTheScenes) {
  const Outcome out = run("--check --set limits.thermal_time_s=0.1");
  EXPECT_EQ(out.status, 2) << out.output;
  EXPECT_TRUE(has(out,
                  "limits.thermal_time_s = 0.1 is too short for this device, which bears 0.88 "
                  "N for long and 3.3 N at most"))
      << out.output;
}

// The stand-in waits for its thread when it is unloaded, as a library may: tactd must not.
class HangingLibrary : public PhantomRun {
 protected:
  Outcome hangs_at(const char* cycle) {
    setenv("TACT_STUB_HD_HANGS_AT", cycle, 1);
    const Outcome out = run("--arm --ticks 400 --set rate_Hz=250 --set limits.energy_J=0.2");
    unsetenv("TACT_STUB_HD_HANGS_AT");
    return out;
  }
};

TEST_F(HangingLibrary, HangInARunEndsWithAMessageAndStatusOne) {
  const Outcome out = hangs_at("800");
  EXPECT_EQ(out.status, 1) << out.output;
  EXPECT_TRUE(has(out, "no call for more than 20 ms: the device may still push")) << out.output;
  EXPECT_TRUE(has(out, "tactd: the library does not return: switch the device's supply off"))
      << out.output;
  EXPECT_TRUE(has(out, "400 ticks at 250 Hz")) << "and its report is complete: " << out.output;
}

TEST_F(HangingLibrary, IsRefusedWhereItHangsAtTheStart) {
  const Outcome out = hangs_at("1");
  EXPECT_EQ(out.status, 2) << out.output;
  EXPECT_TRUE(has(out, "its scheduler made no call within a second")) << out.output;
}

}  // namespace tact::tests::phantom_run_test
