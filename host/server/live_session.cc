// SPDX-License-Identifier: Apache-2.0
#include "host/server/live_session.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "host/server/access.h"
#include "model/io/json.h"

namespace tact::host::server {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using beast::error_code;

constexpr std::size_t kMaxMessageBytes = 1024;
constexpr double kFarthestHand_m = 1.0;  // beyond any device

}  // namespace

std::optional<HandRequest> parse_hand(const std::string& text) {
  const nlohmann::json hand = object_in(text, "hand");
  if (hand.is_null()) return std::nullopt;
  double value[7];
  constexpr const char* kKeys[7] = {"x_m",        "y_m",        "z_m",       "turn_x_rad",
                                    "turn_y_rad", "turn_z_rad", "grip_ratio"};
  for (int i = 0; i < 7; ++i) {
    const auto found = hand.find(kKeys[i]);
    if (found == hand.end() || !found->is_number()) return std::nullopt;
    value[i] = found->get<double>();
    if (!std::isfinite(value[i])) return std::nullopt;
    // The simulator clamps to its workspace; this rejects absurd values before its socket.
    if (i < 6 && std::abs(value[i]) > (i < 3 ? kFarthestHand_m : std::numbers::pi))
      return std::nullopt;
  }
  return HandRequest{.position_m = {value[0], value[1], value[2]},
                     .rotation_rad = {value[3], value[4], value[5]},
                     .grip_ratio = std::clamp(value[6], 0.0, 1.0)};
}

std::optional<char> parse_digit(const std::string& text) {
  const auto message = model::io::parse_json(text, "request");
  if (!message || !message->is_object()) return std::nullopt;
  const nlohmann::json key = message->value("key", nlohmann::json());
  const std::string word = key.is_string() ? key.get<std::string>() : "";
  if (word.size() != 1 || word[0] < '0' || word[0] > '9') return std::nullopt;
  return word[0];
}

LiveSession::LiveSession(beast::tcp_stream stream, ConnectionSlot slot, LiveView& view,
                         const MoveHand& move_hand, const Steer& steer, const AskScene& ask_scene,
                         const TakeDigit& take_digit)
    : socket_(std::move(stream)),
      slot_(std::move(slot)),
      view_(view),
      move_hand_(move_hand),
      steer_(steer),
      ask_scene_(ask_scene),
      take_digit_(take_digit) {}

// The view holds a plain pointer to this session.
LiveSession::~LiveSession() { view_.unsubscribe(*this); }

void LiveSession::start(const Request& upgrade) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own timer
  socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
  if (!upgrade[http::field::sec_websocket_protocol].empty())
    socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, std::string(kProtocol));
    }));
  socket_.read_message_max(kMaxMessageBytes);
  error_code ignored;
  beast::get_lowest_layer(socket_).socket().set_option(boost::asio::ip::tcp::no_delay(true),
                                                       ignored);
  socket_.async_accept(upgrade, [self = shared_from_this()](error_code wrong) {
    if (wrong) return;
    self->view_.subscribe(*self);
    self->read_next();
  });
}

void LiveSession::on_status(const Text& status) {
  next_status_ = status;
  write_next();
}

void LiveSession::on_frame(const Text& frame, const Text& beside) {
  next_frame_ = frame;  // replaces a frame that still waits
  next_beside_ = beside;
  write_next();
}

void LiveSession::write_next() {
  if (writing_) return;
  // The overlay must directly follow its frame.
  if (due_beside_) {
    writing_ = std::move(due_beside_);
  } else if (next_status_) {
    writing_ = std::move(next_status_);
  } else if (next_frame_ && sent_frames_ - seen_frames_ < kMaxUnseen) {
    writing_ = std::move(next_frame_);
    due_beside_ = std::move(next_beside_);
    ++sent_frames_;
  } else {
    return;
  }
  socket_.text(true);
  socket_.async_write(boost::asio::buffer(*writing_),
                      [self = shared_from_this()](error_code wrong, std::size_t) {
                        self->writing_.reset();
                        if (!wrong) self->write_next();
                      });
}

void LiveSession::read_next() {
  socket_.async_read(in_, [self = shared_from_this()](error_code wrong, std::size_t) {
    if (wrong) return self->view_.unsubscribe(*self);
    self->take(beast::buffers_to_string(self->in_.data()));
    self->in_.consume(self->in_.size());
    self->read_next();
  });
}

void LiveSession::take(const std::string& text) {
  const auto message = model::io::parse_json(text, "request");
  if (message && message->is_object() && message->contains("seen") &&
      (*message)["seen"].is_number_unsigned()) {
    const std::uint64_t seen = (*message)["seen"].get<std::uint64_t>();
    // Clamped to the frames sent and never lower, so that a page cannot widen its window.
    seen_frames_ = std::clamp(seen, seen_frames_, sent_frames_);
    write_next();
  }
  if (steer_)
    if (const std::optional<ReplayRequest> request = parse_replay(text)) steer_(*request);
  if (take_digit_)
    if (const std::optional<char> digit = parse_digit(text)) take_digit_(*digit);
  if (!move_hand_) return;
  if (const std::optional<HandRequest> hand = parse_hand(text)) move_hand_(*hand);
  // After the check above: a page that may not move the hand may not choose a scene.
  if (ask_scene_)
    if (const nlohmann::json request = object_in(text, "request"); !request.is_null())
      ask_scene_(request);
}

}  // namespace tact::host::server
