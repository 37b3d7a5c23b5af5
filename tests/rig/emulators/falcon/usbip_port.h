// SPDX-License-Identifier: Apache-2.0
// usbip_port.h - an emulated USB device on a port of vhci_hcd: URBs in, completions out.
//
// The kernel's virtual host controller speaks USB/IP (Documentation/usb/usbip_protocol.rst):
// headers of 48 bytes, big endian, over a stream socket. One end of a socket pair goes to the
// driver, so there is no network. Closing our end is a pulled cable.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tact::rig {

struct Urb {
  std::uint32_t number = 0;
  std::uint32_t endpoint = 0;  // without the direction
  bool is_in = false;
  std::uint32_t length = 0;        // of IN: what the host has room for
  std::vector<std::uint8_t> data;  // of OUT
  std::uint8_t setup[8]{};         // of endpoint 0
  std::int64_t submitted_ns = 0;
};
struct UsbipRequest {
  bool is_unlink = false;
  std::uint32_t number = 0, victim = 0;  // of an unlink
  Urb urb{};
};

class UsbipPort {
 public:
  UsbipPort() = default;
  UsbipPort(const UsbipPort&) = delete;
  UsbipPort& operator=(const UsbipPort&) = delete;
  ~UsbipPort() { detach(); }

  /// A full-speed device. False: the message with the remedy.
  bool attach(int port, std::string& error);
  void detach();
  bool is_attached() const { return fd_ >= 0; }
  int descriptor() const { return fd_; }

  /// The next request, if one is there. A broken stream detaches.
  std::optional<UsbipRequest> receive(std::int64_t now_ns);
  /// `status`: 0 or a negative errno. Of an OUT all is taken.
  void complete(const Urb& urb, int status, std::span<const std::uint8_t> data);
  void answer_unlink(std::uint32_t number, bool was_waiting);

 private:
  bool read_all(void* to, std::size_t size);
  void write_all(std::span<const std::uint8_t> bytes);

  int fd_ = -1;
};

}  // namespace tact::rig
