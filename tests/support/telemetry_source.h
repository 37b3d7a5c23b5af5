// SPDX-License-Identifier: Apache-2.0
// telemetry_source.h - speaks tactd's side of the telemetry socket with made-up numbers, so that
// the viewer can be tested without the controller. Linux only; any failed call shows as ok() ==
// false.
#pragma once

#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "firmware/protocol/run_file.h"

namespace tact::test {

using firmware::protocol::Frame;
using firmware::protocol::RunHeader;

/// A scene around any meshes: two probe spheres, eleven rings 4 mm apart.
inline RunHeader make_header(std::uint32_t organ_vertices, std::uint32_t organ_triangles,
                             std::uint32_t tool_vertices, std::uint32_t tool_triangles) {
  RunHeader header;
  header.organ_vertices = organ_vertices;
  header.organ_triangles = organ_triangles;
  header.tool_vertices = tool_vertices;
  header.tool_triangles = tool_triangles;
  header.profile_points = 11;
  header.profile_pitch_m = 0.004;
  header.rate_Hz = 4000.0;
  header.frame_rate_Hz = 60.0;
  header.force_limit_N = 5.0;
  header.spheres = {{0.003, {-0.071, 0.010, 0.0}}, {0.003, {-0.071, -0.010, 0.0}}};
  header.simulated = true;
  header.scene_name = "liver (synthetic)";
  header.device_name = "simulated delta";
  header.law_name = "rhombus chain, N = 10";
  return header;
}

/// One triangle each, for tests that only count bytes.
struct TinyMeshes {
  float organ_m[3][3] = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}};
  std::uint32_t organ_triangle[3] = {0, 1, 2};
  float tool_m[3][3] = {{0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0}};
  std::uint32_t tool_triangle[3] = {0, 1, 2};

  std::vector<std::byte> bytes() const {
    std::vector<std::byte> out(sizeof *this);
    std::memcpy(out.data(), this, sizeof *this);
    return out;
  }
};

/// Every number of a frame that has one, the same everywhere.
inline Frame make_frame(float value, model::ContactState state) {
  Frame frame;
  for (float* array : {frame.tool_position_m, frame.tool_velocity_mps, frame.force_N,
                       frame.torque_Nm, frame.wanted_force_N}) {
    for (int i = 0; i < 3; ++i) array[i] = value;
  }
  for (float& part : frame.tool_orientation) part = value;
  frame.grip_ratio = frame.worst_margin_us = frame.median_tick_us = frame.peak_force_N = value;
  frame.temperature_C = value;
  for (firmware::protocol::FrameContact& contact : frame.contact) {
    for (float* array : {contact.surface_point_m, contact.normal, contact.shift_m, contact.tilt})
      for (int i = 0; i < 3; ++i) array[i] = value;
    for (float& ring_m : contact.profile_m) ring_m = value;
    contact.depth_m = value;
    contact.state = state;
  }
  return frame;
}

/// Listens on a socket path; accepts one viewer at a time.
class TelemetrySource {
 public:
  explicit TelemetrySource(const std::string& path) : path_(path) {
    listener_ = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    ::unlink(path.c_str());
    ok_ = ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
          ::listen(listener_, 4) == 0;
  }
  ~TelemetrySource() {
    hang_up();
    ::close(listener_);
    ::unlink(path_.c_str());
  }
  TelemetrySource(const TelemetrySource&) = delete;
  TelemetrySource& operator=(const TelemetrySource&) = delete;

  bool ok() const { return ok_; }
  std::string first_message{firmware::protocol::kMagic};  // another one is of another program

  /// True when a viewer is connected now; a new one gets head and meshes.
  bool accept(const RunHeader& header, const std::vector<std::byte>& meshes) {
    if (viewer_ >= 0) return true;
    viewer_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (viewer_ >= 0) ok_ = ok_ && send_start(header, meshes);
    return viewer_ >= 0;
  }

  /// Any message; a viewer that does not read loses it, one that left is forgotten.
  void send(const void* bytes, std::size_t size) {
    if (viewer_ < 0) return;
    const ssize_t sent = ::send(viewer_, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0 && errno == EPIPE) hang_up();
  }
  void send(const Frame& frame) {
    const std::string message = chunk_of(frame);
    send(message.data(), message.size());
  }

  void hang_up() {
    if (viewer_ >= 0) ::close(viewer_);
    viewer_ = -1;
  }

 private:
  bool send_start(const RunHeader& header, const std::vector<std::byte>& meshes) {
    const std::string start =
        start_of_run(header, meshes, {firmware::protocol::schema_of<Frame>()});
    const int memory = memfd_create("tact-run", MFD_CLOEXEC);
    const bool stored =
        ::write(memory, start.data(), start.size()) == static_cast<ssize_t>(start.size());
    std::string magic = first_message;
    iovec part{.iov_base = magic.data(), .iov_len = magic.size()};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* c = CMSG_FIRSTHDR(&message);
    c->cmsg_level = SOL_SOCKET;
    c->cmsg_type = SCM_RIGHTS;
    c->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(c), &memory, sizeof memory);
    const bool sent =
        ::sendmsg(viewer_, &message, MSG_NOSIGNAL) == static_cast<ssize_t>(magic.size());
    ::close(memory);
    return stored && sent;
  }

  std::string path_;
  int listener_ = -1;
  int viewer_ = -1;
  bool ok_ = false;
};

}  // namespace tact::test
