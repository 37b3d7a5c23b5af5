// SPDX-License-Identifier: Apache-2.0
// usbfs_port.h - one USB interface through the kernel's usbfs: transfers without a library.
//
// The node is opened again, by a descriptor of its own: transfers and claims belong to the open
// file. Buffers are mapped from the kernel when it allows that, so it copies nothing. Source:
// UB-2, linux/usbdevice_fs.h and the kernel's Documentation/driver-api/usb/usb.rst.
#pragma once

#include <linux/usbdevice_fs.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "model/result.h"
#include "model/rt.h"

namespace tact::hal::falcon_usb {

class UsbfsPort {
 public:
  UsbfsPort() = default;
  UsbfsPort(const UsbfsPort&) = delete;
  UsbfsPort& operator=(const UsbfsPort&) = delete;
  virtual ~UsbfsPort() = default;

  /// 0, or the errno of the kernel. Any thread; one system call.
  virtual int submit(usbdevfs_urb& urb) RT_SAFE = 0;
  /// Waits for the next completed transfer; 0, or the errno of the kernel.
  virtual int reap(usbdevfs_urb*& urb) = 0;
  /// Ends a transfer, which is then reaped; one that is not under way is left alone.
  virtual void discard(usbdevfs_urb& urb) = 0;
  /// Makes a stalled endpoint carry again; waits for the device. 0, or the errno of the kernel.
  virtual int clear_halt(unsigned endpoint) = 0;
  /// The open node; -1: there is none.
  virtual int descriptor() const { return -1; }
  /// What transfers may use, kUsbfsBuffer_bytes of it.
  virtual std::span<std::uint8_t> buffer() RT_SAFE = 0;
};

inline constexpr std::size_t kUsbfsBuffer_bytes = 4096;

class UsbfsNode final : public UsbfsPort {
 public:
  /// Opens the node, as /dev/bus/usb/001/004, and claims the interface; an error says what to do.
  static model::Result<std::unique_ptr<UsbfsNode>> open(const std::string& path, int interface);
  /// Takes an open descriptor, which it closes at the end. `mapped`: try to map the buffer.
  UsbfsNode(int fd, int interface, bool mapped);
  ~UsbfsNode() override;

  int submit(usbdevfs_urb& urb) RT_SAFE override;
  int reap(usbdevfs_urb*& urb) override;
  void discard(usbdevfs_urb& urb) override;
  int clear_halt(unsigned endpoint) override;
  int descriptor() const override { return fd_; }
  std::span<std::uint8_t> buffer() RT_SAFE override { return {buffer_, kUsbfsBuffer_bytes}; }

 private:
  int fd_, interface_;
  bool mapped_ = false;
  std::unique_ptr<std::uint8_t[]> own_;
  std::uint8_t* buffer_ = nullptr;
};

}  // namespace tact::hal::falcon_usb
