// SPDX-License-Identifier: Apache-2.0
#include "host/run/telemetry_client.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <boost/system/error_code.hpp>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "hal/sim/hand_target.h"
#include "model/io/socket_file.h"

namespace tact::host::run {
namespace {

using boost::system::error_code;
using model::Error;

constexpr std::chrono::milliseconds kRetry{50};  // short, as a person waits for the first frame
constexpr double kTimeout_s = 0.3;               // as on the page (host/README.md)
constexpr int kMessagesPerTurn = 64;             // then other work gets a turn
constexpr std::int64_t kMaxStartBytes = 200'000'000;  // four meshes as telemetry_check.cc allows
constexpr std::size_t kMaxMessageBytes = 1 << 16;     // many times a frame

/// The descriptor in a control message, or -1. Any further ones are closed.
int take_descriptor(msghdr& message) {
  int found = -1;
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (c->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(c) + i * sizeof(int), sizeof fd);
      // All received descriptors must be closed; otherwise each message could use one up.
      if (found < 0)
        found = fd;
      else
        ::close(fd);
    }
  }
  return found;
}

/// Copies instead of mapping, so that a file that shrinks later does no harm. Empty if it cannot be
/// read, or is too large.
std::string read_memory_file(int fd) {
  struct stat status{};
  if (fstat(fd, &status) != 0 || status.st_size < 0 || status.st_size > kMaxStartBytes) return {};
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = pread(fd, &bytes[done], bytes.size() - done, static_cast<off_t>(done));
    if (got <= 0) return {};
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace

std::string default_telemetry_path() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime != '\0') return fmt::format("{}/tact/telemetry.sock", runtime);
  return fmt::format("/tmp/tact-{}/telemetry.sock", getuid());
}

TelemetryClient::TelemetryClient(boost::asio::io_context& io, std::string path,
                                 TelemetryEvents events, const model::io::Trust& trust)
    : socket_(io),
      retry_(io),
      silence_(io),
      path_(std::move(path)),
      trust_(trust),
      events_(std::move(events)) {
  hand_socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

TelemetryClient::~TelemetryClient() {
  if (hand_socket_ >= 0) ::close(hand_socket_);
}

void TelemetryClient::start() { connect(); }

void TelemetryClient::stop() {
  error_code ignored;
  retry_.cancel(ignored);
  silence_.cancel(ignored);
  socket_.close(ignored);
}

void TelemetryClient::connect() {
  const auto address = model::io::socket_address(path_);
  if (!address) return lose(address.error().message);
  // In a folder that other users may write to, any of them could have created this socket.
  if (const auto shared = model::io::check_socket_folder(path_, trust_))
    return lose(shared->message);
  const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return lose(fmt::format("no socket: {}", std::strerror(errno)));
  if (::connect(fd, model::io::plain(*address), sizeof *address) != 0) {
    const int why = errno;
    ::close(fd);
    // Before tactd starts, a missing listener is normal and needs no message.
    const bool absent = why == ENOENT || why == ECONNREFUSED || why == EAGAIN;
    return lose(absent ? std::string() : fmt::format("{}: {}", path_, std::strerror(why)));
  }
  // Asks the kernel for the peer's user: the file's owner is no proof of the listener.
  if (!model::io::has_trusted_peer(fd, trust_)) {
    ::close(fd);
    return lose(
        fmt::format("{} belongs to another user's program; start tactd and tact-view as "
                    "one user, or give --tactd-user or --socket",
                    path_));
  }
  error_code wrong;
  socket_.assign(fd, wrong);
  if (wrong) {
    ::close(fd);
    return lose(wrong.message());
  }
  wait_for_data();
}

void TelemetryClient::lose(const std::string& reason) {
  error_code ignored;
  socket_.close(ignored);
  silence_.cancel(ignored);
  // Reported once: a loss or a new reason, but not the same reason at each retry.
  const bool had_start = has_start_;
  has_start_ = is_silent_ = false;
  if (had_start || reason != last_reason_) events_.lost(reason);
  last_reason_ = reason;
  retry_later();
}

void TelemetryClient::retry_later() {
  retry_.expires_after(kRetry);
  retry_.async_wait([this](error_code wrong) {
    if (!wrong) connect();
  });
}

void TelemetryClient::wait_for_data() {
  socket_.async_wait(boost::asio::posix::descriptor_base::wait_read, [this](error_code wrong) {
    if (wrong) return;  // closed by stop()
    // All pending messages in one turn, so that the newest frame is shown.
    for (int i = 0; i < kMessagesPerTurn && read_message(); ++i) {
    }
    if (socket_.is_open()) wait_for_data();
  });
}

bool TelemetryClient::has_data() {
  pollfd one{.fd = socket_.native_handle(), .events = POLLIN, .revents = 0};
  return ::poll(&one, 1, 0) == 1;
}

/// Restarts the silence timer at each message; a silent tactd keeps its connection.
void TelemetryClient::listen() {
  if (std::exchange(is_silent_, false) && events_.silent) events_.silent(0.0);
  const double timeout_s =
      // Below 8.3 frames a second 0.3 s would be less than 2.5 intervals.
      std::max(kTimeout_s, 2.5 / std::max(1.0, header_.frame_rate_Hz));
  silence_.expires_after(std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(timeout_s)));
  silence_.async_wait([this, timeout_s](error_code wrong) {
    const bool came = silence_.expiry() > boost::asio::steady_timer::clock_type::now();
    if (wrong || came || !socket_.is_open() || has_data()) return;  // data waits, not yet read
    is_silent_ = true;
    if (events_.silent) events_.silent(timeout_s);
  });
}

