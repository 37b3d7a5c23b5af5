#include "firmware/replay.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "firmware/rt_setup.h"

namespace tact::firmware {

std::uint64_t hash_wrench(std::uint64_t hash, const model::Wrench& wrench) {
  static_assert(sizeof wrench == 6 * sizeof(double));
  unsigned char bytes[sizeof wrench];
  std::memcpy(bytes, &wrench, sizeof wrench);
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

model::Result<ReplayOutcome> replay(const std::string& path, const model::Scene& scene,
                                    const model::Tissue& tissue) {
  auto log = TickLogReader::open(path);
  if (!log) return log.error();
  const LogHeader& header = log->header();
  if (scene.hash != header.scene_hash)
    return model::Error{fmt::format(
        "{}: was recorded with another scene (hash {}, this one has {}); replay it with "
        "the scene and the --set values of that run",
        path, header.scene_hash, scene.hash)};
  flush_denormals();  // as in the loop's thread
  const double period_s = static_cast<double>(header.period_ns) * 1e-9;
  Controller controller(tissue.contact_scene(), Gate(scene.limits, period_s, header.force_share));
  ReplayOutcome outcome;
  outcome.force_hash = kHashStart;
  LoggedTick tick;
  for (; log->next(tick); ++outcome.ticks) {
    if (tick.tick != outcome.ticks) {
      outcome.gap_before = tick.tick;
      break;
    }
    const TickOutput output = controller.tick(tick.input);
    outcome.force_hash = hash_wrench(outcome.force_hash, output.written);
    if (std::memcmp(&output.written, &tick.output.written, sizeof output.written) == 0) continue;
    if (outcome.different++ == 0) outcome.first_different = tick.tick;
  }
  outcome.truncated = log->truncated();
  return outcome;
}

}  // namespace tact::firmware
