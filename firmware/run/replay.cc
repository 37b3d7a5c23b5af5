// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/replay.h"

#include <fmt/format.h>

#include <optional>

#include "firmware/pc/rt_setup.h"
#include "firmware/telemetry/force_hash.h"
#include "model/scene/plan_file.h"
#include "model/scene/variant.h"
#include "model/time_ns.h"

namespace tact::firmware::run {
namespace {

/// Why this scene cannot replay the log, and what can.
std::optional<model::Error> check_header(const protocol::RunHeader& header, const std::string& path,
                                         const model::scene::Scene& scene) {
  // Another scene would give different forces without any error of the program.
  if (scene.hash != header.scene_hash)
    return model::Error{fmt::format(
        "{}: was recorded with another scene (hash {}, this one has {}); replay it with the scene "
        "of that run, unchanged, and {}",
        path, header.scene_hash, scene.hash,
        header.overrides.empty()
            ? "no --set"
            : "with" + model::scene::command_text(header.overrides) + " or no --set at all")};
  return std::nullopt;
}

/// Tissues with other numbers of the law, in the order of their use.
class ReplayedVariants {
 public:
  explicit ReplayedVariants(const model::scene::Scene& scene) : scene_(scene) {}

  std::optional<model::Error> use(std::uint32_t number, const protocol::TickLog& log,
                                  const std::string& path, loop::Controller& controller) {
    if (number == number_) return std::nullopt;
    const auto* const set = log.variant(number);
    if (set == nullptr)
      return model::Error{fmt::format(
          "{}: has no numbers of the law for its change {}; the ticks before it can be replayed "
          "from a record that ends there",
          path, number)};
    auto made = make_variant(scene_, *set);
    if (!made) return model::Error{fmt::format("{}: {}", path, made.error().message)};
    auto contact = std::make_unique<model::contact::Contact>(made->tissue->contact_scene());
    controller.use(*contact);
    // The contact before it is no longer used, nor is its tissue.
    contact_ = std::move(contact);
    in_use_ = std::move(*made);
    number_ = number;
    return std::nullopt;
  }

 private:
  const model::scene::Scene& scene_;
  std::uint32_t number_ = 0;
  model::scene::Variant in_use_;
  std::unique_ptr<model::contact::Contact> contact_;
};

}  // namespace

model::Result<ReplayOutcome> replay(const std::string& path, const model::scene::Scene& scene,
                                    const model::scene::Tissue& tissue) {
  auto log = protocol::TickLog::open(path);
  if (!log) return log.error();
  if (!log->missing().empty())
    return model::Error{
        fmt::format("{}: its ticks have no {}; replay it with the build that recorded it", path,
                    fmt::join(log->missing(), ", "))};
  const protocol::RunHeader& header = log->header();
  if (auto error = check_header(header, path, scene)) return *error;
  pc::flush_denormals();  // as in the loop's thread
  const double period_s = static_cast<double>(model::period_ns(header.rate_Hz)) * 1e-9;
  loop::Controller controller(
      tissue.contact_scene(), gate::Gate(header.limits, period_s, header.force_share),
      !header.non_rt, gate::GripGate::make(header.limits, period_s, header.force_share));
  ReplayedVariants variants(scene);
  ReplayOutcome outcome;
  outcome.force_hash = model::kFnvStart;
  protocol::LoggedTick tick;
  for (; log->next(tick); ++outcome.ticks) {
    // As a black box: contact, gate and supervisor begin in a state that is not recorded.
    if (outcome.ticks == 0 && tick.tick != 0 && !log->skipped())
      return model::Error{fmt::format(
          "{}: begins at tick {}, in the middle of a run; tact-view --open shows it, --csv writes "
          "its ticks, tactd --record keeps a run from its start",
          path, tick.tick)};
    // They have state, so nothing can be computed after a gap either.
    if (tick.tick != outcome.ticks) {
      outcome.gap_before = tick.tick;
      break;
    }
    if (auto error = variants.use(tick.input.variant, *log, path, controller)) return *error;
    const loop::TickOutput output = controller.tick(tick.input);
    outcome.force_hash = telemetry::hash_wrench(outcome.force_hash, output.written);
    // Bits, so that -0 and NaN count, too.
    if (telemetry::bits_of(output.written) == telemetry::bits_of(tick.output.written) &&
        std::bit_cast<std::uint64_t>(output.written_grip_N) ==
            std::bit_cast<std::uint64_t>(tick.output.written_grip_N))
      continue;
    if (outcome.different++ == 0) outcome.first_different = tick.tick;
  }
  while (log->next(tick)) continue;  // counts the good ticks after a gap
  outcome.damage = log->damage();
  return outcome;
}

}  // namespace tact::firmware::run
