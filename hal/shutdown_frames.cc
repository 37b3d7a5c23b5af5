// SPDX-License-Identifier: Apache-2.0
#include "hal/shutdown_frames.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cerrno>

namespace tact::hal {
namespace {

// Chosen: two frames of USB, 2 ms for a full queue, a tick at 1 kHz between steps.
constexpr unsigned kTransferWait_ms = 2;
constexpr int kTries = 10;
constexpr long kBetweenTries_ns = 200'000, kBetweenSteps_ns = 1'000'000;

void wait_ns(long pause_ns) {
  const timespec pause{.tv_sec = 0, .tv_nsec = pause_ns};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
}

int send_datagrams(const ShutdownFrames& frames, std::size_t first, std::size_t last) {
  // Copies on the stack: an iovec takes no const, and the guardian uses no heap.
  std::array<ShutdownFrames::LongBytes, ShutdownFrames::kMax> bytes{};
  std::array<iovec, ShutdownFrames::kMax> place{};
  std::array<mmsghdr, ShutdownFrames::kMax> message{};
  for (std::size_t i = first; i < last; ++i) {
    bytes[i] = frames.frame[i];
    place[i] = {.iov_base = bytes[i].data(), .iov_len = frames.bytes_of(i).size()};
    message[i].msg_hdr.msg_iov = &place[i];
    message[i].msg_hdr.msg_iovlen = 1;
  }
  const auto wanted = static_cast<unsigned>(last - first);
  const int sent = sendmmsg(frames.fd, &message[first], wanted, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent == static_cast<int>(wanted)) return 0;
  // Some went and some did not: the queue is full, and the step is sent again as a whole.
  return sent < 0 ? errno : ENOBUFS;
}

int send_bulk(const ShutdownFrames& frames, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    ShutdownFrames::LongBytes bytes = frames.frame[i];
    usbdevfs_bulktransfer transfer{};
    transfer.ep = frames.endpoint;
    transfer.len = static_cast<unsigned>(frames.bytes_of(i).size());
    transfer.timeout = kTransferWait_ms;
    transfer.data = bytes.data();
    if (ioctl(frames.fd, USBDEVFS_BULK, &transfer) >= 0) continue;
    const int error = errno;
    unsigned halted = frames.endpoint;
    // A stalled endpoint would refuse the zeros for ever; the next try then gets through.
    if (error == EPIPE) ioctl(frames.fd, USBDEVFS_CLEAR_HALT, &halted);
    return error;
  }
  return 0;
}

template <class Bytes>
bool add(ShutdownFrames& to, std::span<const Bytes> frames) {
  if (to.count + frames.size() > ShutdownFrames::kMax) return false;
  for (const Bytes& one : frames) {
    to.step[to.count] = static_cast<std::uint8_t>(to.steps);
    to.size[to.count] = static_cast<std::uint8_t>(one.size());
    std::ranges::copy(one, to.frame[to.count++].begin());
  }
  ++to.steps;
  return true;
}

}  // namespace

bool ShutdownFrames::add_step(std::span<const Bytes> frames) { return add(*this, frames); }
bool ShutdownFrames::add_step(std::span<const LongBytes> frames) { return add(*this, frames); }

int send_step(const ShutdownFrames& frames, std::uint32_t step) {
  const auto all = std::span(frames.step).first(std::min<std::size_t>(frames.count, frames.kMax));
  const auto of_step = std::ranges::equal_range(all, step);
  const auto first = static_cast<std::size_t>(of_step.begin() - all.begin());
  const auto last = first + of_step.size();
  if (first == last) return 0;
  return frames.carrier == ShutdownFrames::Carrier::kUsbBulk ? send_bulk(frames, first, last)
                                                             : send_datagrams(frames, first, last);
}

int send_all(const ShutdownFrames& frames) {
  int first_error = 0;
  for (std::uint32_t step = 0; step < frames.steps; ++step) {
    if (step > 0) wait_ns(kBetweenSteps_ns);
    int error = send_step(frames, step);
    for (int tries = 1; error != 0 && tries < kTries; ++tries) {
      wait_ns(kBetweenTries_ns);
      error = send_step(frames, step);
    }
    // The steps after it are sent all the same: power off may get through where zero did not.
    if (first_error == 0) first_error = error;
  }
  return first_error;
}

}  // namespace tact::hal
