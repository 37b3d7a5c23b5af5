// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/falcon_usb.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>

#include "hal/device_lock.h"
#include "hal/permission.h"

namespace tact::hal::falcon_usb {
namespace {

using model::Error;
using model::Result;

// Chosen: far longer than a transfer of the set-up takes.
constexpr unsigned kTransferWait_ms = 1000;

/// As sysfs names it and device.falcon.bus_path takes it: bus, then port by port.
std::string path_of(libusb_device* device) {
  std::array<std::uint8_t, 7> ports{};  // the deepest tree USB allows
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string path = fmt::format("{}", libusb_get_bus_number(device));
  for (int i = 0; i < depth; ++i)
    path += fmt::format("{}{}", i == 0 ? '-' : '.', ports[static_cast<std::size_t>(i)]);
  return path;
}

std::string node_of(libusb_device* device) {
  return fmt::format("/dev/bus/usb/{:03}/{:03}", libusb_get_bus_number(device),
                     libusb_get_device_address(device));
}

bool is_falcon(libusb_device* device) {
  libusb_device_descriptor descriptor{};
  return libusb_get_device_descriptor(device, &descriptor) == 0 &&
         descriptor.idVendor == falcon::kFalconUsbVendor &&
         descriptor.idProduct == falcon::kFalconUsbProduct;
}

/// The library's list of Falcons, and what holds it.
struct Falcons {
  libusb_device** all = nullptr;
  std::vector<libusb_device*> falcon;

  explicit Falcons(libusb_context* context) {
    const auto count = libusb_get_device_list(context, &all);
    for (std::ptrdiff_t i = 0; i < count; ++i)
      if (is_falcon(all[i])) falcon.push_back(all[i]);
  }
  ~Falcons() {
    if (all != nullptr) libusb_free_device_list(all, 1);
  }
  Falcons(const Falcons&) = delete;
  Falcons& operator=(const Falcons&) = delete;

