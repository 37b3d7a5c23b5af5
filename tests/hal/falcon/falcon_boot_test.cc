// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_boot.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/falcon_device.h"
#include "tests/support/no_alloc.h"

namespace tact::hal::falcon::falcon_boot_test {

using tests::Bytes;
using tests::FalconDevice;
using What = FalconBootAction::What;
using Fault = FalconBootFault;

Bytes some_image(std::size_t size = 200) {
  Bytes out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(i * 37 + 5);
  return out;
}

const Bytes kImage = some_image();

TEST(FalconBoot, ADeviceThatRunsIsNotSentItsFirmwareAgain) {
  FalconDevice device{.runs = true, .deaf_reports = 9};
  FalconBoot boot({});
  EXPECT_EQ(device.boot(boot), What::kReady);
  EXPECT_FALSE(boot.uploaded());
  EXPECT_EQ(device.asked, 10);
  EXPECT_EQ(device.greeted, 0);
  EXPECT_EQ(boot.next({}).what, What::kReady);  // and stays so
}

TEST(FalconBoot, AColdDeviceGetsTheWholeImageInOrder) {
  for (const std::size_t size : {1u, 61u, 62u, 63u, 124u, 200u, 8492u}) {
    const Bytes image = some_image(size);
    FalconDevice device{.image_size = size};
    FalconBoot boot(image);
    EXPECT_EQ(device.boot(boot), What::kReady) << size;
    EXPECT_EQ(device.received, image);
    EXPECT_TRUE(boot.uploaded());
    EXPECT_EQ(boot.attempt(), 1);
    EXPECT_EQ(boot.fault(), Fault::kNone);
  }
}

TEST(FalconBoot, RepliesMayComeByteByByteAndWithANullBefore) {
  FalconDevice device{.null_first = true, .read_size = 1};
  FalconBoot boot(kImage);
  EXPECT_EQ(device.boot(boot), What::kReady);
  EXPECT_EQ(boot.attempt(), 1);
  EXPECT_EQ(device.greeted, 1);
}

TEST(FalconBoot, ADeafOrDamagedGreetingIsSaidAgainUpToAHundredTimes) {
  FalconDevice slow{.deaf_greetings = 60, .wrong_greetings = 39};
  FalconBoot patient(kImage);
  EXPECT_EQ(slow.boot(patient), What::kReady);
  EXPECT_EQ(slow.greeted, 100);
  EXPECT_EQ(patient.attempt(), 1);

  FalconDevice slower{.deaf_greetings = 100};
  FalconBoot again(kImage);
  EXPECT_EQ(slower.boot(again), What::kReady);
  EXPECT_EQ(again.attempt(), 2);
  EXPECT_EQ(again.fault(), Fault::kNoGreeting);
}

TEST(FalconBoot, AReplyThatComesLateDoesNotSpoilTheNext) {
  FalconDevice device{.late_greetings = 3};
  FalconBoot boot(kImage);
  EXPECT_EQ(device.boot(boot), What::kReady);
  EXPECT_EQ(device.greeted, 4);
}

TEST(FalconBoot, FirmwareThatDoesNotAnswerIsSentAgain) {
  FalconDevice device{.dead_uploads = 2};
  FalconBoot boot(kImage);
  EXPECT_EQ(device.boot(boot), What::kReady);
  EXPECT_EQ(boot.attempt(), 3);
  EXPECT_TRUE(boot.uploaded());
  EXPECT_EQ(device.received, kImage);
}

TEST(FalconBoot, AChangedOrMissingEchoStartsAgainFromOpening) {
  for (const auto& [device_fault, fault] :
       {std::pair{FalconDevice{.spoiled_echoes = 3}, Fault::kEchoDiffers},
        std::pair{FalconDevice{.swallowed_echoes = 3}, Fault::kEchoMissing}}) {
    FalconDevice device = device_fault;
    FalconBoot boot(kImage);
    EXPECT_EQ(device.boot(boot), What::kReady);
    EXPECT_EQ(boot.attempt(), 4);
    EXPECT_EQ(device.opened, 4);
    EXPECT_EQ(boot.fault(), fault);
    EXPECT_EQ(device.received, kImage);
  }
}

TEST(FalconBoot, AnEchoOfItsOwnQuestionIsNoReport) {
  // what a boot ROM does that was left in the middle of an image
  FalconDevice device;
  device.in_rom = true;
  FalconBoot boot({});
  EXPECT_EQ(device.boot(boot), What::kGiveUp);
  EXPECT_EQ(device.received.size(), 10 * kFalconPacketSize);
}

TEST(FalconBoot, AnEchoThatIsLongerThanTheWordIsDamage) {
  FalconBoot boot(kImage, {.attempts = 1});
  FalconBootAction action = boot.next({});
  for (int guard = 0; guard < 100; ++guard) {
    // a device that says the next byte of the image before it is sent
    Bytes reply;
    const bool image = action.what == What::kWrite && action.bytes.size() == kFalconChunk;
    if (image) {
      reply.assign(action.bytes.begin(), action.bytes.end());
      reply.push_back(kImage[kFalconChunk]);
      action = boot.next({.now_ms = 0});
      EXPECT_EQ(boot.next({.now_ms = 0, .bytes = reply}).what, What::kGiveUp);
      EXPECT_EQ(boot.fault(), Fault::kEchoDiffers);
      return;
    }
    if (action.what == What::kWrite && action.bytes.size() == 3)
      reply.assign(kFalconGreetingReply.begin(), kFalconGreetingReply.end());
    if (action.what == What::kWrite && action.bytes.size() == 1) reply.assign(1, 0x41);
    const bool wrote = action.what == What::kWrite;
    action = boot.next({.now_ms = guard * std::int64_t{1000}, .clear_to_send = true});
    if (wrote && !reply.empty())
      action =
          boot.next({.now_ms = guard * std::int64_t{1000}, .bytes = reply, .clear_to_send = true});
  }
  FAIL() << "no part of the image was sent";
}

TEST(FalconBoot, WithoutClearToSendItGoesOnAfterAWhile) {
  FalconDevice device{.clear_to_send = false};
  FalconBoot boot(kImage);
  EXPECT_EQ(device.boot(boot), What::kReady);
  EXPECT_EQ(boot.attempt(), 1);
  EXPECT_GE(device.now_ms, 200);
}

TEST(FalconBoot, AFailedTransferStartsAgainWhereverItHappens) {
  int at = 0;
  for (bool failed = true; failed; ++at) {
    FalconDevice device{.failing_actions = 9, .first_failing = at};
    FalconBoot boot(kImage);
    ASSERT_EQ(device.boot(boot), What::kReady) << at;
    failed = device.failing_actions == 0;
    EXPECT_EQ(boot.attempt(), failed ? 10 : 1) << at;
    EXPECT_EQ(boot.fault(), failed ? Fault::kTransport : Fault::kNone) << at;
  }
  EXPECT_GT(at, 50);  // every action of a whole run
}

TEST(FalconBoot, GivesUpAfterTenAttemptsAndSaysWhy) {
  struct Case {
    FalconDevice device;
    Fault fault;
  };
  for (const Case& c : {Case{{.deaf_greetings = 9999}, Fault::kNoGreeting},
                        Case{{.knows_speed = false}, Fault::kNoSpeedLock},
                        Case{{.spoiled_echoes = 9999}, Fault::kEchoDiffers},
                        Case{{.swallowed_echoes = 9999}, Fault::kEchoMissing},
                        Case{{.dead_uploads = 9999}, Fault::kNoReport},
                        Case{{.failing_actions = 9999}, Fault::kTransport}}) {
    FalconDevice device = c.device;
    FalconBoot boot(kImage);
    EXPECT_EQ(device.boot(boot), What::kGiveUp);
    EXPECT_EQ(boot.fault(), c.fault);
    EXPECT_EQ(device.opened, 10);
    EXPECT_EQ(boot.next({}).what, What::kGiveUp);  // and stays so
    EXPECT_LT(device.now_ms, 70'000);              // a person waits
  }
}

TEST(FalconBoot, WithoutAnImageAColdDeviceIsGivenUpAtOnce) {
  FalconDevice device;
  FalconBoot boot({});
  EXPECT_EQ(device.boot(boot), What::kGiveUp);
  EXPECT_EQ(boot.fault(), Fault::kNoImage);
  EXPECT_EQ(device.opened, 1);
  EXPECT_EQ(device.greeted, 0);
}

TEST(FalconBoot, HalfReportsBeforeAndAfterAReopenAreNotJoined) {
  FalconBoot boot({});
  const FalconPacket report = encode(FalconReport{.homed = 7});
  const auto answered = [&](std::span<const std::uint8_t> bytes) {
    FalconBootAction action = boot.next({});
    for (int step = 0; step < 20 && action.what != What::kRead; ++step) action = boot.next({});
    return boot.next({.bytes = bytes}).what;
  };
  EXPECT_EQ(answered(std::span(report).first(8)), What::kRead);
  EXPECT_EQ(boot.next({.failed = true}).what, What::kReopen);
  EXPECT_EQ(answered(std::span(report).last(8)), What::kRead);
  EXPECT_EQ(boot.next({.bytes = report}).what, What::kReady);
}

TEST(FalconBoot, NoiseThatNeverEndsIsNoAnswer) {
  FalconBoot boot(kImage);
  const Bytes noise{0x41, 0x41, 0x00, 0x3E};
  std::int64_t now_ms = 0;
  FalconBootInput input;
  for (int step = 0; step < 1'000'000; ++step) {
    const FalconBootAction action = boot.next(input);
    ASSERT_NE(action.what, What::kReady);
    if (action.what == What::kGiveUp) return;
    input = {.now_ms = ++now_ms};
    if (action.what == What::kRead) input.bytes = noise, input.clear_to_send = true;
  }
  FAIL() << "does not end";
}

TEST(FalconBoot, EveryFaultHasItsOwnText) {
  std::set<std::string> messages;
  for (int fault = 1; fault <= static_cast<int>(Fault::kNoReport); ++fault)
    messages.insert(falcon_boot_advice(static_cast<Fault>(fault)));
  EXPECT_EQ(messages.size(), 7u);
  EXPECT_EQ(messages.count(""), 0u);
  EXPECT_STREQ(falcon_boot_advice(Fault::kNone), "");
}

TEST(FalconBoot, LeavesTheHeapAlone) {
  FalconBoot boot(kImage);
  const tests::NoAlloc guard;
  for (int step = 0; step < 200; ++step) (void)boot.next({.now_ms = step * std::int64_t{100}});
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace tact::hal::falcon::falcon_boot_test
