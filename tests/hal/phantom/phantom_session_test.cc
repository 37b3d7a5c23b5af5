// SPDX-License-Identifier: Apache-2.0
// What a PHANTOM needs before the loop.
#include "hal/phantom/phantom_session.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hal/device_lock.h"
#include "hal/phantom/hd_library.h"
#include "hal/phantom/phantom_device.h"
#include "tests/support/forked.h"
#include "tests/support/stub_hd/hd_client.h"
#include "tests/support/usb_folders.h"

namespace tact::hal::phantom::phantom_session_test {

class PhantomSessions : public testing::Test {
 protected:
  /// Why it does not open; everything is closed again by then.
  std::string refusal() {
    const auto device = open_phantom(settings, rate_Hz);
    if (device) return "";
    EXPECT_FALSE(stub.is_open());
    return device.error().message;
  }
  void expect_refusal(const std::vector<std::string>& words) {
    const std::string said = refusal();
    for (const std::string& part : words)
      EXPECT_NE(said.find(part), std::string::npos) << part << " in " << said;
  }

  tests::StubHd stub;
  model::DeviceSettings settings = tests::phantom_scene().device;
  double rate_Hz = 1000.0;
};

TEST_F(PhantomSessions, OpensTheDeviceOfThatNameAndTheDefaultOneWithoutAName) {
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(stub.name(), settings.of<PhantomSettings>().name);
  settings.of<PhantomSettings>().name.clear();
  EXPECT_EQ(refusal(), "");
  EXPECT_STREQ(stub.name(), "(default)");
}

TEST_F(PhantomSessions, AMissingLibraryIsReportedWithItsSource) {
  settings.of<PhantomSettings>().library = "libHD-that-is-not-here.so";
  settings.trust_library = false;
  expect_refusal({"3D Systems' library cannot be loaded", "OpenHaptics at 3dsystems.com",
                  "let device.phantom.library name its libHD.so"});
}

TEST_F(PhantomSessions, ALibraryOfAnybodyIsNotLoadedWithoutATrustingPerson) {
  settings.trust_library = false;
  expect_refusal({tests::kStubHdLibrary + " is not loaded", "--trust-library"});
}

TEST_F(PhantomSessions, AnotherLibraryIsRefusedByTheFunctionThatItLacks) {
  settings.of<PhantomSettings>().library = "libm.so.6";
  expect_refusal({"libm.so.6 has no function hdInitDevice", "device.phantom.library"});
}

TEST_F(PhantomSessions, ADeviceThatIsNotThereIsReportedWithItsName) {
  stub.fail("hdInitDevice", 0x0302);
  expect_refusal({"the PHANTOM \"" + settings.of<PhantomSettings>().name + "\" does not open",
                  "the device does not answer", "device.phantom.name"});
}

TEST_F(PhantomSessions, ARefusedNodeIsReportedOnlyWhereTheLibraryOpensNothing) {
  const tests::UsbFolders usb("2988", "0302");
  const auto see_refusals = [&] {
    usb.add_node(usb.node, 0);
    tests::drop_privileges();
    const auto open = [&] {
      return open_phantom_session(settings.of<PhantomSettings>(), true, usb.roots());
    };
    if (!open()) _exit(8);  // it opens another one
    stub.fail("hdInitDevice", 0x0302);
    const auto failed = open();
    _exit(!failed && failed.error().message.find(usb.node + " may not") != std::string::npos ? 7
                                                                                             : 9);
  };
  EXPECT_EXIT(see_refusals(), testing::ExitedWithCode(7), "");
}

TEST_F(PhantomSessions, ADeviceThatOpensWithAnErrorIsClosedAgainWithItsForcesOff) {
  stub.open_anyway(1);
  stub.fail("hdInitDevice", 0x0303);
  expect_refusal({"its connection is not set up"});
  EXPECT_EQ(stub.calls("hdDisable"), 1);
}

TEST_F(PhantomSessions, OneDeviceOfTwoNamesServesOneProgram) {
  const std::string number = "two names " + std::to_string(getpid());
  const tests::Forked other([&] { lock_device("the PHANTOM no. " + number); });
  stub.set_serial(number.c_str());
  expect_refusal({"the PHANTOM no. " + number + " is driven by process"});
  EXPECT_EQ(stub.calls("hdDisable"), 0) << "its forces are the other program's";
  EXPECT_EQ(stub.calls("hdDisableDevice"), 1);
}

TEST_F(PhantomSessions, UncalibratedDeviceIsRefusedWithTheRemedy) {
  stub.set_calibration(kHdNeedsHand);
  expect_refusal({"the Touch is not calibrated; put its stylus into the inkwell"});
  stub.set_number(kHdCalibrationStyle, 1);
  expect_refusal({"the Touch is not calibrated; calibrate it by the vendor's Touch_Diagnostic"});
}

TEST_F(PhantomSessions, AStylusInTheInkwellIsCalibratedByTheStart) {
  stub.set_calibration(kHdNeedsUpdate);
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(stub.calls("hdUpdateCalibration"), 1);
}

TEST_F(PhantomSessions, EncodersThatAreResetByHandAreNeverResetByTact) {
  stub.set_number(kHdCalibrationStyle, 1);
  stub.set_calibration(kHdNeedsUpdate);
  expect_refusal({"not calibrated; calibrate it by the vendor's Touch_Diagnostic"});
  EXPECT_EQ(stub.calls("hdUpdateCalibration"), 0);
}

TEST_F(PhantomSessions, ADeviceWithoutLimitsIsRefused) {
  stub.set_number(kHdMaxForce, 0.0);
  expect_refusal({"reports 0 N and a workspace of 0.12 x 0.07 m, which cannot be"});
}

TEST_F(PhantomSessions, AWorkspaceThatIsNoNumberIsRefused) {
  for (int corner = 0; corner < 6; ++corner) {
    stub.reset();
    stub.set_number(kHdUsableWorkspace + 0x10000u * static_cast<unsigned>(corner + 1),
                    std::nan(""));
    expect_refusal({"which cannot be"});
  }
}

TEST_F(PhantomSessions, EveryCallThatFailsIsReportedAsText) {
  for (const char* function :
       {"hdInitDevice", "hdGetDoublev", "hdGetIntegerv", "hdSetSchedulerRate", "hdStartScheduler",
        "hdBeginFrame", "hdCheckCalibration", "hdEndFrame"}) {
    stub.reset();
    stub.fail(function, 0x0600);
    expect_refusal({"the library has no valid licence"});
  }
}

TEST_F(PhantomSessions, ASchedulerThatNeverCallsIsReported) {
  stub.silence(1);
  const auto device = open_phantom(settings, rate_Hz);
  EXPECT_EQ(stub.calls("hdSetDoublev"), 0);
  stub.silence(0);  // its first call comes after all: zero, and no other
  for (int i = 0; i < 2000 && stub.calls("hdEndFrame") == 0; ++i) usleep(1000);
  usleep(20'000);
  EXPECT_EQ(stub.calls("hdEndFrame"), 1);
  EXPECT_EQ(stub.strongest_N(), 0.0);
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().message.find("its scheduler made no call within a second"),
            std::string::npos)
      << device.error().message;
}

TEST_F(PhantomSessions, ALoopFasterThanTheLibraryIsRefused) {
  rate_Hz = 2000.0;
  expect_refusal({"rate_Hz is 2000", "set rate_Hz to 1000 or less"});
}

}  // namespace tact::hal::phantom::phantom_session_test
