// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/falcon/usbip_port.h"

#include <endian.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace tact::rig {
namespace {

constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kReturnSubmit = 3, kReturnUnlink = 4;
constexpr std::uint32_t kDeviceId = 1u << 16u | 2u;  // bus 1, device 2
constexpr int kFullSpeed = 2;
constexpr std::uint32_t kMaxTransfer = 65'536;
constexpr std::size_t kHeader = 48;

using Header = std::array<std::uint32_t, kHeader / 4>;  // as words, big endian on the wire
enum Word : std::size_t {                               // of the header
  kCommand,
  kSequence,
  kDevice,
  kDirection,
  kEndpoint,
  kFlagsOrStatus,  // submit: flags; answers: status; unlink: the victim
  kLength,
  kStartFrame,
  kPackets,
  kErrors,
  kSetup,  // eight bytes
};

std::array<std::uint8_t, kHeader> to_wire(const Header& header) {
  std::array<std::uint8_t, kHeader> bytes{};
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::uint32_t word = htobe32(header[i]);
    std::memcpy(&bytes[4 * i], &word, 4);
  }
  return bytes;
}

}  // namespace

bool UsbipPort::attach(int port, std::string& error) {
  constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    error = std::string("no socket pair: ") + std::strerror(errno);
    return false;
  }
  const int file = open(kAttach, O_WRONLY | O_CLOEXEC);
  const std::string order = std::to_string(port) + " " + std::to_string(ends[1]) + " " +
                            std::to_string(kDeviceId) + " " + std::to_string(kFullSpeed);
  const bool good =
      file >= 0 && write(file, order.data(), order.size()) == static_cast<ssize_t>(order.size());
  if (!good)
    error = std::string(kAttach) + ": " + std::strerror(errno) +
            ": modprobe vhci_hcd, be root, and take another --port if this one is in use";
  if (file >= 0) close(file);
  close(ends[1]);
  if (good)
    fd_ = ends[0];
  else
    close(ends[0]);
  return good;
}

void UsbipPort::detach() {
  if (fd_ >= 0) close(fd_);
  fd_ = -1;
}

bool UsbipPort::read_all(void* to, std::size_t size) {
  return size == 0 || recv(fd_, to, size, MSG_WAITALL) == static_cast<ssize_t>(size);
}

void UsbipPort::write_all(std::span<const std::uint8_t> bytes) {
  if (fd_ < 0) return;
  if (send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size()))
    detach();
}

std::optional<UsbipRequest> UsbipPort::receive(std::int64_t now_ns) {
  std::uint8_t first = 0;
  if (fd_ < 0) return std::nullopt;
  const ssize_t waiting = recv(fd_, &first, 1, MSG_PEEK | MSG_DONTWAIT);
  if (waiting < 0 && (errno == EAGAIN || errno == EINTR)) return std::nullopt;
  std::array<std::uint8_t, kHeader> bytes{};
  if (waiting <= 0 || !read_all(bytes.data(), bytes.size())) {
    detach();
    return std::nullopt;
  }
  Header header{};
  for (std::size_t i = 0; i < header.size(); ++i) {
    std::uint32_t word = 0;
    std::memcpy(&word, &bytes[4 * i], 4);
    header[i] = be32toh(word);
  }
  UsbipRequest request;
  request.number = header[kSequence];
  if (header[kCommand] == kUnlink) {
    request.is_unlink = true;
    request.victim = header[kFlagsOrStatus];
    return request;
  }
  request.urb = {.number = header[kSequence],
                 .endpoint = header[kEndpoint],
                 .is_in = header[kDirection] == 1,
                 .length = header[kLength],
                 .data = {},
                 .submitted_ns = now_ns};
  std::memcpy(request.urb.setup, &bytes[4 * kSetup], sizeof request.urb.setup);
  if (header[kCommand] != kSubmit || header[kLength] > kMaxTransfer) {
    detach();
    return std::nullopt;
  }
  if (!request.urb.is_in) request.urb.data.resize(header[kLength]);
  if (!read_all(request.urb.data.data(), request.urb.data.size())) {
    detach();
    return std::nullopt;
  }
  return request;
}

void UsbipPort::complete(const Urb& urb, int status, std::span<const std::uint8_t> data) {
  Header header{};
  header[kCommand] = kReturnSubmit;
  header[kSequence] = urb.number;
  header[kFlagsOrStatus] = static_cast<std::uint32_t>(status);
  const std::size_t size = urb.is_in ? data.size() : urb.data.size();
  header[kLength] = status == 0 ? static_cast<std::uint32_t>(size) : 0;
  header[kPackets] = 0xFFFF'FFFF;
  const auto wire = to_wire(header);
  std::vector<std::uint8_t> bytes(wire.begin(), wire.end());
  if (urb.is_in && status == 0) bytes.insert(bytes.end(), data.begin(), data.end());
  write_all(bytes);
}

void UsbipPort::answer_unlink(std::uint32_t number, bool was_waiting) {
  Header header{};
  header[kCommand] = kReturnUnlink;
  header[kSequence] = number;
  header[kFlagsOrStatus] = was_waiting ? static_cast<std::uint32_t>(-ECONNRESET) : 0;
  write_all(to_wire(header));
}

}  // namespace tact::rig
