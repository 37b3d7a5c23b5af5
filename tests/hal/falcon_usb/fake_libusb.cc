// SPDX-License-Identifier: Apache-2.0
#include "tests/hal/falcon_usb/fake_libusb.h"

#include <gtest/gtest.h>

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
libusb_transfer* LIBUSB_CALL libusb_alloc_transfer(int) {
  ++fake_usb->transfers;
  return static_cast<libusb_transfer*>(std::calloc(1, sizeof(libusb_transfer)));
}
void LIBUSB_CALL libusb_free_transfer(libusb_transfer* transfer) {
  if (transfer != nullptr) --fake_usb->transfers;
  std::free(transfer);
}
int LIBUSB_CALL libusb_submit_transfer(libusb_transfer* transfer) {
  const std::lock_guard lock(fake_usb->mutex);
  if (fake_usb->submit_error != 0) return fake_usb->submit_error;
  if (transfer->endpoint == tact::hal::falcon::kFalconEndpointIn) {
    EXPECT_EQ(transfer->length, 64);
    fake_usb->in.push_back(transfer);
    return 0;
  }
  EXPECT_EQ(transfer->length, 16);
  fake_usb->commands.emplace_back(transfer->buffer, transfer->buffer + transfer->length);
  if (!fake_usb->keeps_out && fake_usb->out_stalls == 0)
    fake_usb->taken.push_back(fake_usb->commands.back());
  if (fake_usb->keeps_out)
    fake_usb->out.push_back(transfer);
  else if (fake_usb->out_stalls > 0)
    fake_usb->complete(transfer, LIBUSB_TRANSFER_STALL);
  else
    fake_usb->complete(transfer, LIBUSB_TRANSFER_COMPLETED,
                       tact::tests::Bytes(transfer->buffer, transfer->buffer + transfer->length));
  return 0;
}
int LIBUSB_CALL libusb_clear_halt(libusb_device_handle*, unsigned char endpoint) {
  const std::lock_guard lock(fake_usb->mutex);
  fake_usb->cleared.push_back(endpoint);
  if (endpoint == tact::hal::falcon::kFalconEndpointOut && fake_usb->out_stalls > 0)
    --fake_usb->out_stalls;
  return 0;
}
int LIBUSB_CALL libusb_cancel_transfer(libusb_transfer* transfer) {
  const std::lock_guard lock(fake_usb->mutex);
  for (auto* queue : {&fake_usb->in, &fake_usb->out}) {
    const auto found = std::ranges::find(*queue, transfer);
    if (found == queue->end()) continue;
    queue->erase(found);
    fake_usb->complete(transfer, LIBUSB_TRANSFER_CANCELLED);
  }
  return 0;
}
int LIBUSB_CALL libusb_handle_events_timeout_completed(libusb_context*, timeval*, int*) {
  std::deque<libusb_transfer*> done;
  {
    const std::lock_guard lock(fake_usb->mutex);
    ++fake_usb->event_calls;
    done.swap(fake_usb->done);
    char bytes[64];
    if (!done.empty() && !fake_usb->hang_up)
      static_cast<void>(::read(fake_usb->event_fd, bytes, done.size()));
  }
  for (libusb_transfer* transfer : done) transfer->callback(transfer);
  return 0;
}
const libusb_pollfd** LIBUSB_CALL libusb_get_pollfds(libusb_context*) {
  auto** list = new const libusb_pollfd*[2];
  list[0] = new libusb_pollfd{.fd = fake_usb->event_fd, .events = 1};
  list[1] = nullptr;
  return list;
}
void LIBUSB_CALL libusb_free_pollfds(const libusb_pollfd** list) {
  delete list[0];
  delete[] list;
}
}  // extern "C"
