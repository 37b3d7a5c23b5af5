// SPDX-License-Identifier: Apache-2.0
#include "model/io/socket_file.h"

#include <grp.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <utility>

namespace tact::model::io {
namespace {

/// NGROUPS_MAX is 65536; who is in more groups than this is asked for the first one alone.
constexpr std::size_t kMaxGroups = 1024;

bool has_peer_in(int socket, gid_t group) {
  std::array<gid_t, kMaxGroups> groups{};
  socklen_t bytes = sizeof groups;
  if (getsockopt(socket, SOL_SOCKET, SO_PEERGROUPS, groups.data(), &bytes) != 0) return false;
  const std::span<const gid_t> is_in(groups.data(), bytes / sizeof(gid_t));
  return std::ranges::find(is_in, group) != is_in.end();
}

/// errno is that of the call just made.
Error system_error(const std::string& path, const char* what) {
  return Error{path + ": " + what + ": " + std::strerror(errno) +
               "; choose a folder that you may write to with --socket"};
}

bool is_in_use(const sockaddr_un& address, int type) {
  // Asked by a connection: a file alone says nothing, as it stays when its process is killed.
  const int probe = socket(AF_UNIX, type | SOCK_NONBLOCK, 0);
  const bool alive = probe >= 0 && (connect(probe, plain(address), sizeof address) == 0 ||
                                    errno == EAGAIN);  // alive, with a full queue
  if (probe >= 0) close(probe);
  return alive;
}

/// The socket of a process that is gone makes way; nothing else does.
std::optional<Error> clear_the_way(const std::string& path, const sockaddr_un& address, int type) {
  struct stat info{};
  if (lstat(path.c_str(), &info) != 0) {
    if (errno == ENOENT) return std::nullopt;
    return system_error(path, "cannot look at it");
  }
  if (!S_ISSOCK(info.st_mode)) return Error{path + ": is no socket; choose another --socket"};
  if (is_in_use(address, type))
    return Error{path + ": another tactd is running there; stop it, or choose another --socket"};
  if (unlink(path.c_str()) != 0) return system_error(path, "cannot replace the old socket");
  return std::nullopt;
}

}  // namespace

Result<std::string> runtime_directory() {
  const char* base = std::getenv("XDG_RUNTIME_DIR");
  const std::string path = base != nullptr && *base != '\0'
                               ? std::string(base) + "/tact"
                               : "/tmp/tact-" + std::to_string(getuid());
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
    return Error{path + ": " + std::strerror(errno) + "; set XDG_RUNTIME_DIR to a folder of yours"};
  struct stat info{};
  // lstat: in /tmp another user may have placed a link of that name.
  // 027: only its owner writes, others do not read.
  if (lstat(path.c_str(), &info) != 0) return system_error(path, "cannot be examined");
  if (info.st_uid != getuid())
    return Error{path + ": was made by user " + std::to_string(info.st_uid) +
                 ", and only root can remove it; set XDG_RUNTIME_DIR to a folder of yours, as a "
                 "login session has it in /run/user/" +
                 std::to_string(getuid())};
  if (!S_ISDIR(info.st_mode) || (info.st_mode & 027) != 0)
    return Error{path +
                 ": is not a folder that only you can write to and no stranger can open; remove it "
                 "and start again, or set XDG_RUNTIME_DIR to a folder of yours"};
  return path;
}

Result<sockaddr_un> socket_address(const std::string& path) {
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  constexpr std::size_t kMax = sizeof address.sun_path - 1;
  if (path.empty() || path.size() > kMax)
    return Error{path + ": a socket's path has 1 to " + std::to_string(kMax) +
                 " characters; give a shorter --socket, or XDG_RUNTIME_DIR"};
  path.copy(address.sun_path, kMax);
  return address;
}

std::optional<Error> check_socket_folder(const std::string& path, const Trust& trust) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  const std::string folder = parent.empty() ? "." : parent;
  struct stat info{};
  // A folder that does not exist cannot be written to.
  if (stat(folder.c_str(), &info) != 0) return std::nullopt;
  // With the sticky bit, as /tmp has it, users cannot replace the files of others.
  const bool others_write = (info.st_mode & 022) != 0 && (info.st_mode & S_ISVTX) == 0;
  if (S_ISDIR(info.st_mode) && is_trusted(info.st_uid, trust) && !others_write) return std::nullopt;
  return Error{folder +
               ": another user may put a socket there; give --socket in a folder that only you "
               "can write to"};
}

bool is_trusted(uid_t user, const Trust& trust) {
  return user == geteuid() || user == 0 || user == trust.user;
}

bool has_trusted_peer(int socket, const Trust& trust) {
  ucred peer{};
  socklen_t bytes = sizeof peer;
  if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &bytes) != 0) return false;
  // Who connected, by the kernel's word; the group is asked for viewers alone.
  if (is_trusted(peer.uid, trust)) return true;
  return trust.group && (peer.gid == *trust.group || has_peer_in(socket, *trust.group));
}

Result<int> bind_socket(const std::string& path, int type) {
  const auto address = socket_address(path);
  if (!address) return address.error();
  if (auto shared = check_socket_folder(path)) return std::move(*shared);
  if (auto taken = clear_the_way(path, *address, type)) return std::move(*taken);
  const int fd = socket(AF_UNIX, type, 0);
  // The file has the permissions of the descriptor when it is bound: it is never open to others.
  if (fd >= 0 && fchmod(fd, 0600) == 0 && bind(fd, plain(*address), sizeof *address) == 0)
    return fd;
  Error error = system_error(path, "cannot be bound");
  if (fd >= 0) close(fd);
  return error;
}

std::optional<Error> share_socket(const std::string& path, gid_t group) {
  struct stat info{};
  if (lstat(path.c_str(), &info) == 0 && !S_ISSOCK(info.st_mode))
    return Error{path + ": is not a socket; name another path, or remove that file"};
  const bool is_shared =
      // Not asked for where it holds: a service may not change owners at all.
      (info.st_gid == group || lchown(path.c_str(), static_cast<uid_t>(-1), group) == 0) &&
      chmod(path.c_str(), 0660) == 0;
  if (is_shared) return std::nullopt;
  return Error{path + ": cannot be given to the group of its viewers: " + std::strerror(errno) +
               "; name a group that you are in"};
}

Result<uid_t> find_user(const std::string& name) {
  if (const passwd* const entry = getpwnam(name.c_str())) return entry->pw_uid;
  return Error{name + ": no user of this computer has that name; getent passwd lists them"};
}

Result<gid_t> find_group(const std::string& name) {
  if (const group* const entry = getgrnam(name.c_str())) return entry->gr_gid;
  return Error{name + ": no group of this computer has that name; getent group lists them"};
}

SocketFile::SocketFile(std::string path) : path_(std::move(path)) {
  struct stat info{};
  if (lstat(path_.c_str(), &info) != 0 || !S_ISSOCK(info.st_mode)) return;
  device_ = info.st_dev;
  inode_ = info.st_ino;
}

void SocketFile::remove() const {
  struct stat info{};
  if (inode_ != 0 && lstat(path_.c_str(), &info) == 0 && info.st_dev == device_ &&
      info.st_ino == inode_)
    unlink(path_.c_str());
}

}  // namespace tact::model::io
