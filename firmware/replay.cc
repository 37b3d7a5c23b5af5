#include "firmware/replay.h"

#include <fmt/format.h>

#include <array>
#include <bit>

#include "firmware/rt_setup.h"
#include "model/plan_file.h"

namespace tact::firmware {
namespace {

// Bits, not values: -0 is not 0 here, and NaN is itself.
std::array<unsigned char, sizeof(model::Wrench)> bits_of(const model::Wrench& wrench) {
  static_assert(sizeof wrench == 6 * sizeof(double));
  return std::bit_cast<std::array<unsigned char, sizeof(model::Wrench)>>(wrench);
}

}  // namespace

std::uint64_t hash_wrench(std::uint64_t hash, const model::Wrench& wrench) {
  for (const unsigned char byte : bits_of(wrench)) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

model::Result<ReplayOutcome> replay(const std::string& path, const model::Scene& scene,
                                    const model::Tissue& tissue) {
  auto log = TickLogReader::open(path);
  if (!log) return log.error();
  const LogHeader& header = log->header();
  if (scene.hash != header.scene_hash)
    return model::Error{fmt::format(
        "{}: was recorded with another scene (hash {}, this one has {}); replay it with the scene "
        "of that run, unchanged, and {}",
        path, header.scene_hash, scene.hash,
        header.overrides[0] == '\0'
            ? "no --set"
            : "with" + model::command_text(header.overrides_of_run()) + " or no --set at all")};
  if (header.ticks != 0)
    return model::Error{path +
                        ": is a black box, which begins in the middle of a run; tact-view --open "
                        "shows it, tactd --record keeps a run from its start"};
  flush_denormals();  // as in the loop's thread
  const double period_s = static_cast<double>(header.period_ns) * 1e-9;
  Controller controller(tissue.contact_scene(), Gate(header.limits, period_s, header.force_share),
                        header.non_rt == 0);
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
    if (bits_of(output.written) == bits_of(tick.output.written)) continue;
    if (outcome.different++ == 0) outcome.first_different = tick.tick;
  }
  outcome.truncated = log->truncated();
  return outcome;
}

}  // namespace tact::firmware
