// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/real_time.h"

#include "firmware/console/say.h"
#include "firmware/pc/pc_check.h"
#include "firmware/run/loop_parts.h"
#include "firmware/watch/runaway.h"

namespace tact::firmware::run {

void RealTime::enter(const pc::RtSettings& settings) {
  process_.emplace(shortfalls_);
  if (auto limited = watch::lift_rttime_limit()) shortfalls_.push_back(std::move(*limited));
  for (pc::Shortfall& s : probe_rt_threads(settings)) shortfalls_.push_back(std::move(s));
}

// The last line is a summary of tact-doctor.
void RealTime::report(const pc::RtSettings& settings) const {
  for (const pc::Shortfall& s : shortfalls_) console::say(stderr, "tactd: {}\n", s.message);
  const std::string red =
      name_red_rows(pc::check_pc({.files = pc::PcFiles{}, .core = choose_core(settings)}));
  if (!red.empty()) console::say(stderr, "tactd: {}\n", red);
}

}  // namespace tact::firmware::run
