// SPDX-License-Identifier: Apache-2.0
// usbfs_pipe.h - a Falcon's packets on usbfs transfers that exist before the loop starts.
//
// Four IN transfers are always under way; the thread waits for one, hands its report over and
// submits it again. Commands are submitted by the loop itself: one system call, at most two under
// way, none free is a missed cycle. A transfer of the thread's own carries zeros when the loop has
// gone silent (LoopSilence). Nothing is allocated after the start. After an end by an error the
// thread stays for the commands.
#pragma once

#include <sys/syscall.h>

#include <array>
#include <atomic>
#include <memory>

#include "hal/falcon_usb/falcon_receiver.h"
#include "hal/falcon_usb/usb_thread.h"
#include "hal/falcon_usb/usbfs_port.h"
#include "hal/loop_gone.h"

namespace tact::hal::falcon_usb {

/// Detects a loop that has stopped: a Falcon may hold its last motor words for ever, so the thread
/// that waits for USB sends zeros in its place. The loop only counts its commands; the thread reads
/// the count and its own clock. A loop that continues would write its old force in one step: the
/// pipe reports that it sent zeros, and the device latches a fault.
class LoopSilence {
 public:
  /// `commands`: how many the loop has sent. True: silent for so long; again after as long.
  bool is_due(std::uint64_t commands, std::int64_t now_ns) {
    const bool heard = commands != commands_;
    commands_ = commands;
    if (!heard && (commands == 0 || now_ns - since_ns_ < kLoopGone_ns)) return false;
    since_ns_ = now_ns;
    return !heard;
  }
  /// No force, and a light that says so.
  static falcon::FalconPacket zero() {
    return encode(falcon::FalconCommand{.lights = falcon::kFalconRed});
  }

 private:
  std::uint64_t commands_ = 0;
  std::int64_t since_ns_ = 0;
};

class UsbfsPipe final : public falcon::FalconPipe {
 public:
  static constexpr std::size_t kIn = 4, kOut = 2;  // and one OUT of the thread's own

  /// Submits the IN transfers and starts the thread; an error says what to do.
  static model::Result<std::unique_ptr<falcon::FalconPipe>> start(std::unique_ptr<UsbfsPort> port);
  ~UsbfsPipe() override;

  bool submit(const falcon::FalconPacket& command) RT_SAFE override;
  std::span<const int> loop_calls() const override {
    static constexpr std::array kCalls{SYS_ioctl};
    return kCalls;
  }
  bool newest(falcon::FalconReply& reply) RT_SAFE override { return receiver_.newest(reply); }
  falcon::FalconPipeHealth health() const RT_SAFE override { return receiver_.health(); }
  int descriptor() const override { return port_ ? port_->descriptor() : -1; }
  void stop(const falcon::FalconPacket& last) override;
  const UsbThread& thread() const { return thread_; }

 private:
  explicit UsbfsPipe(std::unique_ptr<UsbfsPort> port);
  void run();
  /// Did that bring anything? `urb` is under way again or at rest.
  bool completed(usbdevfs_urb& urb);
  void command_completed(int error);
  void stand_in_for_loop(std::int64_t now_ns);
  bool any_busy(std::size_t from) const;
  bool send_last(const falcon::FalconPacket& last);
  void finish(int error) RT_SAFE;

  std::unique_ptr<UsbfsPort> port_;
  FalconReceiver receiver_;
  static constexpr std::size_t kOwn = kIn + kOut;
  // IN first. Each alone: a URB ends in an array of no fixed size.
  std::array<std::unique_ptr<usbdevfs_urb>, kOwn + 1> urbs_;
  std::array<std::atomic<bool>, kOwn + 1> busy_{};  // OUT: set by the loop, cleared by the thread
  std::atomic<std::uint64_t> commands_{0};          // that the loop has asked for
  LoopSilence silence_;                             // thread only
  std::atomic<int> command_error_{0};               // errno of the last command that came back
  std::atomic<bool> stopping_{false};
  UsbThread thread_;
};

}  // namespace tact::hal::falcon_usb
