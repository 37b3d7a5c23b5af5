// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_open.h"

#include <fmt/core.h>

#include <array>
#include <utility>

#include "hal/falcon_usb/falcon_image.h"
#include "hal/falcon_usb/usbfs_pipe.h"
#include "hal/monotonic.h"
#include "hal/mounting.h"
#include "model/io/input_file.h"
#include "model/time_ns.h"

namespace tact::hal::falcon_usb {
namespace {

using model::Error;
using model::Result;
using What = falcon::FalconBootAction::What;

constexpr std::int64_t kLongest_ms = 20'000;
constexpr falcon::FalconBootSettings kBoot{.greeting_tries = 20};  // 1 s a time, 10 attempts

std::int64_t now_ms() { return monotonic_ns() / model::kMillisecond_ns; }

/// Does what the machine says; `data` keeps what was read until the next call.
falcon::FalconBootInput carry_out(const falcon::FalconBootAction& action,
                                  std::unique_ptr<FalconUsb>& usb, std::span<std::uint8_t> data) {
  falcon::FalconBootInput input;
  switch (action.what) {
    case What::kControl:
      input.failed = !usb->control(action.request);
      break;
    case What::kWrite:
      input.failed = !usb->write(action.bytes);
      break;
    case What::kRead: {
      const auto transfer = usb->read(action.wait_ms);
      input.failed = !transfer;
      if (!transfer || transfer->empty()) break;
      const auto stripped = falcon::ftdi_strip(*transfer, data);
      if (!stripped) break;
      input.bytes = data.first(stripped->size);
      input.clear_to_send = stripped->clear_to_send();
      break;
    }
    default:
      break;
  }
  input.now_ms = now_ms();
  return input;
}

}  // namespace

Result<std::vector<std::uint8_t>> load_falcon_image(const std::string& path,
                                                    std::string_view wanted_sha256) {
  std::vector<std::uint8_t> image;
  if (path.empty()) return image;
  auto file = model::io::InputFile::open(
      path, "device.falcon.firmware names the file of your copy of the Falcon's firmware");
  if (!file) return file.error();
  // One byte more than is allowed: a longer file is seen as too long, without being read.
  image.resize(kFalconImageMax_bytes + 1);
  const auto read = file->read(image.data(), image.size());
  if (!read) return read.error();
  image.resize(*read);
  const FalconImageVerdict verdict = check_falcon_image(image, wanted_sha256);
  if (!may_be_sent(verdict))
    return Error{fmt::format("{}: {}", path, falcon_image_advice(verdict))};
  return image;
}

Result<falcon::FalconBoot> boot_falcon(std::unique_ptr<FalconUsb>& usb,
                                       std::span<const std::uint8_t> image, bool event_character) {
  falcon::FalconBoot boot(image, kBoot);
  const std::string bus_path = usb->bus_path();
  const std::int64_t end_ms = now_ms() + kLongest_ms;
  std::array<std::uint8_t, falcon::kFtdiPacketSize> data{};
  falcon::FalconBootInput input{.now_ms = now_ms()};
  while (true) {
    const falcon::FalconBootAction action = boot.next(input);
    if (action.what == What::kReady) break;
    // Attempts bound the tries, this the time: opening and writing wait on their own.
    if (action.what == What::kGiveUp || input.now_ms > end_ms) {
      const auto fault = boot.fault() == falcon::FalconBootFault::kNone
                             ? falcon::FalconBootFault::kTransport
                             : boot.fault();
      return Error{falcon_boot_advice(fault)};
    }
    if (action.what == What::kReopen) {
      usb.reset();
      auto again = FalconUsb::open(bus_path);
      if (!again) return again.error();
      usb = std::move(*again);
      input = {.now_ms = now_ms()};
    } else {
      input = carry_out(action, usb, data);
    }
  }
  // After the upload: the image's bytes are no packets, and 3E may stand in them.
  const falcon::FtdiRequest at_end = event_character
                                         ? falcon::ftdi_event_character(falcon::kFalconEnd)
                                         : falcon::ftdi_request(6, 0);
  if (!usb->control(at_end))
    return Error{
        "the Falcon's USB chip refuses its event character: set device.falcon.event_character = "
        "false"};
  return boot;
}

Result<std::unique_ptr<falcon::FalconDevice>> open_falcon_device(
    const falcon::FalconSettings& settings) {
  // First: a wrong file is reported before the device gets a byte.
  const auto image = load_falcon_image(settings.firmware_path, settings.firmware_sha256);
  if (!image) return image.error();
  auto usb = FalconUsb::open(settings.bus_path);
  if (!usb) return usb.error();
  const auto boot = boot_falcon(*usb, *image, settings.event_character);
  if (!boot) return boot.error();
  // libusb lets go first: transfers and claims belong to the open file. The chip stays set up.
  const std::string path = (*usb)->node();
  usb->reset();
  auto node = UsbfsNode::open(path, falcon::kFalconUsbInterface);
  if (!node) return node.error();
  auto pipe = UsbfsPipe::start(std::move(*node));
  if (!pipe) return pipe.error();
  return std::make_unique<falcon::FalconDevice>(settings, std::move(*pipe));
}

Result<std::unique_ptr<Device>> open_falcon(const model::DeviceSettings& settings,
                                            double /*rate_Hz*/) {
  auto device = open_falcon_device(settings.of<falcon::FalconSettings>());
  if (!device) return device.error();
  (*device)->set_gravity(mounting_of(settings).gravity_in_base_mps2());
  return std::unique_ptr<Device>(std::move(*device));
}

}  // namespace tact::hal::falcon_usb
