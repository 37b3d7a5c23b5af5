// SPDX-License-Identifier: Apache-2.0
// usbfs_bus.h - a kernel behind UsbfsPort whose bus does what a test says.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "hal/falcon/falcon_boot.h"
#include "hal/falcon_usb/usbfs_pipe.h"
#include "hal/monotonic.h"

namespace tact::tests {

using namespace hal;

/// Transfers complete in the order of submission.
struct Bus {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<usbdevfs_urb*> in, out, done;
  std::vector<falcon::FalconPacket> commands;
  int reap_error = 0;  // instead of waiting
  int submit_error = 0, in_status = 0;
  bool in_storm = false;  // every IN completes at once with in_status and in_size
  int in_size = 0;
  bool swallow_out = false;  // OUT stays under way
  int out_stalls = 0;        // so many clears until OUT carries again
  std::vector<unsigned> cleared;
  std::vector<falcon::FalconPacket> taken;  // by the device
  int reaps = 0, discards = 0;
  bool closed = false;

  /// Without the zeros of the thread that sends zeros: also a busy PC is a silent loop.
  static std::vector<falcon::FalconPacket> of_loop(std::vector<falcon::FalconPacket> all) {
    std::erase(all, falcon_usb::LoopSilence::zero());
    return all;
  }
  /// A copy: the thread may be adding to it.
  std::vector<falcon::FalconPacket> taken_now() {
    const std::lock_guard lock(mutex);
    return taken;
  }
  template <typename Condition>
  bool wait_for(Condition condition) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(5), condition);
  }
  void finish(std::deque<usbdevfs_urb*>& queue, int status, int size) {
    usbdevfs_urb* urb = queue.front();
    queue.pop_front();
    urb->status = status;
    urb->actual_length = size;
    done.push_back(urb);
    changed.notify_all();
  }
  /// The device sends these bytes; waits until a transfer is there for them.
  void send(const std::vector<std::uint8_t>& bytes, int status = 0) {
    ASSERT_TRUE(wait_for([&] { return !in.empty(); }));
    const std::lock_guard lock(mutex);
    std::ranges::copy(bytes, static_cast<std::uint8_t*>(in.front()->buffer));
    finish(in, status, static_cast<int>(bytes.size()));
  }
  int submit(usbdevfs_urb& urb) {
    const std::lock_guard lock(mutex);
    if (submit_error != 0) return submit_error;
    if (urb.endpoint == falcon::kFalconEndpointIn) {
      EXPECT_EQ(urb.buffer_length, 64);
      in.push_back(&urb);
      if (in_storm) finish(in, in_status, in_size);
    } else {
      EXPECT_EQ(urb.buffer_length, 16);
      out.push_back(&urb);
      commands.emplace_back();
      std::copy_n(static_cast<std::uint8_t*>(urb.buffer), 16, commands.back().begin());
      if (out_stalls == 0 && !swallow_out) taken.push_back(commands.back());
      if (!swallow_out) finish(out, out_stalls == 0 ? 0 : -EPIPE, out_stalls == 0 ? 16 : 0);
    }
    changed.notify_all();
    return 0;
  }
  template <typename Change>
  void change(Change change) {
    const std::lock_guard lock(mutex);
    change();
    changed.notify_all();
  }
};

class BusPort final : public falcon_usb::UsbfsPort {
 public:
  explicit BusPort(Bus& bus) : bus_(bus) {}
  ~BusPort() override { bus_.closed = true; }

#if defined(__clang__) && __clang_major__ >= 20  // a test may lock
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
  int submit(usbdevfs_urb& urb) RT_SAFE override { return bus_.submit(urb); }
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif
  int reap(usbdevfs_urb*& urb) override {
    std::unique_lock lock(bus_.mutex);
    ++bus_.reaps;
    bus_.changed.notify_all();
    bus_.changed.wait(lock, [&] { return !bus_.done.empty() || bus_.reap_error != 0; });
    if (bus_.done.empty()) return bus_.reap_error;
    urb = bus_.done.front();
    bus_.done.pop_front();
    return 0;
  }
  void discard(usbdevfs_urb& urb) override {
    const std::lock_guard lock(bus_.mutex);
    ++bus_.discards;
    for (auto* queue : {&bus_.in, &bus_.out}) {
      const auto found = std::ranges::find(*queue, &urb);
      if (found == queue->end()) continue;
      std::swap(*found, queue->front());
      bus_.finish(*queue, -ENOENT, 0);
    }
  }
  int clear_halt(unsigned endpoint) override {
    const std::lock_guard lock(bus_.mutex);
    bus_.cleared.push_back(endpoint);
    if (endpoint == falcon::kFalconEndpointOut && bus_.out_stalls > 0) --bus_.out_stalls;
    return 0;
  }
  std::span<std::uint8_t> buffer() RT_SAFE override { return buffer_; }

 private:
  Bus& bus_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(falcon_usb::kUsbfsBuffer_bytes);
};

inline std::unique_ptr<falcon::FalconPipe> start(Bus& bus) {
  auto pipe = falcon_usb::UsbfsPipe::start(std::make_unique<BusPort>(bus));
  EXPECT_TRUE(pipe) << pipe.error().message;
  return std::move(*pipe);
}

inline const falcon_usb::UsbThread& thread_of(const falcon::FalconPipe& pipe) {
  return dynamic_cast<const falcon_usb::UsbfsPipe&>(pipe).thread();
}

inline std::vector<std::uint8_t> transfer_of(const falcon::FalconReport& report) {
  const falcon::FalconPacket packet = encode(report);
  std::vector<std::uint8_t> bytes{0x01, 0x60};
  bytes.insert(bytes.end(), packet.begin(), packet.end());
  return bytes;
}

inline bool wait_for_end(const falcon::FalconPipe& pipe) {
  for (int i = 0; i < 2000 && !thread_of(pipe).ended(); ++i) falcon_usb::usb_pause_ns(1'000'000);
  return thread_of(pipe).ended();
}

/// An end by an error: the thread stays.
inline bool wait_for_fault(const falcon::FalconPipe& pipe) {
  for (int i = 0; i < 2000 && pipe.health().end == falcon::FalconPipeEnd::kOpen; ++i)
    falcon_usb::usb_pause_ns(1'000'000);
  return pipe.health().end != falcon::FalconPipeEnd::kOpen;
}

inline falcon::FalconReply wait_for_reply(falcon::FalconPipe& pipe, std::uint64_t sequence) {
  falcon::FalconReply reply;
  for (int i = 0; i < 2000; ++i, falcon_usb::usb_pause_ns(1'000'000))
    if (pipe.newest(reply) && reply.sequence >= sequence) break;
  return reply;
}

inline const falcon::FalconPacket zero_command = encode(falcon::FalconCommand{});
inline const falcon::FalconPacket last_command =
    encode(falcon::FalconCommand{.lights = falcon::kFalconRed});

}  // namespace tact::tests
