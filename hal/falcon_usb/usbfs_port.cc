// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/usbfs_port.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tact::hal::falcon_usb {
namespace {

/// Takes the interface from a kernel driver, but from no other program.
int claim(int fd, int interface) {
  usbdevfs_disconnect_claim wanted{};
  wanted.interface = static_cast<unsigned>(interface);
  wanted.flags = USBDEVFS_DISCONNECT_CLAIM_EXCEPT_DRIVER;
  std::memcpy(wanted.driver, "usbfs", sizeof "usbfs");
  return ioctl(fd, USBDEVFS_DISCONNECT_CLAIM, &wanted) == 0 ? 0 : errno;
}

}  // namespace

model::Result<std::unique_ptr<UsbfsNode>> UsbfsNode::open(const std::string& path, int interface) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0)
    return model::Error{fmt::format(
        "{}: cannot be opened ({}): is the device still plugged in, and may this user write there?",
        path, std::strerror(errno))};
  if (const int error = claim(fd, interface); error != 0) {
    close(fd);
    return model::Error{
        fmt::format("{}: its interface cannot be claimed ({}): end the program that uses it, "
                    "fuser {} names it",
                    path, std::strerror(error), path)};
  }
  return std::make_unique<UsbfsNode>(fd, interface, true);
}

UsbfsNode::UsbfsNode(int fd, int interface, bool mapped) : fd_(fd), interface_(interface) {
  void* memory = mapped
                     ? mmap(nullptr, kUsbfsBuffer_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, 0)
                     : MAP_FAILED;
  mapped_ = memory != MAP_FAILED;
  if (!mapped_) own_ = std::make_unique<std::uint8_t[]>(kUsbfsBuffer_bytes);
  buffer_ = mapped_ ? static_cast<std::uint8_t*>(memory) : own_.get();
  // Writes to the page, so that the loop does not fault on it.
  std::memset(buffer_, 0, kUsbfsBuffer_bytes);
}

UsbfsNode::~UsbfsNode() {
  ioctl(fd_, USBDEVFS_RELEASEINTERFACE, &interface_);
  if (mapped_) munmap(buffer_, kUsbfsBuffer_bytes);
  close(fd_);  // ends every transfer that is still under way
}

// The calls the kernel must answer: the compiler cannot see that they are bounded.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
int UsbfsNode::submit(usbdevfs_urb& urb) RT_SAFE {
  return ioctl(fd_, USBDEVFS_SUBMITURB, &urb) == 0 ? 0 : errno;
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

int UsbfsNode::reap(usbdevfs_urb*& urb) {
  void* done = nullptr;
  // The waiting one, not REAPURBNDELAY: this is the thread that has nothing else to do.
  if (ioctl(fd_, USBDEVFS_REAPURB, &done) != 0) return errno;
  urb = static_cast<usbdevfs_urb*>(done);
  return 0;
}

void UsbfsNode::discard(usbdevfs_urb& urb) { ioctl(fd_, USBDEVFS_DISCARDURB, &urb); }

int UsbfsNode::clear_halt(unsigned endpoint) {
  return ioctl(fd_, USBDEVFS_CLEAR_HALT, &endpoint) == 0 ? 0 : errno;
}

}  // namespace tact::hal::falcon_usb
