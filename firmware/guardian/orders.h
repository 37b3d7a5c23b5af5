// SPDX-License-Identifier: Apache-2.0
// orders.h - the one datagram that tactd sends to its guardian, with two descriptors attached.
//
// The guardian refuses orders of another build by their size and magic number.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/shutdown_frames.h"

namespace tact::firmware::guardian {

inline constexpr int kOrdersFd = 0;  // the guardian's end of the socket: its standard input
inline constexpr const char* kProgram = "tact-guardian";

struct Orders {
  std::uint64_t magic = 0x7461'6374'6775'6133;
  hal::ShutdownFrames frames;   // its fd is valid only in the sender; the datagram carries another
  std::int32_t priority = 0;    // SCHED_FIFO
  std::int32_t process = 0;     // process id of tactd, for the message
  std::int64_t silence_ns = 0;  // tactd counts no further for so long: as if it had died
  std::int64_t period_ns = 0;   // of the loop
};

struct TakenOrders {
  Orders orders;
  int liveness_fd = -1;
};

bool give_orders(int socket, const Orders& orders, int liveness_fd);
/// None: no complete orders of this build were received.
std::optional<TakenOrders> take_orders(int socket);

}  // namespace tact::firmware::guardian