  std::string paths() const {
    std::string out;
    for (libusb_device* device : falcon)
      out += fmt::format("{}{}", out.empty() ? "" : ", ", path_of(device));
    return out;
  }
};

Result<libusb_device*> choose(const Falcons& falcons, const std::string& bus_path) {
  if (falcons.falcon.empty())
    return Error{
        "no Novint Falcon (USB 0403:cb48) is there: plug in its USB cable; lsusb -d 0403:cb48 must "
        "show it"};
  if (bus_path.empty() && falcons.falcon.size() == 1) return falcons.falcon.front();
  if (bus_path.empty())
    return Error{fmt::format("there are several Falcons, at {}: name one by device.falcon.bus_path",
                             falcons.paths())};
  for (libusb_device* device : falcons.falcon)
    if (path_of(device) == bus_path) return device;
  return Error{fmt::format(
      "no Falcon is at device.falcon.bus_path \"{}\", only at {}: correct it, or plug it in there",
      bus_path, falcons.paths())};
}

Error open_error(int error, const std::string& node) {
  if (error == EACCES) return why_refused(node, falcon::kFalconParts[0].rule).error();
  return Error{fmt::format("the Falcon at {} cannot be opened ({}): unplug it and plug it in again",
                           node, libusb_strerror(static_cast<libusb_error>(error)))};
}

/// 0, EACCES, or an error of libusb.
int try_open(libusb_device* device, libusb_device_handle** handle) {
  const int error = libusb_open(device, handle);
  return error == LIBUSB_ERROR_ACCESS ? EACCES : error;
}

Error claim_error(int error, bool driver_bound, const std::string& node) {
  if (driver_bound)
    return Error{
        fmt::format("a kernel driver holds the Falcon at {} and does not let go ({}): take "
                    "0403 cb48 out of ftdi_sio's new_id, or rmmod ftdi_sio",
                    node, libusb_strerror(static_cast<libusb_error>(error)))};
  if (error == LIBUSB_ERROR_BUSY)
    return Error{fmt::format("another program uses the Falcon at {}: end it, fuser {} names it",
                             node, node)};
  return Error{
      fmt::format("the Falcon at {} cannot be claimed ({}): unplug it and plug it in again", node,
                  libusb_strerror(static_cast<libusb_error>(error)))};
}

Result<libusb_context*> make_context() {
  libusb_context* context = nullptr;
  const int error = libusb_init(&context);
  if (error == 0) return context;
  return Error{fmt::format("USB cannot be used ({}): is /dev/bus/usb there?",
                           libusb_strerror(static_cast<libusb_error>(error)))};
}

}  // namespace

Result<std::unique_ptr<FalconUsb>> FalconUsb::open(const std::string& bus_path) {
  const auto context = make_context();  // a new one looks at the bus again, also without udevd
  if (!context) return context.error();
  std::unique_ptr<FalconUsb> usb(new FalconUsb);
  usb->context_ = *context;
  const Falcons falcons(usb->context_);
  const auto device = choose(falcons, bus_path);
  if (!device) return device.error();
  usb->bus_path_ = path_of(*device);
  usb->node_ = node_of(*device);
  // Before it is opened: nothing of another tactd's device is touched.
  if (auto error = lock_device("the Falcon at USB " + usb->bus_path_)) return *error;
  const int error = open_when_permitted([&] { return try_open(*device, &usb->handle_); });
  if (error != 0) return open_error(error, usb->node_);
  libusb_set_auto_detach_kernel_driver(usb->handle_, 1);
  const bool driver_bound =
      libusb_kernel_driver_active(usb->handle_, falcon::kFalconUsbInterface) == 1;
  if (const int refused = libusb_claim_interface(usb->handle_, falcon::kFalconUsbInterface);
      refused != 0) {
    const bool still_bound =
        driver_bound && libusb_kernel_driver_active(usb->handle_, falcon::kFalconUsbInterface) == 1;
    return claim_error(refused, still_bound, usb->node_);
  }
  usb->claimed_ = true;
  // A driver that came back on release would set the chip up its own way, before usbfs has it.
  libusb_set_auto_detach_kernel_driver(usb->handle_, 0);
  return usb;
}

FalconUsb::~FalconUsb() {
  if (claimed_) libusb_release_interface(handle_, falcon::kFalconUsbInterface);
  if (handle_ != nullptr) libusb_close(handle_);
  if (context_ != nullptr) libusb_exit(context_);
}

bool FalconUsb::control(const falcon::FtdiRequest& request) {
  return libusb_control_transfer(handle_, request.type, request.request, request.value,
                                 request.index, nullptr, 0, kTransferWait_ms) == 0;
}

bool FalconUsb::write(std::span<const std::uint8_t> bytes) {
  // A copy, as libusb's buffer is not const.
  std::array<std::uint8_t, falcon::kFtdiPacketSize> out{};
  while (!bytes.empty()) {
    const std::size_t size = std::min(bytes.size(), out.size());
    std::copy_n(bytes.begin(), size, out.begin());
    int sent = 0;
    const int error = libusb_bulk_transfer(handle_, falcon::kFalconEndpointOut, out.data(),
                                           static_cast<int>(size), &sent, kTransferWait_ms);
    if (error != 0 || sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

std::optional<std::span<const std::uint8_t>> FalconUsb::read(int wait_ms) {
  int size = 0;
  const int error = libusb_bulk_transfer(handle_, falcon::kFalconEndpointIn, buffer_.data(),
                                         static_cast<int>(buffer_.size()), &size,
                                         static_cast<unsigned>(std::max(wait_ms, 1)));
  // A timeout is an answer: nothing has come. The boot sequence decides what that means.
  if (error != 0 && error != LIBUSB_ERROR_TIMEOUT) return std::nullopt;
  return std::span<const std::uint8_t>(buffer_.data(), static_cast<std::size_t>(size));
}

}  // namespace tact::hal::falcon_usb
