// SPDX-License-Identifier: Apache-2.0
// connection_slot.h - a token that every connection holds during its lifetime, as a request, a
// download or a WebSocket. The server counts the copies and admits at most kMaxConnections.
#pragma once

#include <memory>

namespace tact::host::server {

using ConnectionSlot = std::shared_ptr<const void>;

constexpr long kMaxConnections = 64;

}  // namespace tact::host::server
