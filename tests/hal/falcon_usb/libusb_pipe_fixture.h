// SPDX-License-Identifier: Apache-2.0
// libusb_pipe_fixture.h - a LibusbPipe whose USB does what a test says.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <memory>
#include <mutex>
#include <vector>

#include "hal/falcon_usb/libusb_pipe.h"
#include "hal/falcon_usb/loop_silence.h"
#include "tests/hal/falcon_usb/fake_libusb.h"

namespace tact::hal::falcon_usb::libusb_pipe_test {

class LibusbPipeTest : public testing::Test {
 protected:
  LibusbPipeTest() {
    tests::fake_usb = &usb;
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    usb.event_fd = ends[0];
    usb.other_end = ends[1];
    open();
  }
  ~LibusbPipeTest() override {
    pipe.reset();
    EXPECT_EQ(usb.transfers, 0);  // everything was given back
    EXPECT_EQ(usb.claims, 0);
    EXPECT_EQ(usb.handles, 0);
    EXPECT_EQ(usb.contexts, 0);
    close(usb.event_fd);
    if (!usb.hang_up) close(usb.other_end);
    tests::fake_usb = nullptr;
  }
  void open() {
    auto opened = FalconUsb::open("");
    EXPECT_TRUE(opened);
    auto started = LibusbPipe::start(std::move(*opened));
    EXPECT_TRUE(started) << started.error().sentence;
    pipe = std::move(*started);
  }
  template <typename Condition>
  static bool wait_for(Condition condition) {
    for (int i = 0; i < 3000; ++i, usb_pause_ns(1'000'000))
      if (condition()) return true;
    return false;
  }
  template <typename Look>
  auto locked(Look look) {
    const std::lock_guard lock(usb.mutex);
    return look();
  }
  void send(const tests::Bytes& bytes, libusb_transfer_status status = LIBUSB_TRANSFER_COMPLETED) {
    ASSERT_TRUE(wait_for([&] { return locked([&] { return !usb.in.empty(); }); }));
    locked([&] {
      libusb_transfer* transfer = usb.in.front();
      usb.in.pop_front();
      usb.complete(transfer, status, bytes);
    });
  }
  static tests::Bytes transfer_of(const falcon::FalconReport& report) {
    const falcon::FalconPacket packet = encode(report);
    tests::Bytes bytes{0x01, 0x60};
    bytes.insert(bytes.end(), packet.begin(), packet.end());
    return bytes;
  }
  static falcon::FalconPacket numbered(int i) {
    return encode(falcon::FalconCommand{.motor = {i, 0, 0}});
  }
  static tests::Bytes bytes_of(const falcon::FalconPacket& p) { return {p.begin(), p.end()}; }
  /// Without the zeros of a thread that stands in: also a busy PC is a silent loop.
  static std::vector<tests::Bytes> of_loop(std::vector<tests::Bytes> all) {
    std::erase(all, bytes_of(LoopSilence::zero()));
    return all;
  }
  /// An end by an error: the thread stays.
  bool wait_for_fault() {
    return wait_for([&] { return pipe->health().end != falcon::FalconPipeEnd::kOpen; });
  }
  /// The thread has run.
  void warm_up() {
    send(transfer_of({}));
    falcon::FalconReply reply;
    ASSERT_TRUE(wait_for([&] { return pipe->newest(reply); }));
  }
  const UsbThread& thread() const { return dynamic_cast<const LibusbPipe&>(*pipe).thread(); }

  tests::FakeUsb usb;
  std::unique_ptr<falcon::FalconPipe> pipe;
};

}  // namespace tact::hal::falcon_usb::libusb_pipe_test
