// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/loop_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/admission/refusals.h"
#include "firmware/gate/limits_for.h"
#include "firmware/watch/stall_detector.h"
#include "hal/gpio/gpio_lines.h"
#include "hal/lines_settings.h"
#include "model/io/limits_checksum.h"
#include "model/time_ns.h"

namespace tact::firmware::run {

using model::Error;
using model::Result;

namespace {

// Checks what this device and PC require of a scene.
std::optional<Error> admit(const model::scene::Scene& scene, const PartsSetup& setup,
                           LoopParts& parts) {
  // After the device is open, because it may report its damping only then.
  const auto stiffness = admission::check_renderable(scene, *parts.tissue, parts.device->info());
  if (!stiffness) return stiffness.error();
  parts.stiffness = *stiffness;
  // Simulated time waits, so no law is too slow.
  if (setup.simulated_time) return {};
  const auto time = admission::check_budget(scene, *parts.tissue,
                                            setup.non_rt ? std::nullopt : std::optional(setup.rt));
  if (!time) return time.error();
  parts.time = *time;
  // After the time check: presses of a law that is too slow would take minutes.
  auto presses = admission::check_presses(scene, *parts.tissue, parts.device->info(),
                                          parts.stiffness.limit_N_per_m);
  if (!presses) return presses.error();
  parts.presses = std::move(*presses);
  return {};
}

}  // namespace

Result<LoopParts> open_loop_parts(const model::scene::Scene& scene, const PartsSetup& setup) {
  LoopParts parts;
  auto tissue = model::scene::make_tissue(scene);
  if (!tissue) return tissue.error();
  parts.tissue = std::move(*tissue);
  if (setup.simulated_time && !hal::registry::is_simulated(scene.device))
    return Error{fmt::format(
        "{}: --free-run is simulated time, and device.kind \"{}\" is hardware; leave it out",
        scene.path, scene.device.kind)};
  // The lines before the device: enable is low, so no drive has power while the device opens.
  auto lines = hal::gpio::open_safety_lines(scene.device.of<hal::LinesSettings>());
  if (!lines) return Error{fmt::format("{}: {}", scene.path, lines.error().message)};
  parts.lines = std::move(*lines);
  auto device = hal::registry::open_device(scene);
  if (!device) return device.error();
  parts.device = std::move(*device);
  // Immediately, because from here on a crash would leave an open device.
  // Chosen, longer than the watch's own delays: at least 20 ms; on a stock kernel half a second.
  constexpr std::int64_t kMinSilence_ns = 20 * model::kMillisecond_ns;
  const watch::StallDetector stall(model::period_ns(scene.rate_Hz), true);
  const std::int64_t silence_ns =
      setup.non_rt ? model::kSecond_ns / 2 : std::max(kMinSilence_ns, stall.longest_ns());
  auto guardian = start_guardian(*parts.device, {.priority = setup.rt.priority + 1,
                                                 .silence_ns = silence_ns,
                                                 .period_ns = stall.period_ns(),
                                                 .program = {}});
  if (!guardian) return guardian.error();
  parts.guardian = std::move(*guardian);
  if (auto error = admit(scene, setup, parts)) return *error;
  parts.limits = gate::limits_for(scene.limits, parts.device->info());
  if (auto error = admission::check_thermal(scene, parts.limits)) return *error;
  // Of the limits in use: a PC with a quarter of the force has another checksum.
  parts.limits_checksum =
      model::io::limits_checksum(model::limits_in_use(parts.limits, setup.force_share()));
  const double period_s = static_cast<double>(model::period_ns(scene.rate_Hz)) * 1e-9;
  parts.controller = std::make_unique<loop::Controller>(
      parts.tissue->contact_scene(), gate::Gate(parts.limits, period_s, setup.force_share()),
      !setup.non_rt, gate::GripGate::make(parts.limits, period_s, setup.force_share()));
  parts.ring = std::make_unique<loop::TickRing>(scene.rate_Hz);
  return parts;
}

Result<std::unique_ptr<guardian::Guardian>> start_guardian(hal::Device& device,
                                                           const guardian::GuardianSettings& s) {
  const auto frames = device.shutdown_frames();
  // Null: simulated, or the vendor's handle cannot be shared (hal/shutdown_frames.h).
  if (!frames) return std::unique_ptr<guardian::Guardian>();
  return guardian::Guardian::start(*frames, s);
}

}  // namespace tact::firmware::run
