// SPDX-License-Identifier: Apache-2.0
#include "hal/cia402/canopen_frames.h"

#include <algorithm>

#include "hal/can/little_endian.h"

namespace tact::hal::cia402 {
namespace {

// CN-1  the identifiers; those of a node are a base and its number
constexpr std::uint32_t kNmtId = 0x000, kEmergencyId = 0x080, kSdoReplyId = 0x580,
                        kSdoRequestId = 0x600, kHeartbeatId = 0x700;

/// CiA 301's connection set: the message's base, and the node in the lower seven bits.
std::uint32_t id_of(std::uint32_t base, int node) RT_SAFE {
  return base + static_cast<std::uint32_t>(node);
}

bool is_from(const can::CanFrame& frame, std::uint32_t base, int node, std::size_t length) RT_SAFE {
  return is_canopen_node(node) && is_data(frame, id_of(base, node), length);
}

/// Byte 0 command, 1 and 2 index, 3 sub-index, 4 to 7 the value of a download.
can::CanFrame sdo_request(int node, std::uint8_t command, std::uint16_t index,
                          std::uint8_t sub) RT_SAFE {
  can::CanFrame frame = can::make_can_frame(id_of(kSdoRequestId, node), 8);
  frame.data[0] = command;
  can::put_unsigned(frame.data, 1, 2, index);
  frame.data[3] = sub;
  return frame;
}

}  // namespace

std::optional<can::CanFrame> canopen_nmt(NmtCommand command, int node_or_all) RT_SAFE {
  if (node_or_all != kCanopenAllNodes && !is_canopen_node(node_or_all)) return std::nullopt;
  can::CanFrame frame = can::make_can_frame(kNmtId, 2);
  frame.data[0] = static_cast<std::uint8_t>(command);
  frame.data[1] = static_cast<std::uint8_t>(node_or_all);
  return frame;
}

can::CanFrame canopen_sync() RT_SAFE { return can::make_can_frame(kCanopenSyncId, 0); }

std::optional<can::CanFrame> canopen_heartbeat(int node, NmtState state) RT_SAFE {
  if (!is_canopen_node(node)) return std::nullopt;
  can::CanFrame frame = can::make_can_frame(id_of(kHeartbeatId, node), 1);
  frame.data[0] = static_cast<std::uint8_t>(state);
  return frame;
}

std::optional<NmtState> decode_canopen_heartbeat(const can::CanFrame& frame, int node) RT_SAFE {
  if (!is_from(frame, kHeartbeatId, node, 1)) return std::nullopt;
  const auto state = static_cast<NmtState>(frame.data[0]);
  // A damaged frame may hold any byte: only these four are states.
  switch (state) {
    case NmtState::kBoot:
    case NmtState::kStopped:
    case NmtState::kOperational:
    case NmtState::kPreOperational:
      return state;
  }
  return std::nullopt;
}

std::optional<Emergency> decode_canopen_emergency(const can::CanFrame& frame, int node) RT_SAFE {
  if (!is_from(frame, kEmergencyId, node, 8)) return std::nullopt;
  Emergency out{
      .code = can::get_u16(frame.data, 0), .error_register = frame.data[2], .manufacturer = {}};
  std::copy_n(frame.data.begin() + 3, 5, out.manufacturer.begin());
  return out;
}

std::optional<can::CanFrame> canopen_sdo_download(int node, const SdoWrite& write) RT_SAFE {
  const bool sized = write.size == 1 || write.size == 2 || write.size == 4;
  if (!is_canopen_node(node) || !sized) return std::nullopt;
  // The size first: a shift of 32 bits by 32 is undefined.
  if (write.size < 4 && write.value >> (8 * write.size) != 0) return std::nullopt;
  // Download request, expedited, with its size: 4 minus the size in bits 2 and 3.
  const auto command = static_cast<std::uint8_t>(0x23u | (4u - write.size) << 2);
  can::CanFrame frame = sdo_request(node, command, write.index, write.sub);
  can::put_unsigned(frame.data, 4, 4, write.value);
  return frame;
}

std::optional<can::CanFrame> canopen_sdo_upload(int node, std::uint16_t index,
                                                std::uint8_t sub) RT_SAFE {
  if (!is_canopen_node(node)) return std::nullopt;
  return sdo_request(node, 0x40, index, sub);  // upload request, CN-1
}

std::optional<SdoReply> decode_canopen_sdo(const can::CanFrame& frame, int node) RT_SAFE {
  if (!is_from(frame, kSdoReplyId, node, 8)) return std::nullopt;
  SdoReply out{.kind = SdoReplyKind::kDownloadDone,
               .index = can::get_u16(frame.data, 1),
               .sub = frame.data[3]};
  switch (frame.data[0]) {
    case 0x60:  // download done
      return out;
    case 0x80:
      out.kind = SdoReplyKind::kAbort;
      out.value = can::get_u32(frame.data, 4);
      return out;
    // Expedited upload: 4 minus the size in bits 2 and 3, as in a download.
    case 0x43:
    case 0x47:
    case 0x4B:
    case 0x4F:
      out.kind = SdoReplyKind::kUpload;
      out.size = static_cast<std::uint8_t>(4u - ((frame.data[0] >> 2) & 3u));
      out.value = static_cast<std::uint32_t>(can::get_unsigned(frame.data, 4, out.size));
      return out;
    case 0x42:  // expedited, without a size: the object has its own
      out.kind = SdoReplyKind::kUpload;
      out.value = can::get_u32(frame.data, 4);
      return out;
    default:
      return std::nullopt;
  }
}

}  // namespace tact::hal::cia402
