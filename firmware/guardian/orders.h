// SPDX-License-Identifier: Apache-2.0
// orders.h - what tactd tells its guardian: one datagram, and with it two descriptors.
//
// Both programs are built together; a guardian of another build is refused by size and magic.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/shutdown_frames.h"

namespace tact::firmware::guardian {

inline constexpr int kOrdersFd = 0;  // the guardian's end of the socket: its standard input
inline constexpr const char* kProgram = "tact-guardian";

struct Orders {
  std::uint64_t magic = 0x7461'6374'6775'6132;
  hal::ShutdownFrames words;  // its fd is the one that comes with the datagram
  std::int32_t priority = 0;  // SCHED_FIFO
  std::int32_t process = 0;   // whose end it waits for
};

struct TakenOrders {
  Orders orders;
  int liveness_fd = -1;
};

bool give_orders(int socket, const Orders& orders, int liveness_fd);
/// None: nobody gave whole ones of this build.
std::optional<TakenOrders> take_orders(int socket);

}  // namespace tact::firmware::guardian
