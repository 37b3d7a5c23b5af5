// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/control_client.h"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "firmware/console/control_name.h"
#include "model/io/socket_file.h"

namespace tact::firmware::console {
namespace {

using model::Error;
using model::Result;

// Chosen: a running tactd answers at once; before it answers `set` it computes the new law.
constexpr timeval kTimeout{.tv_sec = 5, .tv_usec = 0}, kSetTimeout{.tv_sec = 60, .tv_usec = 0};

/// A connected socket; -1: no process listens, the peer is not trusted, or (errno EACCES) a
/// refusal.
int connect_to(const std::string& path) {
  const auto address = model::io::socket_address(path);
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (!address || fd < 0) return fd < 0 ? fd : (close(fd), -1);
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &kTimeout, sizeof kTimeout);
  setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &kTimeout, sizeof kTimeout);
  // Root may talk to any user's tactd; other users trust only their own user and root.
  const bool good = connect(fd, model::io::plain(*address), sizeof *address) == 0 &&
                    (geteuid() == 0 || model::io::has_trusted_peer(fd));
  const int why = errno;
  if (good) return fd;
  close(fd);
  errno = why;
  return -1;
}

/// Nothing was found in the folder, or what runs there may not be asked.
Error why_none(const ControlQuestion& question, const ControlName& closed) {
  const bool is_closed = !closed.path.empty();
  struct stat facts{};
  const bool known = stat((is_closed ? closed.path : question.folder).c_str(), &facts) == 0;
  const passwd* const user = known ? getpwuid(facts.st_uid) : nullptr;
  const std::string name = user != nullptr ? user->pw_name : std::to_string(facts.st_uid);
  const auto remedy = fmt::format("sudo tactctl {} {}", question.scene_path, question.word);
  if (is_closed)
    return {fmt::format("it runs as {} (pid {}); you may not ask it: its own user and root may, {}",
                        name, closed.process, remedy)};
  if (known && access(question.folder.c_str(), R_OK) != 0)
    return {
        fmt::format("{} is closed to you: what runs there runs as {}; its own user and root "
                    "may ask it, {}",
                    question.folder, name, remedy)};
  return {fmt::format("no tactd runs {}{}: start one, or name the file that it was given",
                      question.scene_path,
                      question.process == 0 ? "" : fmt::format(" as {}", question.process))};
}

/// Sends one word and receives one message.
Result<Answer> talk(int fd, const ControlName& control, const std::string& word) {
  std::array<char, kLongestControlMessage> message{};
  if (word.starts_with("set "))
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &kSetTimeout, sizeof kSetTimeout);
  const bool sent =
      send(fd, word.data(), word.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(word.size());
  // tactd answers a refused client before its request: the answer is read after the hang-up.
  const bool refused = !sent && (errno == EPIPE || errno == ECONNRESET);
  ssize_t n = sent || refused ? recv(fd, message.data(), message.size(), 0) : -1;
  if (n < 0 && errno == ECONNRESET) n = recv(fd, message.data(), message.size(), 0);
  if (n > 0) return unpack_answer(std::string(message.data(), static_cast<std::size_t>(n)));
  return Error{fmt::format(
      "process {} does not answer ({}): it may hang or have been stopped; the power switch is sure",
      control.process, n == 0 ? "it has ended" : std::strerror(errno))};
}

}  // namespace

Result<Answer> ask_tactd(const ControlQuestion& question) {
  int fd = -1;
  ControlName chosen, closed;
  std::string alive;
  for (const ControlName& control : find_controls(question.folder, question.scene_path)) {
    if (question.process != 0 && control.process != question.process) continue;
    const int found = connect_to(control.path);
    // No connection: the tactd of this socket was killed, or hears others alone.
    if (found < 0 && errno == EACCES) closed = control;
    if (found < 0) continue;
    alive += fmt::format("{}{}", alive.empty() ? "" : " and ", control.process);
    if (fd >= 0) close(found);
    // Keep the first connection; ask only after checking that there is no second one.
    if (fd < 0) fd = found, chosen = control;
  }
  if (fd < 0) return why_none(question, closed);
  auto answer =
      alive == std::to_string(chosen.process)
          ? talk(fd, chosen, question.word)
          : Result<Answer>(Error{fmt::format("processes {} run {}: say which one by --pid", alive,
                                             question.scene_path)});
  close(fd);
  return answer;
}

}  // namespace tact::firmware::console
