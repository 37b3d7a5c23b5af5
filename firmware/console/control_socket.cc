// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/control_socket.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "firmware/console/control_name.h"

namespace tact::firmware::console {
namespace {

using model::Error;
using model::Result;

// Both chosen: tactctl connects, sends its request and ends.
constexpr std::size_t kMaxSilent = 8;
constexpr int kQueue = 8;
constexpr unsigned kPause_us = 20'000;  // limits the rate of failing accepts

/// Adds `fd` to the epoll descriptor. The main thread waits for that one and for signals.
bool watch_it(int watch, int fd) {
  epoll_event event{.events = EPOLLIN, .data = {.fd = fd}};
  return epoll_ctl(watch, EPOLL_CTL_ADD, fd, &event) == 0;
}

/// Listens under a temporary name first: a client that finds the final name can connect.
Result<int> listen_at(const std::string& path) {
  const std::string before = path + ".new";
  const auto listener =
      model::io::bind_socket(before, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (!listener) return listener.error();
  if (listen(*listener, kQueue) == 0 && rename(before.c_str(), path.c_str()) == 0) return *listener;
  Error error{fmt::format("{}: {}", path, std::strerror(errno))};
  close(*listener);
  return error;
}

}  // namespace

std::string pack_answer(const Answer& answer) {
  return ((answer.done ? "+" : "-") + answer.message).substr(0, kLongestControlMessage);
}

Answer unpack_answer(const std::string& message) {
  return {.done = message.starts_with('+'), .message = message.empty() ? "" : message.substr(1)};
}

ControlRequest::ControlRequest(ControlRequest&& other) noexcept
    : client_(std::exchange(other.client_, -1)), word_(std::move(other.word_)) {}

ControlRequest::~ControlRequest() {
  if (client_ >= 0) close(client_);
}

void ControlRequest::answer(const Answer& answer) const {
  const std::string message = pack_answer(answer);
  [[maybe_unused]] const auto heard =  // a client that has gone needs no answer
      send(client_, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

Result<std::unique_ptr<ControlSocket>> ControlSocket::open(const std::string& path) {
  remove_dead_controls(std::filesystem::path(path).parent_path());
  const auto listener = listen_at(path);
  if (!listener) return listener.error();
  const int watch = epoll_create1(EPOLL_CLOEXEC);
  // Owns both descriptors and the file from here on, also after an error below.
  std::unique_ptr<ControlSocket> control(
      new ControlSocket(model::io::SocketFile(path), *listener, watch));
  if (watch < 0 || !watch_it(watch, *listener))
    return Error{fmt::format("{}: {}", path, std::strerror(errno))};
  return control;
}

ControlSocket::~ControlSocket() {
  // The name first: a new client then finds no socket, instead of one that does not answer.
  file_.remove();
  for (const int client : silent_) close(client);
  for (const int fd : {listener_, watch_, spare_})
    if (fd >= 0) close(fd);
}

std::optional<ControlRequest> ControlSocket::next() {
  epoll_event event{};
  // Reserves a spare descriptor again, as soon as one is free.
  if (spare_ < 0) spare_ = fcntl(listener_, F_DUPFD_CLOEXEC, 0);
  while (epoll_wait(watch_, &event, 1, 0) == 1) {
    if (event.data.fd != listener_) {
      if (auto request = read(event.data.fd)) return request;
    } else if (!accept_one()) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

// Without a free descriptor the spare one is released for the first client. False: even that
// failed.
bool ControlSocket::accept_one() {
  const auto accept_it = [this] {
    return accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  };
  int client = accept_it();
  if (client < 0 && (errno == EMFILE || errno == ENFILE) && spare_ >= 0) {
    close(std::exchange(spare_, -1));
    client = accept_it();
  }
  if (client < 0) {
    const bool is_gone = errno == EAGAIN || errno == ECONNABORTED;
    if (!is_gone) usleep(kPause_us);
    return is_gone;
  }
  if (!model::io::has_trusted_peer(client) || !watch_it(watch_, client)) {
    const ControlRequest stranger(client, "");
    stranger.answer({.done = false, .message = "only the user of this tactd, and root, are heard"});
    return true;
  }
  // The client that has been silent longest makes room for the new one.
  if (silent_.size() == kMaxSilent) {
    close(silent_.front());
    silent_.erase(silent_.begin());
  }
  silent_.push_back(client);
  return true;
}

std::optional<ControlRequest> ControlSocket::read(int client) {
  std::array<char, kLongestControlMessage> word{};
  const auto n = recv(client, word.data(), word.size(), MSG_DONTWAIT);
  if (n < 0 && errno == EAGAIN) return std::nullopt;
  // One word per connection: nothing after it is read.
  epoll_ctl(watch_, EPOLL_CTL_DEL, client, nullptr);
  std::erase(silent_, client);
  ControlRequest request(
      client, std::string(word.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0))));
  if (n <= 0) return std::nullopt;
  return request;
}

}  // namespace tact::firmware::console
