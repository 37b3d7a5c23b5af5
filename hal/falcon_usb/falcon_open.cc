// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_open.h"

#include "hal/falcon_usb/falcon_wake.h"
#include "hal/falcon_usb/usbfs_pipe.h"
#include "hal/mounting.h"

namespace tact::hal::falcon_usb {

using model::Result;

Result<std::unique_ptr<falcon::FalconDevice>> open_falcon_device(
    const model::FalconSettings& settings) {
  // First: a wrong file is told before the device is touched.
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
  auto device = open_falcon_device(settings.falcon);
  if (!device) return device.error();
  (*device)->set_gravity(mounting_of(settings).gravity_in_base_mps2());
  return std::unique_ptr<Device>(std::move(*device));
}

}  // namespace tact::hal::falcon_usb
