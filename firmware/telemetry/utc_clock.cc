// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/utc_clock.h"

#include <fmt/chrono.h>
#include <sys/timex.h>

#include <algorithm>
#include <ctime>
#include <limits>

#include "hal/monotonic.h"
#include "model/time_ns.h"

namespace tact::firmware::telemetry {

protocol::UtcOffset read_utc_offset() {
  protocol::UtcOffset out;
  // Of some readings the fastest: another thread may come between the two clocks.
  std::int64_t fastest_ns = std::numeric_limits<std::int64_t>::max();
  for (int i = 0; i < 5; ++i) {
    timespec utc{};
    const std::int64_t before_ns = hal::monotonic_ns();
    clock_gettime(CLOCK_REALTIME, &utc);
    const std::int64_t took_ns = hal::monotonic_ns() - before_ns;
    if (took_ns >= fastest_ns) continue;
    fastest_ns = took_ns;
    out.offset_ns = utc.tv_sec * model::kSecond_ns + utc.tv_nsec - before_ns - took_ns / 2;
  }
  timex kernel{};  // asks, changes nothing
  if (adjtimex(&kernel) < 0 || (kernel.status & STA_UNSYNC) != 0) return out;
  const long took_us = fastest_ns / 2000 + 1, most_us = protocol::kMaxUtcError_us;
  out.max_error_us = static_cast<std::uint32_t>(std::min(kernel.maxerror + took_us, most_us));
  out.error_us = static_cast<std::uint32_t>(std::min(kernel.esterror + took_us, most_us));
  return out;
}

std::string date_of(std::int64_t utc_ns) {
  const std::time_t second = utc_ns / model::kSecond_ns;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:09d}Z", fmt::gmtime(second),
                     utc_ns % model::kSecond_ns);
}

}  // namespace tact::firmware::telemetry
