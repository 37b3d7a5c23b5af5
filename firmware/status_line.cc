#include "firmware/status_line.h"

#include <fmt/format.h>

#include <cmath>

#include "firmware/supervisor.h"
#include "model/fault.h"

namespace tact::firmware {

std::string status_line(const Frame& frame, double rate_Hz) {
  const float force_N = std::hypot(frame.force_N[0], frame.force_N[1], frame.force_N[2]);
  const Fault shown = static_cast<Fault>(frame.fault != 0 ? frame.fault : frame.limit);
  const char* reason = shown == Fault::kNone ? "" : model::describe(shown).name;
  return fmt::format(
      "{:7.1f} s  {:g} Hz  late {}  skipped {}  tick {:5.1f} us  force {:6.3f} N  {}  {}",
      static_cast<double>(frame.time_ns) * 1e-9, rate_Hz, frame.late_ticks, frame.skipped_ticks,
      frame.median_tick_us, force_N, name_of(frame.state), reason);
}

}  // namespace tact::firmware
