// tactd: the haptic controller.
#include <fmt/format.h>

#include "firmware/replay.h"
#include "firmware/session.h"
#include "model/plan_file.h"
#include "model/scene.h"
#include "model/scene_words.h"

namespace {

using namespace tact;

int complain(const std::string& sentence, int status) {
  fmt::print(stderr, "tactd: {}\n", sentence);
  return status;
}

void print_faults() {
  fmt::print("{:>4}  {:18}  {}\n", "no", "name", "cause; cure");
  for (const model::FaultEntry& f : model::fault_table())
    fmt::print("{:>4}  {:18}  {}; {}\n", static_cast<int>(f.fault), f.name, f.cause, f.cure);
}

int run_replay(const model::Scene& scene, const std::string& path) {
  const auto tissue = model::make_tissue(scene);
  if (!tissue) return complain(tissue.error().sentence, 2);
  const auto outcome = firmware::replay(path, scene, **tissue);
  if (!outcome) return complain(outcome.error().sentence, 2);
  fmt::print("{}: {} ticks computed again, {} differ, force hash {:016x}\n", path, outcome->ticks,
             outcome->different, outcome->force_hash);
  if (outcome->truncated) fmt::print("{}: the last tick is torn and was left out\n", path);
  if (outcome->gap_before != 0)
    return complain(fmt::format("{}: ticks {} to {} are missing, so the replay ends there; record "
                                "to a faster disk",
                                path, outcome->ticks, outcome->gap_before - 1),
                    1);
  if (outcome->different == 0) return 0;
  return complain(fmt::format("{}: the first other force is at tick {}; replay with the build that "
                              "recorded it",
                              path, outcome->first_different),
                  1);
}

/// law = "auto": what tact-plan chose on this machine. The choice counts in the scene's hash, so a
/// recording is never replayed with another law.
std::optional<model::Error> choose_law(model::Scene& scene) {
  if (scene.law != model::LawKind::kAuto) return std::nullopt;
  const auto plan = model::find_plan(scene);
  if (!plan) return plan.error();
  model::use_sizes(plan->sizes, scene);
  const std::string choice = model::text_of(plan->sizes);
  fmt::print(stderr, "tactd: law \"auto\" is {}: p99.9 {:.3g} us, force error {:.1f} %\n", choice,
             plan->tick_p999_us, 100.0 * plan->force_error_ratio);
  model::TextHash hash;
  hash.add(scene.hash);
  hash.add(choice);
  scene.hash = hash.hex();
  return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  const firmware::Parsed parsed = firmware::parse_options(argc, argv);
  if (parsed.leave) return parsed.status;
  const firmware::Options& options = parsed.options;
  if (options.faults) {
    print_faults();
    return 0;
  }
  if (options.help_scene) {
    fmt::print("{}", model::scene_reference());
    return 0;
  }
  auto scene = model::load_scene(options.scene_path, options.overrides);
  if (!scene) return complain(scene.error().sentence, 2);
  if (const auto trouble = choose_law(*scene)) return complain(trouble->sentence, 2);
  if (const auto refusal = model::check_drivable(*scene)) return complain(refusal->sentence, 2);
  if (!options.replay_path.empty()) return run_replay(*scene, options.replay_path);
  return firmware::run_session(*scene, options);
}
