#include "hal/falcon/falcon_boot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/no_alloc.h"

namespace tact::hal {
namespace {

using Bytes = std::vector<std::uint8_t>;
using What = FalconBootAction::What;
using Fault = FalconBootFault;

Bytes some_image(std::size_t size = 200) {
  Bytes out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(i * 37 + 5);
  return out;
}

/// A Falcon with its adapter, as far as waking goes; its faults are counted down.
struct Device {
  bool runs = false;                         // firmware from before
  bool reports = true;                       // of firmware that was sent
  int deaf_greetings = 0, deaf_reports = 0;  // answers that never come
  int wrong_greetings = 0;                   // ... that come damaged
  bool knows_speed = true, null_first = false, clear_to_send = true;
  int spoiled_echoes = 0, swallowed_echoes = 0;  // one per upload
  int failing_actions = 0;
  std::size_t read_size = 1000;  // how much a read brings

  Bytes pending{}, received{};
  std::int64_t now_ms = 0;
  int opened = 1, greeted = 0, asked = 0;
  std::size_t image_size = 200;
  bool in_rom = false;

  static bool one_of(int& left) { return left > 0 && left-- > 0; }

  void control(const FtdiRequest& request) {
    if (request == kFtdiPurgeRx) pending.clear();
    if (request == kFtdiDtrHigh) in_rom = true, runs = false, received.clear();
    if (request.request == 3 && null_first) pending.assign(1, 0);
  }
  void answer(std::span<const std::uint8_t> bytes) {
    pending.insert(pending.end(), bytes.begin(), bytes.end());
  }
  void write(std::span<const std::uint8_t> bytes) {
    if (bytes.size() == kFalconPacketSize && bytes[0] == kFalconStart && !in_rom) {
      ++asked;
      const auto command = decode_falcon_command(bytes);
      ASSERT_TRUE(command);
      EXPECT_EQ(command->motor, FalconWords{});  // nothing may move
      if (runs && !one_of(deaf_reports)) answer(encode(FalconReport{}));
    } else if (std::ranges::equal(bytes, kFalconGreeting)) {
      ++greeted;
      Bytes reply(kFalconGreetingReply.begin(), kFalconGreetingReply.end());
      if (one_of(deaf_greetings)) return;
      if (one_of(wrong_greetings)) reply[1] ^= 4;
      answer(reply);
    } else if (received.empty() && std::ranges::equal(bytes, kFalconSpeedLock)) {
      if (knows_speed) answer(bytes);
    } else {
      EXPECT_LE(bytes.size(), 62u);
      received.insert(received.end(), bytes.begin(), bytes.end());
      answer(bytes);
      if (decode_falcon_command(bytes)) return;  // a question, left over from before
      if (one_of(spoiled_echoes)) pending.back() ^= 1;
      if (one_of(swallowed_echoes)) pending.pop_back();
      if (received.size() == image_size) in_rom = false, runs = reports;
    }
  }
  /// Until it is ready or given up.
  What boot(FalconBoot& machine) {
    FalconBootInput input{.now_ms = now_ms};
    Bytes heard;
    for (int step = 0; step < 100'000; ++step) {
      const FalconBootAction action = machine.next(input);
      heard.clear();
      input = {};
      if (action.what == What::kReady || action.what == What::kGiveUp) return action.what;
      input.failed = one_of(failing_actions);
      if (action.what == What::kReopen) ++opened;
      if (!input.failed && action.what == What::kControl) control(action.request);
      if (!input.failed && action.what == What::kWrite) write(action.bytes);
      if (action.what == What::kRead) {
        EXPECT_GT(action.wait_ms, 0);
        const auto size = static_cast<std::ptrdiff_t>(std::min(read_size, pending.size()));
        heard.assign(pending.begin(), pending.begin() + size);
        pending.erase(pending.begin(), pending.begin() + size);
        now_ms += heard.empty() ? action.wait_ms : 1;
        input.bytes = heard;
        input.clear_to_send = clear_to_send;
      }
      input.now_ms = now_ms;
    }
    ADD_FAILURE() << "does not end";
    return What::kGiveUp;
  }
};

const Bytes kImage = some_image();

TEST(FalconBoot, ADeviceThatRunsIsNotSentItsFirmwareAgain) {
  Device device{.runs = true, .deaf_reports = 9};
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
    Device device{.image_size = size};
    FalconBoot boot(image);
    EXPECT_EQ(device.boot(boot), What::kReady) << size;
    EXPECT_EQ(device.received, image);
    EXPECT_EQ(boot.echoed_bytes(), size);
    EXPECT_TRUE(boot.uploaded());
    EXPECT_EQ(boot.attempt(), 1);
    EXPECT_EQ(boot.fault(), Fault::kNone);
  }
}

TEST(FalconBoot, RepliesMayComeByteByByteAndWithANullBefore) {
  Device device{.null_first = true, .read_size = 1};
  FalconBoot boot(kImage);
  EXPECT_EQ(device.boot(boot), What::kReady);
  EXPECT_EQ(boot.attempt(), 1);
  EXPECT_EQ(device.greeted, 1);
}

TEST(FalconBoot, ADeafOrDamagedGreetingIsSaidAgainUpToAHundredTimes) {
  Device slow{.deaf_greetings = 60, .wrong_greetings = 39};
  FalconBoot patient(kImage);
  EXPECT_EQ(slow.boot(patient), What::kReady);
  EXPECT_EQ(slow.greeted, 100);
  EXPECT_EQ(patient.attempt(), 1);

  Device slower{.deaf_greetings = 100};
  FalconBoot again(kImage);
  EXPECT_EQ(slower.boot(again), What::kReady);
  EXPECT_EQ(again.attempt(), 2);
  EXPECT_EQ(again.fault(), Fault::kNoGreeting);
}

TEST(FalconBoot, AChangedOrMissingEchoStartsAgainFromOpening) {
  for (const auto& [device_fault, fault] :
       {std::pair{Device{.spoiled_echoes = 3}, Fault::kEchoDiffers},
        std::pair{Device{.swallowed_echoes = 3}, Fault::kEchoMissing}}) {
    Device device = device_fault;
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
  Device device;
  device.in_rom = true;
  FalconBoot boot({});
  EXPECT_EQ(device.boot(boot), What::kGiveUp);
  EXPECT_EQ(device.received.size(), 10 * kFalconPacketSize);
}

TEST(FalconBoot, AnEchoThatIsLongerThanTheWordIsDamage) {
  FalconBoot boot(kImage, {.attempts = 1});
  FalconBootAction action = boot.next({});
  for (int guard = 0; guard < 100 && boot.echoed_bytes() == 0; ++guard) {
    // a device that says everything twice, once it is sent the image
    Bytes reply;
    const bool image = action.what == What::kWrite && action.bytes.size() == kFalconChunk;
    if (image) {
      reply.assign(action.bytes.begin(), action.bytes.end());
      reply.push_back(reply.front());
      action = boot.next({.now_ms = 0});
      EXPECT_EQ(boot.next({.now_ms = 0, .bytes = reply}).what, What::kGiveUp);
      EXPECT_EQ(boot.fault(), Fault::kEchoDiffers);
      return;
    }
    if (action.what == What::kWrite && action.bytes.size() == 3)
      reply.assign(kFalconGreetingReply.begin(), kFalconGreetingReply.end());
    if (action.what == What::kWrite && action.bytes.size() == 1) reply.assign(1, 0x41);
    const bool wrote = action.what == What::kWrite;
    action = boot.next({.now_ms = guard * 1000, .clear_to_send = true});
    if (wrote && !reply.empty())
      action = boot.next({.now_ms = guard * 1000, .bytes = reply, .clear_to_send = true});
  }
  FAIL() << "no part of the image was sent";
}

TEST(FalconBoot, WithoutClearToSendItGoesOnAfterAWhile) {
  Device device{.clear_to_send = false};
  FalconBoot boot(kImage);
  EXPECT_EQ(device.boot(boot), What::kReady);
  EXPECT_EQ(boot.attempt(), 1);
  EXPECT_GE(device.now_ms, 200);
}

TEST(FalconBoot, AFailedTransferStartsAgainWhereverItHappens) {
  for (int failing = 1; failing <= 9; ++failing) {
    Device device{.failing_actions = failing};
    FalconBoot boot(kImage);
    EXPECT_EQ(device.boot(boot), What::kReady) << failing;
    EXPECT_EQ(boot.attempt(), failing + 1);
    EXPECT_EQ(boot.fault(), Fault::kTransport);
  }
}

TEST(FalconBoot, GivesUpAfterTenAttemptsAndSaysWhy) {
  struct Case {
    Device device;
    Fault fault;
  };
  for (const Case& c : {Case{{.deaf_greetings = 9999}, Fault::kNoGreeting},
                        Case{{.knows_speed = false}, Fault::kNoSpeedLock},
                        Case{{.spoiled_echoes = 9999}, Fault::kEchoDiffers},
                        Case{{.swallowed_echoes = 9999}, Fault::kEchoMissing},
                        Case{{.reports = false}, Fault::kNoReport},
                        Case{{.failing_actions = 9999}, Fault::kTransport}}) {
    Device device = c.device;
    FalconBoot boot(kImage);
    EXPECT_EQ(device.boot(boot), What::kGiveUp);
    EXPECT_EQ(boot.fault(), c.fault);
    EXPECT_EQ(device.opened, 10);
    EXPECT_EQ(boot.next({}).what, What::kGiveUp);  // and stays so
    EXPECT_LT(device.now_ms, 70'000);              // a person waits
  }
}

TEST(FalconBoot, WithoutAnImageAColdDeviceIsGivenUpAtOnce) {
  Device device;
  FalconBoot boot({});
  EXPECT_EQ(device.boot(boot), What::kGiveUp);
  EXPECT_EQ(boot.fault(), Fault::kNoImage);
  EXPECT_EQ(device.opened, 1);
  EXPECT_EQ(device.greeted, 0);
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

TEST(FalconBoot, EveryFaultHasWordsOfItsOwn) {
  std::set<std::string> sentences;
  for (int fault = 1; fault <= static_cast<int>(Fault::kNoReport); ++fault)
    sentences.insert(falcon_boot_advice(static_cast<Fault>(fault)));
  EXPECT_EQ(sentences.size(), 7u);
  EXPECT_EQ(sentences.count(""), 0u);
  EXPECT_STREQ(falcon_boot_advice(Fault::kNone), "");
}

TEST(FalconBoot, LeavesTheHeapAlone) {
  FalconBoot boot(kImage);
  const tests::NoAlloc guard;
  for (int step = 0; step < 200; ++step) (void)boot.next({.now_ms = step * 100});
  EXPECT_EQ(guard.calls(), 0u);
}

}  // namespace
}  // namespace tact::hal
