// SPDX-License-Identifier: Apache-2.0
// falcon_device.h - a Falcon with its USB adapter, as far as waking goes, for the tests of
// falcon_boot.
//
// It holds nothing of the real firmware and takes any image of image_size bytes. Each fault is a
// count of how often it shall happen.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/falcon/falcon_boot.h"

namespace tact::tests {

using hal::falcon::FalconBoot;
using hal::falcon::FalconBootAction;
using hal::falcon::FalconBootInput;
using Bytes = std::vector<std::uint8_t>;

struct FalconDevice {
  bool runs = false;                         // firmware from before
  int dead_uploads = 0;                      // firmware that arrives and never answers
  int deaf_greetings = 0, deaf_reports = 0;  // answers that never come
  int wrong_greetings = 0;                   // ... that come damaged
  int late_greetings = 0;                    // ... damaged, and when no program listens any more
  bool knows_speed = true, null_first = false, clear_to_send = true;
  int spoiled_echoes = 0, swallowed_echoes = 0;  // one per upload
  int failing_actions = 0, first_failing = 0;
  std::size_t read_size = 1000;  // how much a read brings

  Bytes pending{}, received{}, late{};
  std::int64_t now_ms = 0;
  int opened = 1, greeted = 0, asked = 0;  // how often, tries included
  std::size_t image_size = 200;
  bool in_rom = false;

  static bool one_of(int& left) { return left > 0 && left-- > 0; }

  void control(const hal::falcon::FtdiRequest& request) {
    if (request == hal::falcon::kFtdiPurgeRx) pending.clear();
    if (request == hal::falcon::kFtdiDtrHigh) in_rom = true, runs = false, received.clear();
    if (request.request == 3 && null_first) pending.assign(1, 0);
  }
  void answer(std::span<const std::uint8_t> bytes) {
    pending.insert(pending.end(), bytes.begin(), bytes.end());
  }
  void write(std::span<const std::uint8_t> bytes) {
    if (bytes.size() == hal::falcon::kFalconPacketSize && bytes[0] == hal::falcon::kFalconStart &&
        !in_rom) {
      ++asked;
      const auto command = hal::falcon::decode_falcon_command(bytes);
      ASSERT_TRUE(command);
      EXPECT_EQ(command->motor, hal::falcon::FalconWords{});  // nothing may move
      if (runs && !one_of(deaf_reports)) answer(hal::falcon::encode(hal::falcon::FalconReport{}));
    } else if (std::ranges::equal(bytes, hal::falcon::kFalconGreeting)) {
      ++greeted;
      Bytes reply(hal::falcon::kFalconGreetingReply.begin(),
                  hal::falcon::kFalconGreetingReply.end());
      if (one_of(deaf_greetings)) return;
      if (one_of(wrong_greetings)) {  // one bit changed, or a byte too many in the middle
        if (wrong_greetings % 2 == 0) reply[1] ^= 4;
        if (wrong_greetings % 2 == 1) reply.insert(reply.begin() + 2, 0xFF);
      }
      if (one_of(late_greetings))
        late.assign(1, 0xFF);
      else
        answer(reply);
    } else if (received.empty() && std::ranges::equal(bytes, hal::falcon::kFalconSpeedLock)) {
      if (knows_speed) answer(bytes);
    } else {
      EXPECT_LE(bytes.size(), 62u);
      received.insert(received.end(), bytes.begin(), bytes.end());
      answer(bytes);
      if (hal::falcon::decode_falcon_command(bytes)) return;  // a question, left over from before
      if (one_of(spoiled_echoes)) pending.back() ^= 1;
      if (one_of(swallowed_echoes)) pending.pop_back();
      if (received.size() == image_size) in_rom = false, runs = !one_of(dead_uploads);
    }
  }
  /// Until it is ready or given up.
  FalconBootAction::What boot(FalconBoot& machine) {
    FalconBootInput input{.now_ms = now_ms};
    Bytes heard;
    for (int step = 0; step < 100'000; ++step) {
      const FalconBootAction action = machine.next(input);
      heard.clear();
      input = {};
      if (action.what == FalconBootAction::What::kReady ||
          action.what == FalconBootAction::What::kGiveUp)
        return action.what;
      input.failed = step >= first_failing && one_of(failing_actions);
      if (action.what == FalconBootAction::What::kReopen) ++opened;
      if (!input.failed && action.what == FalconBootAction::What::kControl) control(action.request);
      if (!input.failed && action.what == FalconBootAction::What::kWrite) write(action.bytes);
      if (!input.failed && action.what == FalconBootAction::What::kRead) {
        EXPECT_GT(action.wait_ms, 0);
        const auto size = static_cast<std::ptrdiff_t>(std::min(read_size, pending.size()));
        heard.assign(pending.begin(), pending.begin() + size);
        pending.erase(pending.begin(), pending.begin() + size);
        now_ms += heard.empty() ? action.wait_ms : 1;
        if (heard.empty()) pending.swap(late);
        input.bytes = heard;
        input.clear_to_send = clear_to_send;
      }
      input.now_ms = now_ms;
    }
    ADD_FAILURE() << "does not end";
    return FalconBootAction::What::kGiveUp;
  }
};

}  // namespace tact::tests
