// SPDX-License-Identifier: Apache-2.0
// service_manager.h - what systemd is told of a tactd that it has started, by sd_notify(3): text to
// the socket that NOTIFY_SOCKET names. Where nobody listens nothing happens.
//
// A service never arms. Nobody holds the tool when a machine boots, or when a crash is remedied by
// a restart: also the simulated device waits for a person then.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstdint>
#include <string>

namespace tact::firmware::console {

/// Has a service manager started this process, and waits for its words?
bool is_service();

/// How the run is just now.
struct ServiceNews {
  std::int64_t now_ns = 0;
  bool may_be_armed = false;  // "ready, force is off" has been told
  std::uint64_t ticks = 0;    // of the loop, by its progress
  std::string status = {};    // for systemctl status
};

/// Lives as long as the loop. Of the main thread.
class ServiceManager {
 public:
  ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  /// STOPPING=1
  ~ServiceManager();

  /// READY=1 once it may be armed. Each second WATCHDOG=1, if the loop has ticked since the last
  /// one, and STATUS: a loop that stands still is ended by the manager.
  void report(const ServiceNews& news);

 private:
  void send(const std::string& words) const;

  int socket_ = -1;
  sockaddr_un address_{};
  socklen_t address_bytes_ = 0;
  bool reported_ready_ = false;
  std::int64_t next_ns_ = 0;
  std::uint64_t ticks_ = 0;
};

}  // namespace tact::firmware::console
