// SPDX-License-Identifier: Apache-2.0
// falcon_usb.h - finding and claiming a Falcon through libusb. Set-up code only.
//
// Every failure is one message with the remedy. Source: libusb 1.0 API reference,
// libusb.sourceforge.io/api-1.0.
#pragma once

#include <libusb-1.0/libusb.h>

#include <memory>
#include <span>
#include <string>

#include "hal/falcon/falcon_boot.h"
#include "hal/falcon/falcon_device.h"
#include "model/result.h"

namespace tact::hal::falcon_usb {

/// An open Falcon with its interface claimed; gives both back at the end.
class FalconUsb {
 public:
  /// `bus_path`: "1-2.3", bus, then port by port; empty: the only one.
  static model::Result<std::unique_ptr<FalconUsb>> open(const std::string& bus_path);
  ~FalconUsb();
  FalconUsb(const FalconUsb&) = delete;
  FalconUsb& operator=(const FalconUsb&) = delete;

  const std::string& bus_path() const { return bus_path_; }  // "1-2.3", also of the only one
  const std::string& node() const { return node_; }          // "/dev/bus/usb/001/004"

  /// One request without data; false: it failed.
  bool control(const falcon::FtdiRequest& request);
  /// All of it, within a second.
  bool write(std::span<const std::uint8_t> bytes);
  /// One transfer of at most 64 bytes with its status bytes; nothing: it failed. No bytes: time is
  /// up.
  std::optional<std::span<const std::uint8_t>> read(int wait_ms);

 private:
  FalconUsb() = default;

  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  bool claimed_ = false;
  std::string bus_path_, node_;
  std::array<std::uint8_t, falcon::kFtdiPacketSize> buffer_{};
};

}  // namespace tact::hal::falcon_usb
