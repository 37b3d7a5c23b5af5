// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_open.h"

#include <fmt/core.h>

#include <cstring>

#include "hal/falcon_usb/falcon_wake.h"
#include "hal/falcon_usb/libusb_pipe.h"
#include "hal/falcon_usb/usbfs_pipe.h"
#include "hal/mounting.h"

namespace tact::hal::falcon_usb {
namespace {

using model::Error;
using model::Result;

/// libusb lets go first: transfers and claims belong to the open file. The chip is set up once
/// more, should anything have touched it in between.
Result<std::unique_ptr<falcon::FalconPipe>> open_usbfs_pipe(std::unique_ptr<FalconUsb> usb,
                                                            bool event_character) {
  // Asked before libusb closes: afterwards nobody tells it.
  const std::string path = usb->node();
  usb.reset();
  auto node = UsbfsNode::open(path, falcon::kFalconUsbInterface);
  if (!node) return node.error();
  int error = 0;
  for (const falcon::FtdiRequest& request : falcon::kFalconRunRequests)
    if (error == 0) error = (*node)->control(request);
  if (error == 0)
    // Off is sent, too: the chip may still have it from a run before.
    error = (*node)->control(event_character ? falcon::ftdi_event_character(falcon::kFalconEnd)
                                             : falcon::ftdi_request(6, 0));
  if (error != 0)
    return Error{
        fmt::format("the Falcon's USB chip cannot be set up ({}): unplug it and plug it in again",
                    std::strerror(error))};
  return UsbfsPipe::start(std::move(*node));
}

}  // namespace

Result<std::unique_ptr<falcon::FalconDevice>> open_falcon_device(
    const model::FalconSettings& settings) {
  // First: a wrong file is told before the device is touched.
  const auto image = load_falcon_image(settings.firmware_path, settings.firmware_sha256);
  if (!image) return image.error();
  auto usb = FalconUsb::open(settings.bus_path);
  if (!usb) return usb.error();
  const auto boot = boot_falcon(*usb, *image, settings.event_character);
  if (!boot) return boot.error();
  auto pipe = settings.transport == model::UsbTransport::kLibusb
                  ? LibusbPipe::start(std::move(*usb))
                  : open_usbfs_pipe(std::move(*usb), settings.event_character);
  if (!pipe) return pipe.error();
  return std::make_unique<falcon::FalconDevice>(settings, std::move(*pipe));
}

Result<std::unique_ptr<Device>> open_falcon(const model::DeviceSettings& settings,
                                            double /*rate_Hz*/) {
  auto device = open_falcon_device(settings.falcon);
  if (!device) return device.error();
  (*device)->set_gravity(mounting_of(settings).gravity_in_base_mps2());
  return std::unique_ptr<Device>(std::move(*device));
}

}  // namespace tact::hal::falcon_usb
