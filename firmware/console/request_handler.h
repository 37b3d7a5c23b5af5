// SPDX-License-Identifier: Apache-2.0
// request_handler.h - a person asks, the loop does it or not, and the person hears which.
//
// Arming is an act, made once, when it may be: after the words "ready, force is off" were told. A
// request that comes at another time is refused with the reason, and forgotten.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "firmware/console/control_socket.h"
#include "firmware/console/operator_signals.h"
#include "firmware/console/operator_view.h"
#include "firmware/loop/requests.h"

namespace tact::firmware::console {

/// 1 ms.
void pause_a_moment();

class RequestHandler {
 public:
  /// `control`: none, and nobody can ask. `pause` lets the loop have a moment to answer.
  RequestHandler(const OperatorSignals& signals, loop::Requests& requests, OperatorView& view,
                 std::function<telemetry::Frame()> newest, ControlSocket* control = nullptr,
                 std::function<void()> pause = pause_a_moment)
      : signals_(signals),
        requests_(requests),
        view_(view),
        newest_(std::move(newest)),
        control_(control),
        pause_(std::move(pause)) {}

  /// Waits at most so long for a request, shows the newest frame, and does or refuses it.
  void obey(std::int64_t longest_ns);

 private:
  std::optional<ControlRequest> next_request() const;
  bool show();
  Answer do_word(const std::string& word, bool too_early);
  Answer arm(bool too_early);
  Answer reset(bool too_early);
  Answer disarm();
  Answer stop();
  std::optional<bool> ask_loop(loop::Request request);
  std::optional<bool> wait_for(std::uint32_t number);
  Answer not_done(const char* what, const std::optional<bool>& answer, const char* why) const;
  Answer refuse(const char* what, const std::string& why) const;

  const OperatorSignals& signals_;
  loop::Requests& requests_;
  OperatorView& view_;
  std::function<telemetry::Frame()> newest_;
  ControlSocket* control_;
  std::function<void()> pause_;
};

/// The socket for tactctl; none, and told, where it cannot be opened.
std::unique_ptr<ControlSocket> open_control(const std::string& scene_path,
                                            const OperatorView& view);

}  // namespace tact::firmware::console
