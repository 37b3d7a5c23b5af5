// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/sdo_client.h"

#include <fmt/core.h>

#include "hal/cia402/canopen_text.h"
#include "model/time_ns.h"

namespace tact::hal::cia402 {
namespace {

// Chosen: CiA 301 leaves this time to the host.
constexpr int kReply_ms = 300;

}  // namespace

std::optional<SdoReply> SdoClient::ask(int node, const std::optional<can::CanFrame>& request,
                                       std::uint16_t index, std::uint8_t sub) {
  can::CanSocket& socket = bus_.socket();
  bus_.push(request);
  bus_.send();
  std::optional<SdoReply> ours;
  for (const std::int64_t end_ns = socket.now_ns() + kReply_ms * model::kMillisecond_ns;
       !ours && bus_.fault() == Fault::kNone && socket.now_ns() < end_ns;) {
    socket.wait(kReply_ms);
    for (const can::CanReceived& one : bus_.receive()) {
      const auto reply = decode_canopen_sdo(one.frame, node);
      // The answer to an earlier request, given up on, may come now.
      if (reply && reply->index == index && reply->sub == sub)
        ours = reply;
      else
        others_(one.frame);
    }
  }
  return ours;
}

std::optional<SdoFailure> SdoClient::write(int node, const SdoWrite& what) {
  const auto reply = ask(node, canopen_sdo_download(node, what), what.index, what.sub);
  // An answer of the wrong kind proves nothing: it counts as none.
  if (!reply || reply->kind == SdoReplyKind::kUpload) return SdoFailure{.silent = true};
  if (reply->kind == SdoReplyKind::kAbort) return SdoFailure{.abort_code = reply->value};
  return std::nullopt;
}

std::optional<std::uint32_t> SdoClient::read(int node, const SdoEntry& entry, SdoFailure& failure) {
  const auto reply =
      ask(node, canopen_sdo_upload(node, entry.index, entry.sub), entry.index, entry.sub);
  failure = {.silent = !reply || reply->kind == SdoReplyKind::kDownloadDone};
  if (failure.silent) return std::nullopt;
  if (reply->kind == SdoReplyKind::kUpload) {
    // Without a size (0x42), bytes behind the object's own may hold anything.
    const bool cut = reply->size == 0 && entry.size < 4;
    return cut ? reply->value & ((1u << 8 * entry.size) - 1u) : reply->value;
  }
  failure.abort_code = reply->value;
  return std::nullopt;
}

void SdoClient::wait(int time_ms) {
  can::CanSocket& socket = bus_.socket();
  const std::int64_t end_ns = socket.now_ns() + time_ms * model::kMillisecond_ns;
  while (bus_.fault() == Fault::kNone && socket.now_ns() < end_ns) {
    socket.wait(1);
    for (const can::CanReceived& one : bus_.receive()) others_(one.frame);
  }
}

std::string sdo_failure_text(const SdoFailure& failure, std::uint16_t index, std::uint8_t sub) {
  if (failure.silent) {
    return fmt::format(
        "does not answer when asked for setting 0x{:04X}:{:02X}: check its supply and the cable",
        index, sub);
  }
  return fmt::format("refuses setting 0x{:04X}:{:02X}: {} (abort code 0x{:08X})", index, sub,
                     sdo_abort_message(failure.abort_code), failure.abort_code);
}

}  // namespace tact::hal::cia402
