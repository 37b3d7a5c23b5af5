// SPDX-License-Identifier: Apache-2.0
// service_manager.h - reports to the systemd that started tactd, by sd_notify(3): text to the
// socket that NOTIFY_SOCKET names. Without that socket nothing is sent.
//
// A service never arms itself, because at boot or at a restart after a crash no hand holds the
// tool: even the simulated device then waits for an operator.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstdint>
#include <string>

namespace tact::firmware::console {

/// True: a service manager started this process and takes its reports.
bool is_service();

/// The present state of the run.
struct ServiceNews {
  std::int64_t now_ns = 0;
  bool may_be_armed = false;  // "ready, force is off" has been reported
  std::uint64_t ticks = 0;    // of the loop, by its progress
  std::string status = {};    // for systemctl status
};

/// Exists while the loop runs. Main thread only.
class ServiceManager {
 public:
  ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  /// Sends STOPPING=1.
  ~ServiceManager();

  /// Sends READY=1 once it may be armed; each second STATUS, and WATCHDOG=1 if the loop has ticked
  /// since the last one. Without WATCHDOG the manager ends the process.
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
