// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/operator_view.h"

#include <gtest/gtest.h>

#include "tests/support/program.h"
#include "tests/support/puppet_loop.h"

namespace tact::firmware::console::operator_view_test {

class WordyDevice final : public PuppetDevice {
 public:
  using PuppetDevice::PuppetDevice;
  std::string fault_detail() const override { return words; }
  std::string words;
};
class WordyLines final : public hal::SafetyLines {
 public:
  model::Fault read(std::int64_t) RT_SAFE override { return model::Fault::kNone; }
  model::Fault write(const hal::LinesTick&) RT_SAFE override { return model::Fault::kNone; }
  bool enabled() const RT_SAFE override { return true; }
  void scope(bool) RT_SAFE override {}
  void stop() override {}
  std::string fault_detail() const override { return "channel B sticks"; }
  std::string notice() const override { return words; }
  std::string words;
};

class View : public testing::Test {
 protected:
  std::string reported(const protocol::Frame& frame) {
    testing::internal::CaptureStderr();
    view.show(frame);
    return testing::internal::GetCapturedStderr();
  }
  static protocol::Frame frame(loop::State state, model::Fault fault) {
    protocol::Frame frame;
    frame.state = state;
    frame.fault = static_cast<std::uint16_t>(fault);
    return frame;
  }
  loop::SimulatedClock clock;
  WordyDevice device{clock};
  WordyLines lines;
  OperatorView view{device, lines, false};
};

TEST_F(View, AFaultIsReportedOnceWithWhatLiesBehindIt) {
  device.words = "axis 2 (node 2): over-current";
  const std::string first = reported(frame(loop::State::kStopped, model::Fault::kDriveFault));
  EXPECT_NE(first.find("fault 113, drive fault"), std::string::npos) << first;
  EXPECT_NE(first.find("axis 2 (node 2): over-current"), std::string::npos) << first;
  EXPECT_EQ(reported(frame(loop::State::kStopped, model::Fault::kDriveFault)), "");
}

TEST_F(View, ALineThatTakesTheForceWithoutAFaultIsReportedOnceEachTime) {
  const protocol::Frame armed = frame(loop::State::kArmed, model::Fault::kNone);
  EXPECT_EQ(reported(armed), "");
  lines.words = "the clutch line flaps";
  EXPECT_EQ(reported(armed), "tactd: the clutch line flaps\n");
  EXPECT_EQ(reported(armed), "");
  EXPECT_NE(view.status().find("the clutch line flaps"), std::string::npos) << view.status();
  lines.words.clear();
  EXPECT_EQ(reported(armed), "");
  EXPECT_EQ(view.status().find("flaps"), std::string::npos);
  lines.words = "the clutch line flaps";
  EXPECT_NE(reported(armed), "");
}

TEST_F(View, FaultsOfTheLinesAreExplainedByTheLines) {
  device.words = "all is well here";
  for (const model::Fault fault :
       {model::Fault::kEmergencyStop, model::Fault::kLinesDiffer, model::Fault::kLinesLost,
        model::Fault::kDeadManReleased, model::Fault::kGripFlaps}) {
    const std::string first = reported(frame(loop::State::kStopped, fault));
    EXPECT_NE(first.find("channel B sticks"), std::string::npos) << first;
    EXPECT_EQ(first.find("all is well here"), std::string::npos) << first;
  }
}

TEST_F(View, ADeviceWithoutPowerIsNotReadyAndSaysWhatItWaitsFor) {
  device.words = "waiting for power of arm 2";
  const protocol::Frame ready = frame(loop::State::kReady, model::Fault::kNone);
  EXPECT_NE(reported(ready).find("tactd: waiting for power of arm 2"), std::string::npos);
  EXPECT_EQ(reported(ready), "") << "once";
  EXPECT_EQ(view.why_not_arm(), "waiting for power of arm 2");
  EXPECT_NE(view.status().find(": waiting for power of arm 2"), std::string::npos);
  device.words.clear();
  EXPECT_NE(reported(ready).find("ready, force is off"), std::string::npos);
  EXPECT_EQ(view.why_not_arm(), "");
  device.words = "waiting for power of arm 1";  // it goes again before it is armed
  EXPECT_NE(reported(ready).find("waiting for power of arm 1"), std::string::npos);
  EXPECT_EQ(view.why_not_arm(), "waiting for power of arm 1");
  device.words.clear();
  EXPECT_NE(reported(ready).find("ready, force is off"), std::string::npos) << "reported again";
}

TEST_F(View, AToolInsideTheOrganIsReportedOnceEachTime) {
  protocol::Frame inside = frame(loop::State::kArmed, model::Fault::kNone);
  inside.contact[1].state = model::ContactState::kInside;
  EXPECT_NE(reported(inside).find("inside the organ"), std::string::npos);
  EXPECT_EQ(reported(inside), "");
  EXPECT_NE(view.status().find("inside the organ: take the tool out"), std::string::npos);
  EXPECT_EQ(reported(frame(loop::State::kArmed, model::Fault::kNone)), "");
  EXPECT_EQ(view.status().find("inside"), std::string::npos);
  EXPECT_NE(reported(inside), "");
}

TEST_F(View, TheStatusCountsLossesOfContact) {
  protocol::Frame lost = frame(loop::State::kArmed, model::Fault::kNone);
  EXPECT_EQ(reported(lost), "");
  EXPECT_EQ(view.status().find("contact lost"), std::string::npos);
  lost.contact_losses = 3;
  EXPECT_EQ(reported(lost), "");
  EXPECT_NE(view.status().find("contact lost 3 times"), std::string::npos) << view.status();
}

TEST_F(View, ReportsReadinessToThePersonWhoMustArm) {
  EXPECT_NE(reported(frame(loop::State::kReady, model::Fault::kNone)).find("tactctl SCENE arm"),
            std::string::npos);
  EXPECT_EQ(reported(frame(loop::State::kReady, model::Fault::kNone)), "");
}

TEST_F(View, AFaultThatComesAgainAfterAResetIsReportedAgain) {
  EXPECT_NE(reported(frame(loop::State::kStopped, model::Fault::kEmergencyStop)), "");
  reported(frame(loop::State::kReady, model::Fault::kNone));
  EXPECT_NE(reported(frame(loop::State::kStopped, model::Fault::kEmergencyStop)), "");
}

TEST_F(View, ReasonOfAnUnreadyDeviceIsReportedOnce) {
  device.words = "not homed: pull the grip out, then push it in";
  EXPECT_NE(reported(frame(loop::State::kOff, model::Fault::kNone)).find("pull the grip out"),
            std::string::npos);
  EXPECT_EQ(reported(frame(loop::State::kOff, model::Fault::kNone)), "");
  EXPECT_EQ(reported(frame(loop::State::kArmed, model::Fault::kNone)), "")
      << "ready: nothing to wait for";
}

TEST(Sayings, UnwritableTerminalDoesNotEndTheRun) {
  const std::string report = testing::TempDir() + "unheard.json";
  const tests::Outcome outcome =
      tests::run_command(tests::program_path("tactd") +
                         " " TACT_SOURCE_DIR
                         "/model/scenes/liver.toml --free-run "
                         "--seconds 1 --no-telemetry --json " +
                         report + " >/dev/full 2>/dev/full; echo $?; grep -c force_hash " + report);
  EXPECT_EQ(outcome.output, "2\n1\n");  // the run goes to its end; its status shows it
}

}  // namespace tact::firmware::console::operator_view_test
