// SPDX-License-Identifier: Apache-2.0
// Bytes of a stranger on the network are a pose that keeps its promises, or one message.
#include <cmath>
#include <string_view>

#include "host/igtl/igtl_wire.h"
#include "tests/fuzz/fuzz.h"

namespace {

using tact::fuzz::require;

bool is_message(const tact::model::Error& error) {
  return !error.message.empty() && error.message.find('\n') == std::string::npos;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tact::host::igtl;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto head = read_head(bytes.substr(0, kHeaderBytes));
  if (!head) {
    require(is_message(head.error()));
    return 0;
  }
  require(size >= kHeaderBytes && std::isfinite(head->time_s) && head->time_s >= 0.0);
  require(head->type.size() <= kTypeBytes && head->device.size() <= kDeviceBytes);
  const std::string_view body = bytes.substr(kHeaderBytes);
  crc64(body);  // whether it is right is not asked: a stranger can count
  const auto content = content_of(*head, body);
  if (!content) {
    require(is_message(content.error()));
    return 0;
  }
  require(content->bytes.size() <= body.size());
  const auto pose = pose_of(head->type, content->bytes);
  if (!pose) {
    require(is_message(pose.error()));
    return 0;
  }
  require(pose->position_m.allFinite() && std::abs(pose->rotation.norm() - 1.0) < 1e-6);
  return 0;
}
