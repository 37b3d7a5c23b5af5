// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/hand_socket.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace tact::hal::sim {
namespace {

using model::Result;

constexpr double kFarthest_m = 1.0;  // no hand is farther from the middle of this device
constexpr double kMaxTurn_rad = std::numbers::pi + 1e-9;  // as far as a rounded one goes

}  // namespace

bool is_sound(const HandTarget& target) RT_SAFE {
  if (target.magic != kHandTargetMagic || target.version != kHandTargetVersion) return false;
  for (const double x : target.position_m)
    if (!(std::abs(x) <= kFarthest_m)) return false;
  const auto& [x, y, z] = target.rotation_rad;
  if (!(std::hypot(x, y, z) <= kMaxTurn_rad)) return false;
  return std::isfinite(target.grip_ratio);
}

Result<std::unique_ptr<HandSocket>> HandSocket::start(const std::string& path,
                                                      threads::LatestSlot<HandTarget>& newest) {
  const auto descriptor = model::io::bind_socket(path, SOCK_DGRAM | SOCK_CLOEXEC);
  if (!descriptor) return descriptor.error();
  std::unique_ptr<HandSocket> hand(new HandSocket(*descriptor, path, newest));
  auto thread = threads::start_thread("tact-hand", [&hand = *hand] { hand.listen(); });
  if (!thread) return thread.error();
  hand->thread_ = std::move(*thread);
  return hand;
}

HandSocket::HandSocket(int descriptor, const std::string& path,
                       threads::LatestSlot<HandTarget>& newest)
    : descriptor_(descriptor), path_(path), file_(path), newest_(newest) {}

HandSocket::~HandSocket() { stop(); }

void HandSocket::stop() {
  if (stopping_.exchange(true)) return;
  shutdown(descriptor_, SHUT_RD);  // ends the wait
  thread_.join();
  close(descriptor_);
  file_.remove();
}

void HandSocket::listen() {
  while (!stopping_) {
    HandTarget target;
    // MSG_TRUNC gives the true size, so that a longer datagram is not mistaken for a target.
    const ssize_t size = recv(descriptor_, &target, sizeof target, MSG_TRUNC);
    if (size == static_cast<ssize_t>(sizeof target) && is_sound(target)) newest_.write(target);
  }
}

}  // namespace tact::hal::sim
