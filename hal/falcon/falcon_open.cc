// falcon_open.cc - from the scene's settings to a Falcon that runs: find, wake, choose a transport.
#include <fmt/core.h>

#include <cstring>

#include "hal/falcon/falcon_device.h"
#include "hal/falcon/falcon_usb.h"
#include "hal/falcon/libusb_pipe.h"
#include "hal/falcon/usbfs_pipe.h"

namespace tact::hal {
namespace {

using model::Error;
using model::Result;

/// libusb lets go first: transfers and claims belong to the open file. The chip is set up once
/// more, should anything have touched it in between.
Result<std::unique_ptr<FalconPipe>> open_usbfs_pipe(std::unique_ptr<FalconUsb> usb,
                                                    bool event_character) {
  const std::string path = usb->node();
  usb.reset();
  auto node = UsbfsNode::open(path, kFalconUsbInterface);
  if (!node) return node.error();
  int error = 0;
  for (const FtdiRequest& request : kFalconRunRequests)
    if (error == 0) error = (*node)->control(request);
  if (error == 0)
    error =
        (*node)->control(event_character ? ftdi_event_character(kFalconEnd) : ftdi_request(6, 0));
  if (error != 0)
    return Error{
        fmt::format("the Falcon's USB chip cannot be set up ({}): unplug it and plug it in again",
                    std::strerror(error))};
  return UsbfsPipe::start(std::move(*node));
}

}  // namespace

Result<std::unique_ptr<FalconDevice>> open_falcon_device(const model::FalconSettings& settings) {
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
  return std::make_unique<FalconDevice>(settings, std::move(*pipe));
}

Result<std::unique_ptr<Device>> open_falcon(const model::Scene& scene) {
  auto device = open_falcon_device(scene.device.falcon);
  if (!device) return device.error();
  return std::unique_ptr<Device>(std::move(*device));
}

}  // namespace tact::hal
