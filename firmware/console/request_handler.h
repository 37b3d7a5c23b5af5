// SPDX-License-Identifier: Apache-2.0
// request_handler.h - passes an operator's request to the loop and answers with the outcome.
//
// Arming is a single act after the message "ready, force is off". A request at another time is
// refused with the reason, and not kept.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "firmware/console/control_socket.h"
#include "firmware/console/operator_signals.h"
#include "firmware/console/operator_view.h"
#include "firmware/loop/progress.h"
#include "firmware/loop/requests.h"

namespace tact::firmware::console {

/// 1 ms.
void pause_a_moment();

class RequestHandler {
 public:
  /// Answers "set KEY=VALUE ..."; the request and what follows the word.
  using Set = std::function<void(ControlRequest request, const std::string& set)>;
  /// `control`: null without tactctl. `progress`: the loop's own counters, whose state, fault and
  /// force replace those of `newest`: telemetry may wait for a disk. `pause`: sleeps while the loop
  /// works on a request.
  RequestHandler(const OperatorSignals& signals, loop::Requests& requests, OperatorView& view,
                 std::function<protocol::Frame()> newest, ControlSocket* control = nullptr,
                 const loop::Progress* progress = nullptr,
                 std::function<void()> pause = pause_a_moment, Set set = {})
      : signals_(signals),
        requests_(requests),
        view_(view),
        newest_(std::move(newest)),
        control_(control),
        progress_(progress),
        pause_(std::move(pause)),
        set_(std::move(set)) {}

  /// Waits at most `longest_ns` for a request, shows the newest frame, then handles the request.
  void serve(std::int64_t longest_ns);

 private:
  std::optional<ControlRequest> next_request() const;
  bool show();
  void handle(ControlRequest request, bool too_early);
  protocol::Frame newest() const;
  Answer status() const;
  Answer do_word(const std::string& word, bool too_early);
  Answer arm(bool too_early);
  Answer reset(bool too_early);
  Answer disarm();
  Answer stop();
  Answer event(std::string_view number_text);
  std::optional<bool> ask_loop(loop::Request request);
  std::optional<bool> wait_for(std::uint32_t number);
  Answer not_done(const char* what, const std::optional<bool>& answer, const char* why) const;
  Answer refuse(const char* what, const std::string& why) const;

  const OperatorSignals& signals_;
  loop::Requests& requests_;
  OperatorView& view_;
  std::function<protocol::Frame()> newest_;
  ControlSocket* control_;
  const loop::Progress* progress_;
  std::function<void()> pause_;
  Set set_;
};

/// The socket for tactctl; null, with a report, if it cannot be opened.
std::unique_ptr<ControlSocket> open_control(const std::string& scene_path,
                                            const OperatorView& view);

}  // namespace tact::firmware::console
