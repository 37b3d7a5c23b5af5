// SPDX-License-Identifier: Apache-2.0
// live_session.h - one browser's WebSocket: status and frames out, hand targets in.
//
// Each frame is one JSON text (frame_json.h), followed by the text of its overlay (figure_json.h).
// The page answers {"seen": n} with the number of frames it took so far. At most kMaxUnseen may be
// unacknowledged; of those that wait only the newest is kept. So a slow browser gets fewer frames,
// never older ones, and delays no other. A page may send
// {"hand":{"x_m":..,"y_m":..,"z_m":..,"turn_x_rad":..,"turn_y_rad":..,"turn_z_rad":..,
// "grip_ratio":..}} for a simulated device, the requests of replay_request.h to a replay, and those
// of scene_picker.h to a simulation that offers scenes, and {"key":"1"} to a program that asks for
// answers. Any other message is ignored: no page arms, stops or resets a device.
#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "host/server/connection_slot.h"
#include "host/server/live_view.h"
#include "host/server/replay_request.h"

namespace tact::host::server {

/// Target pose of the simulated hand, W.
struct HandRequest {
  double position_m[3] = {};
  double rotation_rad[3] = {};  // of the tool relative to its rest orientation, rotation vector
  double grip_ratio = 0.0;      // 0 open, 1 closed
};
using MoveHand = std::function<void(const HandRequest&)>;
using AskScene = std::function<void(const nlohmann::json& request)>;
using TakeDigit = std::function<void(char digit)>;

/// The hand target in a page's message; none if it is missing or a number is out of range.
std::optional<HandRequest> parse_hand(const std::string& text);
/// The key of a page, '0' to '9'; none if it is missing or another one.
std::optional<char> parse_digit(const std::string& text);

class LiveSession final : public LiveListener, public std::enable_shared_from_this<LiveSession> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  static constexpr std::uint64_t kMaxUnseen = 4;

  LiveSession(boost::beast::tcp_stream stream, ConnectionSlot slot, LiveView& view,
              const MoveHand& move_hand, const Steer& steer, const AskScene& ask_scene,
              const TakeDigit& take_digit);
  ~LiveSession();

  void start(const Request& upgrade);

  void on_status(const Text& status) override;
  void on_frame(const Text& frame, const Text& beside) override;

 private:
  void read_next();
  void take(const std::string& message);
  void write_next();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  ConnectionSlot slot_;
  boost::beast::flat_buffer in_;
  LiveView& view_;
  const MoveHand& move_hand_;
  const Steer& steer_;
  const AskScene& ask_scene_;
  const TakeDigit& take_digit_;
  Text next_status_, next_frame_, next_beside_, writing_;
  Text due_beside_;  // overlay of the frame that was written last
  std::uint64_t sent_frames_ = 0, seen_frames_ = 0;
};

}  // namespace tact::host::server
