// SPDX-License-Identifier: Apache-2.0
// socket_file.h - a local socket: its folder and address, who may put one there, who may be at its
// other end, and whose file it is when it is time to remove it.
#pragma once

#include <sys/socket.h>
#include <sys/types.h>
#include <sys/un.h>

#include <optional>
#include <string>

#include "model/result.h"

namespace tact::model::io {

/// Who is trusted besides the user of this process and root; none unless named.
struct Trust {
  std::optional<uid_t> user;
  std::optional<gid_t> group;  // whose members may be at the other end; no folder is theirs
};

/// $XDG_RUNTIME_DIR/tact, or /tmp/tact-<uid>: made with permissions 0700. Refused if it is not
/// ours, or open to more than the looks of a group, as the service has it (0750).
Result<std::string> runtime_directory();

/// Error: the path is empty, or too long for a socket.
Result<sockaddr_un> socket_address(const std::string& path);

/// As bind and connect take it.
inline const sockaddr* plain(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

/// Error: in the folder of `path` another user than this one, root and the trusted one could put a
/// socket of that name. No error where there is no such folder: bind() or connect() reports that
/// that.
std::optional<Error> check_socket_folder(const std::string& path, const Trust& trust = {});

/// True for the user of this process, for root and for the trusted one.
bool is_trusted(uid_t user, const Trust& trust = {});

/// Whether a trusted user, or a member of the trusted group, is at the other end of a connected
/// local socket (SO_PEERCRED, SO_PEERGROUPS: who he was when he connected).
bool has_trusted_peer(int socket, const Trust& trust = {});

/// A new local socket of this type (as SOCK_SEQPACKET | SOCK_CLOEXEC), bound to `path`: its
/// descriptor. From the first moment only its user may connect (0600). The socket that an
/// ended process left there is replaced. Error: a process listens there, another user could put one
/// there, or none can be made.
Result<int> bind_socket(const std::string& path, int type);

/// Lets a group connect to the socket at `path`, which this process has bound: its group, 0660.
std::optional<Error> share_socket(const std::string& path, gid_t group);

/// A user or group of this computer by its name.
Result<uid_t> find_user(const std::string& name);
Result<gid_t> find_group(const std::string& name);

/// The file that a socket has just made by binding.
class SocketFile {
 public:
  SocketFile() = default;
  explicit SocketFile(std::string path);

  /// Removes that file, and not one that has come to stand there meanwhile.
  void remove() const;

 private:
  std::string path_;
  dev_t device_ = 0;
  ino_t inode_ = 0;  // 0: there was none
};

}  // namespace tact::model::io
