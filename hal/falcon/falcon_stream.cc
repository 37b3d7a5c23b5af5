// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_stream.h"

namespace tact::hal::falcon {

std::optional<FalconReport> FalconStream::push(std::uint8_t byte) RT_SAFE {
  if (!falcon_report_may_have(byte, size_)) {  // a start byte may stand at place 0 only
    dropped_bytes_ += size_;
    size_ = 0;
  }
  if (size_ == 0 && byte != kFalconStart) {
    ++dropped_bytes_;
    return std::nullopt;
  }
  packet_[size_++] = byte;
  if (size_ < kFalconPacketSize) return std::nullopt;
  size_ = 0;
  ++reports_;
  return decode_falcon_report(packet_);
}

}  // namespace tact::hal::falcon
