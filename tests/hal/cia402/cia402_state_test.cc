// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/cia402_state.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/support/no_alloc.h"

namespace tact::hal::cia402::cia402_state_test {

constexpr Cia402State kAll[] = {
    Cia402State::kUnknown,   Cia402State::kNotReady,      Cia402State::kSwitchOnDisabled,
    Cia402State::kReady,     Cia402State::kSwitchedOn,    Cia402State::kOperationEnabled,
    Cia402State::kQuickStop, Cia402State::kFaultReaction, Cia402State::kFault};

/// A drive as the standard draws it: its statusword after a command.
class FakeDrive {
 public:
  explicit FakeDrive(std::uint16_t statusword) : statusword_(statusword) {}
  std::uint16_t statusword() const { return statusword_; }
  void command(std::uint16_t controlword) {
    const bool rising = (controlword & 0x80) != 0 && (last_ & 0x80) == 0;
    last_ = controlword;
    switch (cia402_state(statusword_)) {
      case Cia402State::kFault:
        if (rising) statusword_ = 0x40;
        break;
      case Cia402State::kSwitchOnDisabled:
        if (controlword == 0x06) statusword_ = 0x21;
        break;
      case Cia402State::kReady:
        if (controlword == 0x07) statusword_ = 0x23;
        break;
      case Cia402State::kSwitchedOn:
        if (controlword == 0x0F) statusword_ = 0x27;
        break;
      case Cia402State::kQuickStop:
        if (controlword == 0x00) statusword_ = 0x40;
        break;
      default:
        break;
    }
  }
  std::uint16_t last_ = 0;

 private:
  std::uint16_t statusword_;
};

TEST(Cia402State, EveryStateLeadsToTorqueOneStepPerStatus) {
  for (const std::uint16_t start :
       std::initializer_list<std::uint16_t>{0x40, 0x21, 0x23, 0x27, 0x07, 0x08}) {
    FakeDrive drive(start);
    std::uint16_t last = 0;
    for (int step = 0; step < 5; ++step) {
      const auto next = next_controlword(cia402_state(drive.statusword()), last);
      ASSERT_TRUE(next);
      drive.command(last = *next);
    }
    EXPECT_EQ(cia402_state(drive.statusword()), Cia402State::kOperationEnabled) << start;
  }
}

TEST(Cia402State, AFaultIsResetByARisingEdgeEvenIfTheFirstOneWasNotHeard) {
  FakeDrive drive(0x08);
  drive.last_ = 0x80;  // the bit is up already: no edge
  drive.command(*next_controlword(Cia402State::kFault, 0x00));
  EXPECT_EQ(drive.statusword(), 0x08);
  drive.command(*next_controlword(Cia402State::kFault, 0x80));
  drive.command(*next_controlword(Cia402State::kFault, 0x00));
  EXPECT_EQ(drive.statusword(), 0x40);
}

TEST(Cia402State, NothingIsCommandedWhileTheStateIsUnknownOrInMotion) {
  for (const std::uint16_t last : std::initializer_list<std::uint16_t>{0x00, 0x0F, 0x80}) {
    EXPECT_FALSE(next_controlword(Cia402State::kUnknown, last));
    EXPECT_FALSE(next_controlword(Cia402State::kNotReady, last));
    EXPECT_FALSE(next_controlword(Cia402State::kFaultReaction, last));
  }
}

TEST(Cia402State, NoFaultIsEverTakenForEnabled) {
  // Of all 65536 statuswords: enabled has bits 0 to 2 and 5 set, 3 (fault) and 6 clear.
  for (std::uint32_t word = 0; word <= 0xFFFF; ++word) {
    const bool enabled =
        cia402_state(static_cast<std::uint16_t>(word)) == Cia402State::kOperationEnabled;
    ASSERT_EQ(enabled, (word & 0x27) == 0x27 && (word & 0x48) == 0) << word;
  }
}

TEST(Cia402State, BitsTheVendorMayUseDoNotChangeTheState) {
  for (const std::uint16_t bits : std::initializer_list<std::uint16_t>{0x0010, 0x0080, 0xFF00}) {
    EXPECT_EQ(cia402_state(0x27 | bits), Cia402State::kOperationEnabled);
    EXPECT_EQ(cia402_state(0x08 | bits), Cia402State::kFault);
  }
}

TEST(Cia402State, ADriveFollowsTheTorqueOnlyWhileEnabled) {
  EXPECT_TRUE(cia402_flags(0x1027).following);
  EXPECT_FALSE(cia402_flags(0x0027).following);
  EXPECT_FALSE(cia402_flags(0x1023).following) << "bit 12 means nothing in this state";
  EXPECT_FALSE(cia402_flags(0x1008).following);
  EXPECT_TRUE(cia402_flags(0x0080).warning);
  EXPECT_FALSE(cia402_flags(0xFF7F).warning);
  EXPECT_TRUE(cia402_flags(0x0800).internal_limit);
  EXPECT_FALSE(cia402_flags(0xF7FF).internal_limit);
}

TEST(Cia402State, EveryStateHasItsOwnName) {
  std::set<std::string> names;
  for (const Cia402State state : kAll) names.insert(cia402_state_name(state));
  EXPECT_EQ(names.size(), std::size(kAll));
}

TEST(Cia402State, LeavesTheHeapAlone) {
  const tests::NoAlloc guard;
  const auto next = next_controlword(cia402_state(0x40), 0);
  const bool following = cia402_flags(0x1027).following;
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(next && following);
}

}  // namespace tact::hal::cia402::cia402_state_test
