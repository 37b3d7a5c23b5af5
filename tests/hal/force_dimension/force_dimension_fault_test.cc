// SPDX-License-Identifier: Apache-2.0
// What a Force Dimension device says and does when it fails in the middle of a run.
#include <gtest/gtest.h>

#include "hal/force_dimension/sdk_library.h"
#include "tests/support/device_loop.h"
#include "tests/support/stub_dhd/stub_client.h"

namespace tact::hal::force_dimension::force_dimension_fault_test {

constexpr Wrench kUp{.force_N = {0, 0, 2}, .torque_Nm = {}};

class ForceDimensionFault : public tests::DeviceLoop {
 protected:
  void SetUp() override {
    open(tests::stub_scene());
    for (int i = 0; i < 300; ++i) tick(kUp);  // armed in earnest, forces known to be on
    ASSERT_TRUE(fault == Fault::kNone);
  }
  /// The fault that comes within a second, and stays when its cause is gone.
  Fault lasting_fault() {
    for (int i = 0; i < 1000 && fault == Fault::kNone; ++i) tick(kUp);
    const Fault found = fault;
    EXPECT_TRUE(forces_go_off()) << "the last thing that the thread asks for";
    stub.reset();
    for (int i = 0; i < 100; ++i) tick(kUp);
    EXPECT_EQ(fault, found) << "a fault stays until the device is opened again";
    EXPECT_FALSE(sample.fresh);
    EXPECT_EQ(stub.calls("dhdGetPositionAndOrientationFrame"), 0) << "not one call more";
    return found;
  }
  /// The thread that drives the device may be in the middle of a cycle.
  bool forces_go_off() const {
    double force[6];
    return comes([&] { return stub.last_force(force) == 0; });
  }

  tests::StubDhd stub;
};

TEST_F(ForceDimensionFault, NothingIsWrongAtFirst) {
  EXPECT_EQ(fault, Fault::kNone);
  EXPECT_EQ(device->fault_detail(), "");
}

TEST_F(ForceDimensionFault, APoseThatFailsEndsTheForceAtOnce) {
  stub.fail("dhdGetPositionAndOrientationFrame", 8);
  for (int i = 0; i < 100; ++i) tick(kUp);
  double force[6];
  EXPECT_EQ(stub.last_force(force), 0);
  EXPECT_EQ(force[2], 0.0);
  EXPECT_EQ(lasting_fault(), Fault::kDeviceFailed);
  EXPECT_TRUE(reported("does not report its pose: the pose cannot be computed"))
      << device->fault_detail();
}

TEST_F(ForceDimensionFault, ADeviceThatIsGoneIsUnplugged) {
  stub.fail("dhdSetForceAndTorqueAndGripperForce", 5);
  EXPECT_EQ(lasting_fault(), Fault::kDeviceUnplugged);
  EXPECT_TRUE(reported("does not take a force: the device is gone")) << device->fault_detail();
}

TEST_F(ForceDimensionFault, AStatusThatFailsIsReported) {
  stub.fail("dhdGetStatus", 7);
  EXPECT_EQ(lasting_fault(), Fault::kDeviceFailed);
  EXPECT_TRUE(reported("does not report its status: the device did not answer"))
      << device->fault_detail();
}

TEST_F(ForceDimensionFault, ForcesThatTheDeviceSwitchedOffAreReportedByCause) {
  const char* const words[] = {"does not say why", "button",     "too fast", "watchdog_s",
                               "a program",        "USB failed", "dead-man"};
  for (int cause = 0; cause <= 6; ++cause) {
    if (cause > 0) {
      device.reset();
      SetUp();
    }
    stub.set_status(kSdkForceOffCause, cause);
    stub.set_status(kSdkForce, 0);
    EXPECT_EQ(lasting_fault(), Fault::kForceOff);
    EXPECT_TRUE(reported(words[cause])) << device->fault_detail();
  }
}

TEST_F(ForceDimensionFault, TheDevicesOwnWatchdogEndsWhatALibraryThatHangsLeftBehind) {
  // A busy PC is a silent loop: forces are off before the watchdog looks. One of ten tries has it.
  for (int tries = 0; tries < 10 && fault == Fault::kNone && (tries == 0 || silences > 0);
       ++tries) {
    if (tries > 0) {
      stub.set_delay_us(0);
      device.reset();
      SetUp();
    }
    silences = 0;
    stub.ignore_watchdog(0);
    stub.set_delay_us(60'000);
    for (int i = 0; i < 1000 && fault == Fault::kNone; ++i) tick(kUp);
  }
  EXPECT_EQ(fault, Fault::kForceOff);
  EXPECT_TRUE(reported("watchdog_s")) << device->fault_detail();
  stub.set_delay_us(0);
}

TEST_F(ForceDimensionFault, LostSupplyCableAndCalibrationAreDistinguished) {
  const struct {
    int word, value;
    Fault fault;
    const char* words;
  } cases[] = {{kSdkPower, 0, Fault::kDeviceFailed, "no power"},
               {kSdkConnected, 0, Fault::kDeviceUnplugged, "no longer connected"},
               {kSdkError, 1, Fault::kDeviceFailed, "an error of its own"},
               {kSdkReset, 1, Fault::kHomingLost, "lost its calibration"}};
  for (const auto& c : cases) {
    device.reset();
    SetUp();
    stub.set_status(c.word, c.value);
    EXPECT_EQ(lasting_fault(), c.fault) << c.words;
    EXPECT_TRUE(reported(c.words)) << device->fault_detail();
  }
}

}  // namespace tact::hal::force_dimension::force_dimension_fault_test
