// SPDX-License-Identifier: Apache-2.0
#include "tests/hal/falcon_usb/fake_libusb.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hal/device_lock.h"

tact::tests::FakeUsb* tact::tests::fake_usb = nullptr;

struct libusb_device {
  std::size_t index;
};

using tact::tests::fake_usb;

// Tests that run beside each other do not meet on one Falcon.
std::optional<tact::model::Error> tact::hal::lock_device(const std::string& name) {
  if (!fake_usb->another_has_it) return std::nullopt;
  return tact::model::Error{name + " is driven by process 7"};
}

extern "C" {
int LIBUSB_CALL libusb_init(libusb_context** context) {
  ++fake_usb->contexts;
  *context = reinterpret_cast<libusb_context*>(fake_usb);
  return 0;
}
void LIBUSB_CALL libusb_exit(libusb_context*) { --fake_usb->contexts; }
const char* LIBUSB_CALL libusb_strerror(int) { return "so says the fake"; }
ssize_t LIBUSB_CALL libusb_get_device_list(libusb_context*, libusb_device*** list) {
  ++fake_usb->lists;
  const std::size_t count = fake_usb->plugs.size();
  *list = new libusb_device*[count + 1];
  for (std::size_t i = 0; i < count; ++i) (*list)[i] = new libusb_device{i};
  (*list)[count] = nullptr;
  return static_cast<ssize_t>(count);
}
void LIBUSB_CALL libusb_free_device_list(libusb_device** list, int) {
  --fake_usb->lists;
  for (libusb_device** d = list; *d != nullptr; ++d) delete *d;
  delete[] list;
}
int LIBUSB_CALL libusb_get_device_descriptor(libusb_device* d, libusb_device_descriptor* out) {
  out->idVendor = fake_usb->plugs[d->index].vendor;
  out->idProduct = fake_usb->plugs[d->index].product;
  return 0;
}
std::uint8_t LIBUSB_CALL libusb_get_bus_number(libusb_device* d) {
  return fake_usb->plugs[d->index].bus;
}
std::uint8_t LIBUSB_CALL libusb_get_device_address(libusb_device* d) {
  return fake_usb->plugs[d->index].address;
}
int LIBUSB_CALL libusb_get_port_numbers(libusb_device* d, std::uint8_t* ports, int) {
  const auto& from = fake_usb->plugs[d->index].ports;
  std::ranges::copy(from, ports);
  return static_cast<int>(from.size());
}
int LIBUSB_CALL libusb_open(libusb_device*, libusb_device_handle** handle) {
  ++fake_usb->opens;
  const bool refuses = fake_usb->refused_opens == 0 || fake_usb->opens <= fake_usb->refused_opens;
  if (fake_usb->open_error != 0 && refuses) return fake_usb->open_error;
  ++fake_usb->handles;
  *handle = reinterpret_cast<libusb_device_handle*>(fake_usb);
  return 0;
}
void LIBUSB_CALL libusb_close(libusb_device_handle*) { --fake_usb->handles; }
int LIBUSB_CALL libusb_set_auto_detach_kernel_driver(libusb_device_handle*, int on) {
  fake_usb->detach = on;
  return 0;
}
int LIBUSB_CALL libusb_kernel_driver_active(libusb_device_handle*, int) {
  return fake_usb->driver_active;
}
int LIBUSB_CALL libusb_claim_interface(libusb_device_handle*, int) {
  if (fake_usb->claim_error != 0) return fake_usb->claim_error;
  EXPECT_EQ(fake_usb->detach, 1);
  ++fake_usb->claims;
  return 0;
}
int LIBUSB_CALL libusb_release_interface(libusb_device_handle*, int) {
  --fake_usb->claims;
  return 0;
}
int LIBUSB_CALL libusb_control_transfer(libusb_device_handle*, std::uint8_t type,
                                        std::uint8_t request, std::uint16_t value,
                                        std::uint16_t index, unsigned char*, std::uint16_t length,
                                        unsigned) {
  if (fake_usb->control_error != 0) return fake_usb->control_error;
  fake_usb->controls.push_back({type, request, value, index, length});
  fake_usb->falcon.control(fake_usb->controls.back());
  return 0;
}
int LIBUSB_CALL libusb_bulk_transfer(libusb_device_handle*, unsigned char endpoint,
                                     unsigned char* data, int length, int* moved,
                                     unsigned wait_ms) {
  *moved = 0;
  if (fake_usb->bulk_error != 0) return fake_usb->bulk_error;
  auto& falcon = fake_usb->falcon;
  if (endpoint == tact::hal::falcon::kFalconEndpointOut) {
    *moved = std::min(length, 60);  // partial writes are written on
    falcon.write({data, static_cast<std::size_t>(*moved)});
    return 0;
  }
  EXPECT_EQ(endpoint, tact::hal::falcon::kFalconEndpointIn);
  EXPECT_GT(wait_ms, 0u);
  const std::size_t size = std::min<std::size_t>(falcon.pending.size(), 62);
  data[0] = falcon.clear_to_send ? 0x11 : 0x01;
  data[1] = 0x60;
  std::copy_n(falcon.pending.begin(), size, data + 2);
  falcon.pending.erase(falcon.pending.begin(),
                       falcon.pending.begin() + static_cast<std::ptrdiff_t>(size));
  *moved = static_cast<int>(size) + 2;
  return 0;
}
}  // extern "C"
