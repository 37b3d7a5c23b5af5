// SPDX-License-Identifier: Apache-2.0
// For any answers of a device the start ends: ready or given up, in bounded steps,
// and nothing but the image, the greeting, the speed lock and commands without force is ever sent.
#include <array>

#include "hal/falcon/falcon_boot.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace tact;
using fuzz::require;
using What = hal::falcon::FalconBootAction::What;

constexpr std::array<std::uint8_t, 130> kImage{0xAA, 0x08, 0x01, 0x02};
constexpr hal::falcon::FalconBootSettings kShort{
    .attempts = 2, .report_tries = 2, .greeting_tries = 3};
constexpr int kMaxSteps = 2000;

bool inside_image(fuzz::Bytes bytes) {
  return bytes.data() >= kImage.data() &&
         bytes.data() + bytes.size() <= kImage.data() + kImage.size();
}

void check_written(fuzz::Bytes bytes) {
  require(!bytes.empty() && bytes.size() <= hal::falcon::kFalconChunk);
  if (inside_image(bytes) || std::ranges::equal(bytes, hal::falcon::kFalconGreeting) ||
      std::ranges::equal(bytes, hal::falcon::kFalconSpeedLock))
    return;
  const auto command = hal::falcon::decode_falcon_command(bytes);
  require(command && command->motor == hal::falcon::FalconWords{});
}

}  // namespace

// Each step takes one byte that says what comes of an action, and for a read its bytes.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes input(data, size);
  hal::falcon::FalconBoot boot(kImage, kShort);
  hal::falcon::FalconBootInput heard;
  for (int step = 0; step < kMaxSteps; ++step) {
    const hal::falcon::FalconBootAction action = boot.next(heard);
    if (action.what == What::kReady || action.what == What::kGiveUp) return 0;
    if (action.what == What::kWrite) check_written(action.bytes);
    const fuzz::Bytes reported = fuzz::take(input, 1);
    const std::uint8_t what = reported.empty() ? 0 : reported[0];
    heard.now_ms += action.what == What::kRead ? action.wait_ms : 1;
    heard.failed = what == 0xFF;
    heard.clear_to_send = (what & 0x40) != 0;
    heard.bytes = {};
    if (action.what == What::kRead) heard.bytes = fuzz::take(input, what & 0x3F);
  }
  require(false);  // never ends
  return 0;
}
