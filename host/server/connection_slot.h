// SPDX-License-Identifier: Apache-2.0
// connection_slot.h - what every connection holds while it lasts, whatever it becomes: a request, a
// download, a WebSocket. The server counts the copies and lets in no more than kMaxConnections.
#pragma once

#include <memory>

namespace tact::host::server {

using ConnectionSlot = std::shared_ptr<const void>;

constexpr long kMaxConnections = 64;

}  // namespace tact::host::server
