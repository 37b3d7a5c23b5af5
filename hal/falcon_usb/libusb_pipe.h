// SPDX-License-Identifier: Apache-2.0
// libusb_pipe.h - a Falcon's packets through libusb's asynchronous transfers.
//
// The library allocates and locks whenever it submits (UB-1), so all of it stays in the I/O thread:
// the loop leaves its command in a slot and wakes the thread by one eventfd write. Two commands at
// most are under way; a newer one replaces one that waits. When the loop has gone silent the thread
// sends zeros (loop_silence.h). After an end by an error the thread stays for the commands.
#pragma once

#include <poll.h>
#include <sys/syscall.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <memory>
#include <vector>

#include "hal/falcon_usb/falcon_receiver.h"
#include "hal/falcon_usb/falcon_usb.h"
#include "hal/falcon_usb/loop_silence.h"
#include "hal/falcon_usb/usb_thread.h"

namespace tact::hal::falcon_usb {

class LibusbPipe final : public falcon::FalconPipe {
 public:
  static constexpr std::size_t kIn = 4, kOut = 2;

  /// Takes a Falcon that runs; an error says what to do.
  static model::Result<std::unique_ptr<falcon::FalconPipe>> start(std::unique_ptr<FalconUsb> usb);
  ~LibusbPipe() override;

  bool submit(const falcon::FalconPacket& command) RT_SAFE override;
  std::span<const int> loop_calls() const override {
    static constexpr std::array kCalls{SYS_write};
    return kCalls;
  }
  bool newest(falcon::FalconReply& reply) RT_SAFE override { return receiver_.newest(reply); }
  falcon::FalconPipeHealth health() const RT_SAFE override { return receiver_.health(); }
  int descriptor() const override { return usb_ ? usb_->descriptor() : -1; }
  void stop(const falcon::FalconPacket& last) override;
  const UsbThread& thread() const { return thread_; }

 private:
  struct Transfer {
    LibusbPipe* pipe = nullptr;
    libusb_transfer* transfer = nullptr;
    std::array<std::uint8_t, kFalconTransfer> buffer{};
    bool is_in = false, busy = false;
    std::uint64_t number = 0;  // of the command it carries
  };
  struct Command {
    falcon::FalconPacket packet{};
    std::uint64_t number = 0;  // 1 is the first
  };

  explicit LibusbPipe(std::unique_ptr<FalconUsb> usb) : usb_(std::move(usb)) {}
  std::optional<model::Error> prepare();
  static void LIBUSB_CALL on_completed(libusb_transfer* transfer);
  void completed(Transfer& transfer);
  void submit_transfer(Transfer& transfer);
  void submit_command();
  void stand_in_for_loop(std::int64_t now_ns);
  void clear_command_halt();
  bool send_last(const falcon::FalconPacket& last);
  void finish(int error) RT_SAFE;
  void run();
  void turn();
  bool any_busy() const;
  /// Gives the library time to hand every transfer back; false: it keeps some.
  bool drain();
  void release();

  std::unique_ptr<FalconUsb> usb_;
  FalconReceiver receiver_;
  std::array<std::unique_ptr<Transfer>, kIn + kOut>
      transfers_{};  // IN first; thread's, once it runs
  LatestSlot<Command> commands_;
  Command waiting_;          // the newest; thread only
  LoopSilence silence_;      // thread only
  std::uint64_t heard_ = 0;  // number of the newest command of the loop; thread only
  std::vector<pollfd> fds_;  // the eventfd, then the library's
  int wake_fd_ = -1;
  int results_ = 0;  // of this turn
  int last_error_ = EIO;
  bool out_halted_ = false;             // a command met a stall; thread only
  std::uint64_t submitted_ = 0;         // loop only
  std::atomic<std::uint64_t> sent_{0};  // number of the newest command that the device has
  std::atomic<std::uint64_t> over_{0};  // ... that came back, with or without it
  std::atomic<bool> stopping_{false};
  UsbThread thread_;
};

}  // namespace tact::hal::falcon_usb
