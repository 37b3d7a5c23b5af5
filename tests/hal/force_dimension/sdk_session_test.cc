// SPDX-License-Identifier: Apache-2.0
#include "hal/force_dimension/sdk_session.h"

#include <gtest/gtest.h>

#include <cstring>

#include "hal/force_dimension/force_dimension_device.h"
#include "hal/force_dimension/sdk_library.h"
#include "tests/support/stub_dhd/stub_client.h"
#include "tests/support/usb_folders.h"

namespace tact::hal::force_dimension::sdk_session_test {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Session : public testing::Test {
 protected:
  /// Why it does not open; everything is closed again by then.
  std::string refusal() {
    const auto session = open_sdk_session(settings, trusted);
    if (session) {
      close_sdk_session(*session);
      return "";
    }
    EXPECT_FALSE(stub.is_open());
    return session.error().message;
  }

  tests::StubDhd stub;
  ForceDimensionSettings settings = tests::stub_scene().device.of<ForceDimensionSettings>();
  bool trusted = true;
};

TEST_F(Session, OpensADelta3) {
  setenv("TACT_STUB_DHD_SERIAL", "1234", 1);
  const auto session = open_sdk_session(settings, true);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_STREQ(session->type.name, "delta.3");
  EXPECT_EQ(session->type.max_force_N, 20.0);
  EXPECT_EQ(session->serial_number, 1234);
  close_sdk_session(*session);
  EXPECT_FALSE(stub.is_open());
}

TEST_F(Session, BalancesItsWeightOnlyWhereMountedAsDelivered) {
  for (const bool hangs : {false, true}) {
    model::DeviceSettings device;
    if (hangs) device.base_orientation_deg = {0.0, 90.0, 0.0};
    const auto session = open_sdk_session(settings, true, mounting_of(device));
    ASSERT_TRUE(session) << session.error().message;
    int watchdog = 0, time_guard = 0, gravity = 7;
    stub.settings(&watchdog, &time_guard, &gravity);
    EXPECT_EQ(gravity, hangs ? 0 : 1) << "along a wrong axis it would push";
    EXPECT_EQ(session->balances_weight, !hangs);
    close_sdk_session(*session);
  }
}

TEST_F(Session, GripsByWhatTheLibraryHas) {
  const auto session = open_sdk_session(settings, true);
  ASSERT_TRUE(session);
  SdkSession s = *session;
  EXPECT_EQ(grip_of(s), GripKind::kButton);
  s.sdk.button_mask = nullptr;
  EXPECT_EQ(grip_of(s), GripKind::kNone);
  s.type.grip = GripKind::kForce;
  EXPECT_EQ(grip_of(s), GripKind::kForce);
  s.sdk.gripper_gap = nullptr;
  EXPECT_EQ(grip_of(s), GripKind::kAngle) << "it reports, and its force could not be limited";
  s.sdk.gripper_angle = nullptr;
  EXPECT_EQ(grip_of(s), GripKind::kNone);
  close_sdk_session(*session);
}

TEST_F(Session, IsConfiguredOnceAndWarmWithoutForce) {
  settings.watchdog_s = 0.004;
  const auto session = open_sdk_session(settings, true);
  ASSERT_TRUE(session);
  int watchdog = 0, time_guard = 7, gravity = 0;
  stub.settings(&watchdog, &time_guard, &gravity);
  EXPECT_EQ(watchdog, 32) << "4 ms in units of 125 us";
  EXPECT_EQ(time_guard, 0);
  EXPECT_EQ(gravity, 1);
  EXPECT_EQ(stub.calls("dhdEnableExpertMode"), 1);
  EXPECT_GE(stub.calls("dhdGetPositionAndOrientationFrame"), 300);
  EXPECT_GE(stub.calls("dhdSetForceAndTorqueAndGripperForce"), 300);
  double force[6];
  EXPECT_EQ(stub.last_force(force), 0) << "forces are off";
  close_sdk_session(*session);
}

TEST_F(Session, TheLongestWatchdogFitsItsByte) {
  settings.watchdog_s = 0.0318;
  const auto session = open_sdk_session(settings, true);
  ASSERT_TRUE(session);
  int watchdog = 0, time_guard = 0, gravity = 0;
  stub.settings(&watchdog, &time_guard, &gravity);
  EXPECT_EQ(watchdog, 254);
  close_sdk_session(*session);
}

TEST_F(Session, AMissingLibrarySaysWhereItIsHad) {
  settings.library = "libdhd-that-is-not-here.so.3";
  const std::string why = refusal();
  EXPECT_TRUE(has(why, "libdhd-that-is-not-here.so.3")) << why;
  EXPECT_TRUE(has(why, "forcedimension.com")) << why;
  EXPECT_TRUE(has(why, "device.force_dimension.library")) << why;
}

TEST_F(Session, AnUntrustedLibraryIsNotLoadedUnlessAPersonSaysSo) {
  trusted = false;
  EXPECT_TRUE(has(refusal(), tests::kStubLibrary + " is not loaded")) << refusal();
  EXPECT_EQ(stub.calls("dhdGetDeviceCount"), 0);
  settings.library = "libdhd-that-is-not-here.so.3";
  EXPECT_TRUE(has(refusal(), "forcedimension.com")) << refusal();
}

TEST_F(Session, AnotherLibraryIsRefusedByTheFirstFunctionItLacks) {
  settings.library = "libm.so.6";
  EXPECT_TRUE(has(refusal(), "libm.so.6 has no function dhdGetDeviceCount")) << refusal();
}

TEST_F(Session, ADeviceThatIsNotThereIsNotAMissingRule) {
  stub.set_count(0);
  EXPECT_TRUE(has(refusal(), "no Force Dimension device is found")) << refusal();
  EXPECT_FALSE(has(refusal(), "rule")) << refusal();
}

TEST_F(Session, ARefusedNodeIsReportedOnlyWhereTheLibraryFindsNothing) {
  const tests::UsbFolders usb("1451", "0402");
  const auto see_refusals = [&] {
    usb.add_node(usb.node, 0);
    tests::drop_privileges();
    const auto open = [&] { return open_sdk_session(settings, true, {}, usb.roots()); };
    if (!open()) _exit(8);  // it opens another one
    stub.set_count(0);
    const auto failed = open();
    _exit(!failed && has(failed.error().message, usb.node + " may not") ? 7 : 9);
  };
  EXPECT_EXIT(see_refusals(), testing::ExitedWithCode(7), "");
}

TEST_F(Session, OneOfSeveralDevicesMustBeNamed) {
  stub.set_count(2);
  EXPECT_TRUE(has(refusal(), "say which one by device.force_dimension.id, 0 to 1")) << refusal();
  settings.id = 1;
  EXPECT_EQ(refusal(), "");
  settings.id = 2;
  EXPECT_TRUE(has(refusal(), "device.force_dimension.id is 2")) << refusal();
}

TEST_F(Session, ADelta6IsDrivenWhereTheLibraryOpensItWithThePublishedLimits) {
  for (const int type : {61, 62, 64}) {
    stub.set_type(type);
    const auto session = open_sdk_session(settings, true);
    ASSERT_TRUE(session) << session.error().message;
    EXPECT_EQ(session->type.max_force_N, 20.0);
    EXPECT_EQ(session->type.max_torque_Nm, 0.2);
    EXPECT_EQ(session->type.radius_m, 0.18);
    EXPECT_EQ(session->type.half_length_m, 0.15);
    EXPECT_TRUE(session->type.wrist && session->type.old);
    close_sdk_session(*session);
  }
}

TEST_F(Session, DeviceTypeWithoutKnownLimitsIsRefused) {
  for (const int type : {60, 81, 82, 91, 131, 132, 7777}) {
    stub.set_type(type);
    EXPECT_TRUE(has(refusal(), std::to_string(type))) << type;
  }
  stub.set_type(131);
  EXPECT_TRUE(has(refusal(), "lambda.6 right (type 131): no limits")) << refusal();
  stub.set_type(60);
  EXPECT_TRUE(has(refusal(), "device.kind = \"falcon\"")) << refusal();
}

TEST_F(Session, EveryTypeOfTheVendorOpensWithForceAndRoom) {
  for (const int type :
       {31, 32, 61, 62, 63, 64, 33, 34, 35, 36, 37, 206, 104, 105, 106, 107, 203, 108, 109}) {
    const auto known = force_dimension_type(type);
    ASSERT_TRUE(known) << type;
    EXPECT_GE(known->max_force_N, 12.0);
    EXPECT_GT(known->radius_m, 0.05);
    EXPECT_GT(known->half_length_m, 0.05);
    EXPECT_TRUE(known->wrist || known->max_torque_Nm == 0.0) << "no torque without a wrist";
  }
}

TEST_F(Session, UncalibratedDeviceIsRefusedWithTheRemedy) {
  stub.set_status(kSdkReset, 1);
  EXPECT_TRUE(has(refusal(), "sweep each axis by hand")) << refusal();
  stub.set_type(104);
  EXPECT_TRUE(has(refusal(), "moves by itself")) << refusal();
}

TEST_F(Session, AWristThatDoesNotKnowItsAnglesIsNotCalibrated) {
  stub.set_type(35);
  stub.set_status(kSdkWristInit, 0);
  EXPECT_TRUE(has(refusal(), "omega.7 right is not calibrated")) << refusal();
  stub.set_type(33);
  EXPECT_EQ(refusal(), "") << "an omega.3 has no wrist";
}

TEST_F(Session, NoPowerAndOwnErrorsAreReported) {
  stub.set_status(kSdkPower, 0);
  EXPECT_TRUE(has(refusal(), "has no power")) << refusal();
  stub.reset();
  stub.set_status(kSdkError, 1);
  EXPECT_TRUE(has(refusal(), "error of its own")) << refusal();
}

TEST_F(Session, EveryCallThatFailsIsReportedAsText) {
  constexpr int kInUse = 20;
  for (const char* function :
       {"dhdOpenID", "dhdGetStatus", "dhdEnableForce", "dhdEnableExpertMode", "dhdSetTimeGuard",
        "dhdSetWatchdog", "dhdSetGravityCompensation", "dhdGetPositionAndOrientationFrame",
        "dhdSetForceAndTorqueAndGripperForce"}) {
    stub.reset();
    stub.fail(function, kInUse);
    EXPECT_TRUE(has(refusal(), "another program uses the device")) << function << refusal();
  }
}

TEST_F(Session, TheTimeGuardAndASaturatedMotorAreNoErrors) {
  for (const int answer : {1, 2}) {
    stub.set_pose_answer(answer);
    EXPECT_EQ(refusal(), "") << answer;
  }
}

TEST(SdkWords, EveryErrorCodeHasATextAndARemedy) {
  for (int code = -2; code < 30; ++code) {
    EXPECT_NE(std::strchr(text_of_sdk_error(code), ';'), nullptr) << text_of_sdk_error(code);
    EXPECT_NE(std::strchr(force_off_text(code), ';'), nullptr) << code;
  }
}

}  // namespace tact::hal::force_dimension::sdk_session_test
