// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/status_line.h"

#include <fmt/format.h>

#include <cmath>

#include "firmware/loop/supervisor.h"
#include "model/fault.h"

namespace tact::firmware::console {

std::string status_line(const telemetry::Frame& frame, const telemetry::Frame& before) {
  const double elapsed_s = static_cast<double>(frame.time_ns - before.time_ns) * 1e-9;
  const auto ticks = static_cast<double>(frame.tick - before.tick);
  const double rate_Hz = elapsed_s > 0.0 ? ticks / elapsed_s : 0.0;
  const float force_N = std::hypot(frame.force_N[0], frame.force_N[1], frame.force_N[2]);
  const model::Fault shown =
      static_cast<model::Fault>(frame.fault != 0 ? frame.fault : frame.limit);
  const char* reason = shown == model::Fault::kNone ? "" : model::describe(shown).name;
  std::string losses;
  if (frame.contact_losses > 0) losses = fmt::format("  contact lost {}", frame.contact_losses);
  return fmt::format(
      "{:7.1f} s  {:4.0f} Hz  late {}  skipped {}  tick {:5.1f} us  force {:6.3f} N  {}  {}{}",
      static_cast<double>(frame.time_ns) * 1e-9, rate_Hz, frame.late_ticks, frame.skipped_ticks,
      frame.median_tick_us, force_N, name_of(frame.state), reason, losses);
}

}  // namespace tact::firmware::console
