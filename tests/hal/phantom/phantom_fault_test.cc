// SPDX-License-Identifier: Apache-2.0
// What a PHANTOM says and does when it fails in the middle of a run.
#include <gtest/gtest.h>

#include <cmath>

#include "hal/phantom/hd_library.h"
#include "tests/support/device_loop.h"
#include "tests/support/stub_hd/hd_client.h"

namespace tact::hal::phantom::phantom_fault_test {

constexpr Wrench kUp{.force_N = {0, 0, 2}, .torque_Nm = {}};

class PhantomFault : public tests::DeviceLoop {
 protected:
  void SetUp() override {
    device.reset();
    stub.reset();
    open(tests::phantom_scene());
    for (int i = 0; i < 300; ++i) tick(kUp);  // armed in earnest, forces known to be on
    ASSERT_EQ(fault, Fault::kNone) << device->fault_detail();
    ASSERT_GT(stub.strongest_N(), 1.9);
  }
  /// The fault that comes within two seconds, and stays when its cause is gone.
  Fault lasting_fault() {
    tick_until([&] { return fault != Fault::kNone; }, kUp);
    const Fault found = fault;
    double force[3];
    EXPECT_TRUE(comes([&] { return stub.last_force(force) == 0 && force[1] == 0.0; }))
        << "the last thing that is asked for";
    sleep_ms(20);
    EXPECT_EQ(stub.unsafe_calls(), 0) << "the frame of the fault carries zero, then off";
    stub.reset();
    for (int i = 0; i < 100; ++i) tick(kUp);
    EXPECT_EQ(fault, found) << "a fault stays until the device is opened again";
    EXPECT_FALSE(sample.fresh);
    EXPECT_EQ(stub.calls("hdBeginFrame"), 0) << "not one call more";
    return found;
  }

  tests::StubHd stub;
};

TEST_F(PhantomFault, NothingIsWrongAtFirst) {
  EXPECT_EQ(fault, Fault::kNone);
  EXPECT_EQ(device->fault_detail(), "");
}

TEST_F(PhantomFault, EveryErrorOfTheLibraryEndsTheForceAndIsReportedAsText) {
  const struct {
    const char* function;
    unsigned code;
    Fault fault;
    const char* words;
  } cases[] = {
      {"hdBeginFrame", 0x0302, Fault::kDeviceUnplugged, "does not answer; check its cable"},
      {"hdEndFrame", 0x0200, Fault::kForceOff, "motors are too warm"},
      {"hdEndFrame", 0x0203, Fault::kForceOff, "stylus moved too fast"},
      {"hdSetDoublev", 0x0204, Fault::kForceOff, "its forces failed"},
      {"hdGetDoublev", 0x0300, Fault::kDeviceFailed, "a fault of its own"},
      {"hdCheckCalibration", 0x0999, Fault::kDeviceFailed, "error 0x0999"}};
  for (const auto& c : cases) {
    SetUp();
    stub.fail(c.function, c.code);
    EXPECT_EQ(lasting_fault(), c.fault) << c.words;
    EXPECT_TRUE(reported("the PHANTOM failed: ") && reported(c.words)) << device->fault_detail();
  }
}

TEST_F(PhantomFault, AForceOutputThatAnotherProgramSwitchedOffIsAFault) {
  stub.lose_force_output();
  EXPECT_EQ(lasting_fault(), Fault::kForceOff);
  EXPECT_TRUE(reported("force output is off; end other programs")) << device->fault_detail();
}

TEST_F(PhantomFault, ALostCalibrationIsAFaultAndSaysWhatToDo) {
  stub.set_calibration(kHdNeedsHand);
  EXPECT_EQ(lasting_fault(), Fault::kHomingLost);
  EXPECT_TRUE(reported("put its stylus into the inkwell, then start tactd again"))
      << device->fault_detail();
}

TEST_F(PhantomFault, AnAnswerThatIsNoCalibrationIsAFault) {
  for (const unsigned status : {0u, 0x5003u}) {
    SetUp();
    stub.set_calibration(status);
    EXPECT_EQ(lasting_fault(), Fault::kHomingLost) << status;
  }
}

TEST_F(PhantomFault, APoseThatIsNoNumberIsAFault) {
  stub.hold(std::nan(""), 0, 0);
  EXPECT_EQ(lasting_fault(), Fault::kSampleNotFinite);
  EXPECT_TRUE(reported("a pose that is no number; check its cable")) << device->fault_detail();
}

TEST_F(PhantomFault, AnUpdateOfTheCalibrationWaitsForTheNextStart) {
  const long updates = stub.calls("hdUpdateCalibration");
  stub.set_calibration(kHdNeedsUpdate);  // the stylus rests in the inkwell
  for (int i = 0; i < 100; ++i) tick(kUp);
  EXPECT_EQ(fault, Fault::kNone) << device->fault_detail();
  EXPECT_EQ(stub.calls("hdUpdateCalibration"), updates)
      << "the position would jump under the force";
}

TEST_F(PhantomFault, ASilentSchedulerLeavesNoFreshSampleAndIsReported) {
  stub.silence(1);
  sleep_ms(10);
  tick(kUp);  // takes what came before
  for (int i = 0; i < 30; ++i) {
    tick(kUp);
    ASSERT_FALSE(sample.fresh);
  }
  EXPECT_TRUE(
      reported("no call for more than 20 ms: the device may still push; switch its supply off"))
      << device->fault_detail();
  stub.silence(0);
  EXPECT_TRUE(comes([&] { return device->fault_detail().empty(); }));
}

TEST_F(PhantomFault, AStopThatTheLibraryDoesNotAnswerIsReported) {
  stub.silence(1);
  device->stop();
  EXPECT_EQ(device->why_not_off(), "the library does not return: switch the device's supply off");
  EXPECT_TRUE(reported("the library does not return")) << device->fault_detail();
  EXPECT_TRUE(stub.is_open()) << "what it still runs is not closed";
  stub.silence(0);  // it lets go after all, before the next test
  EXPECT_TRUE(comes([&] { return !reported("no call for more than"); }));
}

TEST(HdWords, EveryErrorCodeHasATextAndARemedy) {
  for (unsigned code = 0x0100; code < 0x0700; ++code)
    EXPECT_NE(text_of_hd_error(code).find("; "), std::string::npos) << text_of_hd_error(code);
}

}  // namespace tact::hal::phantom::phantom_fault_test
