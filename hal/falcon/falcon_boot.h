// SPDX-License-Identifier: Apache-2.0
// falcon_boot.h - how a Falcon is woken: what to do next, from what came back.
//
//     open -> ask for a report -> (it answers) -> ready
//                              -> greet the boot ROM -> raise the speed -> lock it
//                                 -> send the image, compare its echo -> ask for a report -> ready
//
// Pure: no descriptor, no clock. The caller does what `next` says, with the time at hand, and
// reports what came of it, until the answer is kReady or kGiveUp. What goes wrong starts again from
// opening, a few times: that the first upload fails is normal for this device. Source: FP-2, the
// protocol as found by K. Machulis, github.com/libnifalcon/libnifalcon. Times in ms.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/falcon/falcon_packets.h"
#include "hal/falcon/ftdi_requests.h"

namespace tact::hal::falcon {

inline constexpr std::uint16_t kFalconUsbVendor = 0x0403, kFalconUsbProduct = 0xCB48;
inline constexpr std::uint8_t kFalconEndpointOut = 0x02, kFalconEndpointIn = 0x81;
inline constexpr int kFalconUsbInterface = 0;

inline constexpr std::array kFalconOpenRequests{kFtdiPurgeRx, kFtdiPurgeTx};
inline constexpr std::array kFalconBootRequests{
    kFtdiPurgeRx,
    kFtdiPurgeTx,
    ftdi_latency_ms(16),  // at 1 ms the answers come in pieces
    ftdi_divisor(kFtdi9600),
    kFtdi8n1,
    kFtdiFlowNone,
    kFtdiRtsLow,
    kFtdiDtrLow,
    kFtdiDtrHigh};  // DTR resets the processor
inline constexpr std::array kFalconSpeedRequests{kFtdiDtrLow, ftdi_divisor(kFtdi142857)};
inline constexpr std::array kFalconRunRequests{ftdi_latency_ms(1), ftdi_divisor(kFtdi1500000),
                                               kFtdiPurgeRx, kFtdiPurgeTx};
inline constexpr std::array<std::uint8_t, 3> kFalconGreeting{0x0A, 0x43, 0x0D};
inline constexpr std::array<std::uint8_t, 4> kFalconGreetingReply{0x0A, 0x44, 0x2C, 0x0D};
inline constexpr std::array<std::uint8_t, 1> kFalconSpeedLock{0x41};  // the reply is the same
inline constexpr std::size_t kFalconChunk = 62;  // with two status bytes: one full USB packet

enum class FalconBootFault {
  kNone,
  kTransport,    // a request, a write or opening failed
  kNoImage,      // it does not run, and there is nothing to send
  kNoGreeting,   // the boot ROM does not answer
  kNoSpeedLock,  // ... or not at the higher speed
  kEchoMissing,  // part of the image did not come back
  kEchoDiffers,  // ... or came back changed
  kNoReport,     // the image went through, and does not answer
};
/// What happened, and the remedy; "" for kNone.
const char* falcon_boot_advice(FalconBootFault fault) noexcept;

struct FalconBootSettings {
  int attempts = 10;  // from opening
  int report_tries = 10, report_wait_ms = 50;
  int greeting_tries = 100, greeting_wait_ms = 50;  // 7 bytes at 9600 Bd and the latency: 24 ms
  int clear_to_send_wait_ms = 200;                  // then go on without it
  int speed_lock_wait_ms = 100;
  int echo_wait_ms = 200;  // 2 x 62 bytes at 142 857 Bd: 9 ms
};

struct FalconBootInput {
  std::int64_t now_ms = 0;
  bool failed = false;                    // the action could not be done
  std::span<const std::uint8_t> bytes{};  // of kRead: what came, without status bytes; may be none
  bool clear_to_send = false;             // of kRead
};

struct FalconBootAction {
  enum class What {
    kControl,  // send `request`
    kWrite,    // write `bytes` to the OUT endpoint
    kRead,     // read once, for at most wait_ms
    kReopen,   // close, open and claim the interface
    kReady,    // the firmware runs at full speed and answers
    kGiveUp,   // see fault()
  };
  What what = What::kGiveUp;
  FtdiRequest request{};
  std::span<const std::uint8_t> bytes{};
  int wait_ms = 0;
};

class FalconBoot {
 public:
  /// The image must outlive this; an empty one will do for a device whose firmware runs.
  explicit FalconBoot(std::span<const std::uint8_t> image, const FalconBootSettings& settings = {})
      : image_(image), settings_(settings) {}

  /// What to do, from what came of the action before; the first call needs the time only, of a
  /// device just opened.
  FalconBootAction next(const FalconBootInput& input) noexcept;

  int attempt() const noexcept { return attempt_; }  // 1 is the first
  bool uploaded() const noexcept { return uploaded_; }
  FalconBootFault fault() const noexcept { return fault_; }  // the last one

 private:
  enum class Stage { kOpen, kReport, kGreet, kSpeed, kLock, kUpload, kReady, kGivenUp };

  std::span<const FtdiRequest> requests() const noexcept;
  FalconBootAction enter(Stage stage, std::int64_t now_ms) noexcept;
  FalconBootAction exchange(std::int64_t now_ms) noexcept;
  FalconBootAction write(std::span<const std::uint8_t> bytes, int wait_ms) noexcept;
  FalconBootAction read(std::int64_t now_ms) noexcept;
  FalconBootAction heard(const FalconBootInput& input) noexcept;
  FalconBootAction heard_echo(const FalconBootInput& input) noexcept;
  FalconBootAction timed_out(std::int64_t now_ms) noexcept;
  FalconBootAction restart(FalconBootFault fault) noexcept;
  FalconBootAction give_up(FalconBootFault fault) noexcept;
  bool matches(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> reply) noexcept;

  std::span<const std::uint8_t> image_;
  FalconBootSettings settings_;
  Stage stage_ = Stage::kOpen;
  FalconBootAction::What last_ = FalconBootAction::What::kReopen;
  FalconBootFault fault_ = FalconBootFault::kNone;
  // Zero force. The homing request stays set, or a device that is homed might forget it.
  FalconPacket question_ = encode(FalconCommand{.motor = {}, .lights = kFalconRed, .homing = true});
  FalconStream stream_;
  std::size_t request_ = 0;  // of this stage's, the next one
  int attempt_ = 1, tries_ = 0, wait_ms_ = 0;
  std::int64_t deadline_ms_ = 0;
  std::size_t matched_ = 0;  // bytes of the reply
  bool spoiled_ = false, null_seen_ = false;
  std::size_t echoed_ = 0, chunk_echoed_ = 0;
  bool uploaded_ = false;
};

}  // namespace tact::hal::falcon
