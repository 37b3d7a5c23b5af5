// SPDX-License-Identifier: Apache-2.0
// tact-rig-viewer: connects to the telemetry socket as a viewer does, takes the greeting and a
// frame, says so, and never reads again.
//
//   tact-rig-viewer SOCKET
#include <fmt/core.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  const std::string path = argc == 2 ? argv[1] : "";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (fd < 0 || connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    fmt::print(stderr,
               "tact-rig-viewer: {}: no process listens here; usage: tact-rig-viewer SOCKET\n",
               path);
    return 2;
  }
  std::array<char, 65536> message;
  for (int taken = 0; taken < 2; ++taken)
    if (recv(fd, message.data(), message.size(), 0) <= 0) return 1;
  fmt::print("had a frame\n");
  std::fflush(stdout);
  pause();
}