/// Reads one message. False if none is left or the connection ended.
bool TelemetryClient::read_message() {
  char bytes[kMaxMessageBytes];
  alignas(cmsghdr) char control[CMSG_SPACE(4 * sizeof(int))];
  iovec part{.iov_base = bytes, .iov_len = sizeof bytes};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t got = ::recvmsg(socket_.native_handle(), &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  // 0: tactd closed the connection.
  if (got <= 0) return lose({}), false;

  const int memory_file = take_descriptor(message);
  const std::optional<Error> error =
      has_start_ ? take_frame({bytes, static_cast<std::size_t>(got)})
                 : take_start({bytes, static_cast<std::size_t>(got)}, memory_file);
  if (memory_file >= 0) ::close(memory_file);
  if (error) lose(error->message);
  return !error && socket_.is_open();
}

std::optional<Error> TelemetryClient::take_start(std::string_view message, int memory_file) {
  if (message == firmware::protocol::kFull)
    return Error{"tactd has as many viewers as it takes; close one of them"};
  if (message != firmware::protocol::kMagic)
    return Error{
        "the first message is not that of this tactd; use tactd and tact-view of one build"};
  if (memory_file < 0) return Error{"tactd sent no memory file with its first message"};
  auto start = firmware::protocol::RunReader::of_bytes(read_memory_file(memory_file));
  if (!start) return Error{"tactd's memory file " + start.error().message};
  header_ = start->header();
  if (std::optional<Error> error = record::check_header(header_)) return error;
  auto frames = start->unpacker<record::Frame>();
  if (!frames) return Error{"tactd's memory file: " + frames.error().message};
  frames_.emplace(std::move(*frames));
  firmware::protocol::Chunk chunk;
  if (!start->next(chunk) || chunk.kind != firmware::protocol::ChunkKind::kMeshes)
    return Error{"tactd's memory file has no meshes"};
  record::MeshBytes mesh(chunk.content.size());
  std::memcpy(mesh.data(), chunk.content.data(), mesh.size());
  if (std::optional<Error> error = record::check_mesh(header_, mesh)) return error;
  has_start_ = true;
  listen();
  events_.start(header_, std::move(mesh));
  return std::nullopt;
}

std::optional<Error> TelemetryClient::take_frame(std::string_view message) {
  record::Frame frame;
  const auto chunk = firmware::protocol::chunk_in(message);
  if (!chunk || chunk->kind != firmware::protocol::ChunkKind::kFrame ||
      !frames_->unpack(chunk->content, &frame))
    return Error{"a message is no telemetry frame; use tactd and tact-view of one build"};
  if (std::optional<Error> error = record::check_frame(frame, header_)) return error;
  listen();
  events_.frame(frame);
  return std::nullopt;
}

void TelemetryClient::move_hand(const double (&position_m)[3], const double (&rotation_rad)[3],
                                double grip_ratio) {
  // Never for hardware, whose hand is real.
  if (!has_start_ || !header_.simulated) return;
  const auto address = model::io::socket_address(header_.hand_socket);
  if (!address) return;
  hal::sim::HandTarget target;
  std::copy(std::begin(position_m), std::end(position_m), target.position_m);
  std::copy(std::begin(rotation_rad), std::end(rotation_rad), target.rotation_rad);
  target.grip_ratio = grip_ratio;
  // A full or missing socket drops the target; the next one follows in 16 ms.
  (void)::sendto(hand_socket_, &target, sizeof target, MSG_DONTWAIT | MSG_NOSIGNAL,
                 model::io::plain(*address), sizeof *address);
}

}  // namespace tact::host::run
