// SPDX-License-Identifier: Apache-2.0
// operator_desk.h - a person asks, the loop does it or not, and the person hears which.
//
// Arming is an act, made once, when it may be: after the words "ready, force is off" were told. A
// request that comes at another time is refused with the reason, and forgotten.
#pragma once

#include <functional>

#include "firmware/run/operator_signals.h"
#include "firmware/run/operator_view.h"

namespace tact::firmware::run {

class OperatorDesk {
 public:
  OperatorDesk(const OperatorSignals& signals, loop::Requests& requests, OperatorView& view,
               std::function<telemetry::Frame()> newest)
      : signals_(signals), requests_(requests), view_(view), newest_(std::move(newest)) {}

  /// Waits at most so long for one request, shows the newest frame, and does or refuses it.
  void obey(std::int64_t longest_ns);

 private:
  bool show();
  void arm();
  void reset();
  void refuse(const char* what, const std::string& why) const;

  const OperatorSignals& signals_;
  loop::Requests& requests_;
  OperatorView& view_;
  std::function<telemetry::Frame()> newest_;
};

}  // namespace tact::firmware::run
