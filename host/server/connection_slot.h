// SPDX-License-Identifier: Apache-2.0
// connection_slot.h - what a connection holds from its first request with the token on, as a
// request, a download or a WebSocket. The server counts the copies and gives out kMaxConnections.
// A connection without one gives way to a newer one.
#pragma once

#include <cstddef>
#include <memory>

namespace tact::host::server {

using ConnectionSlot = std::shared_ptr<const void>;

constexpr long kMaxConnections = 64;
constexpr std::size_t kMaxUnauthenticated = 64;  // connections without a slot

}  // namespace tact::host::server
