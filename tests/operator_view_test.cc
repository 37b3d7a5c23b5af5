#include "firmware/operator_view.h"

#include <gtest/gtest.h>

#include "tests/program.h"
#include "tests/puppet_loop.h"

namespace tact::firmware {
namespace {

class WordyDevice final : public PuppetDevice {
 public:
  using PuppetDevice::PuppetDevice;
  std::string trouble() const override { return words; }
  std::string words;
};
class WordyLines final : public hal::SafetyLines {
 public:
  Fault read(std::int64_t) RT_SAFE override { return Fault::kNone; }
  Fault write(const hal::LinesTick&) RT_SAFE override { return Fault::kNone; }
  bool enabled() const RT_SAFE override { return true; }
  void scope(bool) RT_SAFE override {}
  void stop() override {}
  std::string trouble() const override { return "channel B sticks"; }
};

class View : public testing::Test {
 protected:
  std::string told(const Frame& frame) {
    testing::internal::CaptureStderr();
    view.show(frame);
    return testing::internal::GetCapturedStderr();
  }
  static Frame frame(State state, Fault fault) {
    Frame frame;
    frame.state = state;
    frame.fault = static_cast<std::uint16_t>(fault);
    return frame;
  }
  SimulatedClock clock;
  WordyDevice device{clock};
  WordyLines lines;
  OperatorView view{device, lines, false};
};

TEST_F(View, AFaultIsToldOnceWithWhatLiesBehindIt) {
  device.words = "axis 2 (node 2): over-current";
  const std::string first = told(frame(State::kStopped, Fault::kDriveFault));
  EXPECT_NE(first.find("fault 113, drive fault"), std::string::npos) << first;
  EXPECT_NE(first.find("axis 2 (node 2): over-current"), std::string::npos) << first;
  EXPECT_EQ(told(frame(State::kStopped, Fault::kDriveFault)), "");
}

TEST_F(View, FaultsOfTheLinesAreWordedByTheLines) {
  device.words = "all is well here";
  const std::string first = told(frame(State::kStopped, Fault::kLinesDiffer));
  EXPECT_NE(first.find("channel B sticks"), std::string::npos) << first;
  EXPECT_EQ(first.find("all is well here"), std::string::npos) << first;
}

TEST_F(View, WhoMustArmIsToldWhenTheDeviceIsReady) {
  EXPECT_NE(told(frame(State::kReady, Fault::kNone)).find("pkill -USR2 tactd"), std::string::npos);
  EXPECT_EQ(told(frame(State::kReady, Fault::kNone)), "");
}

TEST_F(View, AFaultThatComesAgainAfterAResetIsToldAgain) {
  EXPECT_NE(told(frame(State::kStopped, Fault::kEmergencyStop)), "");
  told(frame(State::kReady, Fault::kNone));
  EXPECT_NE(told(frame(State::kStopped, Fault::kEmergencyStop)), "");
}

TEST_F(View, WhatADeviceWaitsForIsToldOnceUntilItIsReady) {
  device.words = "not homed: pull the grip out, then push it in";
  EXPECT_NE(told(frame(State::kOff, Fault::kNone)).find("pull the grip out"), std::string::npos);
  EXPECT_EQ(told(frame(State::kOff, Fault::kNone)), "");
  EXPECT_EQ(told(frame(State::kArmed, Fault::kNone)), "") << "ready: nothing to wait for";
}

TEST(Sayings, WhatCannotBeSaidEndsNothing) {
  const std::string report = testing::TempDir() + "unheard.json";
  const tests::Outcome outcome =
      tests::run_command(std::string(TACT_BINARY_DIR) +
                         "/tactd " TACT_SOURCE_DIR
                         "/model/scenes/liver.toml --free-run "
                         "--seconds 1 --no-telemetry --json " +
                         report + " >/dev/full 2>/dev/full; echo $?; grep -c force_hash " + report);
  EXPECT_EQ(outcome.output, "0\n1\n");
}

}  // namespace
}  // namespace tact::firmware
