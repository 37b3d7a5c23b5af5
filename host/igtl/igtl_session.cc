// SPDX-License-Identifier: Apache-2.0
#include "host/igtl/igtl_session.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <utility>

namespace tact::host::igtl {

using boost::asio::ip::tcp;

void notice_vanishing(tcp::socket& socket) {
  // Linux's default keepalive starts after two hours.
  constexpr int kIdle_s = 5, kEvery_s = 2, kTimes = 3;
  static_assert(kVanished == std::chrono::seconds(kIdle_s + kTimes * kEvery_s));
  const auto set = [&socket](int level, int name, int value) {
    static_cast<void>(setsockopt(socket.native_handle(), level, name, &value, sizeof value));
  };
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, kIdle_s);
  set(IPPROTO_TCP, TCP_KEEPINTVL, kEvery_s);
  set(IPPROTO_TCP, TCP_KEEPCNT, kTimes);
}

IgtlSession::IgtlSession(tcp::socket socket, SessionEvents events)
    : socket_(std::move(socket)), timeout_(socket_.get_executor()), events_(std::move(events)) {}

void IgtlSession::start() {
  Code ignored;
  // Small messages at once: Nagle would delay a pose until the previous one is acknowledged.
  socket_.set_option(tcp::no_delay(true), ignored);
  notice_vanishing(socket_);
  read_head_next();
}

void IgtlSession::stop() {
  Code ignored;
  ended_ = true;
  timeout_.cancel(ignored);
  socket_.close(ignored);
}

void IgtlSession::end(const std::string& reason) {
  // A write and a read may both fail by one cause: it is reported once.
  if (std::exchange(ended_, true)) return;
  stop();
  if (events_.ended) events_.ended(reason);
}

void IgtlSession::end(const Code& wrong) {
  const bool went = wrong == boost::asio::error::eof ||
                    wrong == boost::asio::error::connection_reset ||
                    wrong == boost::asio::error::operation_aborted;
  end(went ? std::string() : wrong.message());
}

void IgtlSession::read_head_next() {
  boost::asio::async_read(
      socket_, boost::asio::buffer(bytes_.data(), kHeaderBytes),
      [self = shared_from_this()](Code wrong, std::size_t bytes) {
        if (wrong || self->ended_) return self->end(wrong);
        auto head = read_head({self->bytes_.data(), bytes});
        if (!head) return self->end(head.error().message);
        self->head_ = std::move(*head);
        const std::uint64_t body = self->head_.body_bytes;
        const bool is_used = self->head_.type == "TRANSFORM" || self->head_.type == "POSITION";
        // Before the body is read: the length is untrusted, and nothing is allocated for it.
        if (body > (is_used ? kMaxUsedBody : kMaxSkippedBody))
          return self->end(fmt::format("it announces a {} of {} bytes; nothing has so many",
                                       self->head_.type, body));
        if (is_used) return self->read_body(static_cast<std::size_t>(body));
        self->read_away(body);
      });
}

void IgtlSession::read_body(std::size_t bytes) {
  boost::asio::async_read(socket_, boost::asio::buffer(bytes_.data(), bytes),
                          [self = shared_from_this()](Code wrong, std::size_t got) {
                            if (wrong || self->ended_) return self->end(wrong);
                            self->take_body({self->bytes_.data(), got});
                            if (!self->ended_) self->read_head_next();
                          });
}

void IgtlSession::read_away(std::uint64_t bytes) {
  if (bytes == 0) return read_head_next();
  const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, bytes_.size()));
  socket_.async_read_some(boost::asio::buffer(bytes_.data(), part),
                          [self = shared_from_this(), bytes](Code wrong, std::size_t got) {
                            if (wrong || self->ended_) return self->end(wrong);
                            self->read_away(bytes - got);
                          });
}

void IgtlSession::take_body(std::string_view body) {
  const auto refuse = [this](const std::string& why) {
    if (events_.refused)
      events_.refused(fmt::format("{} of \"{}\": {}", head_.type, head_.device, why));
  };
  // First: after a wrong checksum any other error would be misleading.
  if (crc64(body) != head_.crc) return refuse("its checksum is not that of its bytes");
  has_spoken_ = true;
  const auto content = content_of(head_, body);
  if (!content) return refuse(content.error().message);
  if (!content->is_tracked) return;  // the sender does not see the body
  const auto pose = pose_of(head_.type, content->bytes);
  if (!pose) return refuse(pose.error().message);
  if (events_.pose) events_.pose(head_, *pose);
}

void IgtlSession::send(const std::string& batch) {
  if (ended_) return;
  // The newest batch replaces the waiting one: old poses are useless.
  waiting_ = batch;
  if (on_its_way_.empty()) write_next();
}

void IgtlSession::write_next() {
  on_its_way_ = std::exchange(waiting_, {});
  timeout_.expires_after(kTimeout);
  timeout_.async_wait([self = shared_from_this()](Code cancelled) {
    if (!cancelled && !self->on_its_way_.empty())
      self->end(fmt::format("it has taken nothing for {} s", kTimeout.count()));
  });
  boost::asio::async_write(socket_, boost::asio::buffer(on_its_way_),
                           [self = shared_from_this()](Code wrong, std::size_t) {
                             if (wrong || self->ended_) return self->end(wrong);
                             self->on_its_way_.clear();
                             Code ignored;
                             self->timeout_.cancel(ignored);
                             if (!self->waiting_.empty()) self->write_next();
                           });
}

}  // namespace tact::host::igtl
