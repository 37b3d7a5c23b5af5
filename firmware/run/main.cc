// SPDX-License-Identifier: Apache-2.0
// tactd: the haptic controller.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "firmware/admission/refusals.h"
#include "firmware/console/operator_signals.h"
#include "firmware/console/say.h"
#include "firmware/console/service_manager.h"
#include "firmware/loop/state.h"
#include "firmware/run/lists.h"
#include "firmware/run/replay.h"
#include "firmware/run/session.h"
#include "firmware/telemetry/tick_csv.h"
#include "hal/registry/open_device.h"
#include "model/io/file_writer.h"
#include "model/io/json.h"
#include "model/io/program/program_end.h"
#include "model/scene/plan_file.h"
#include "model/scene/scene.h"

namespace {

using namespace tact;
using firmware::console::say;

int complain(const std::string& message, int status) {
  say(stderr, "tactd: {}\n", message);
  return status;
}

void print_fault_lines() {
  say(stdout, "{:>4}  {:18}  {}\n", "no", "name", "cause; remedy");
  for (const model::FaultEntry& f : model::fault_table())
    say(stdout, "{:>4}  {:18}  {}; {}\n", static_cast<int>(f.fault), f.name, f.cause, f.remedy);
}

/// Texts for the page: {"faults": [...], "states": [...]}, states by number.
std::string faults_as_json() {
  nlohmann::json list = nlohmann::json::array(), states = nlohmann::json::array();
  for (const model::FaultEntry& f : model::fault_table())
    list.push_back({{"number", static_cast<int>(f.fault)},
                    {"name", f.name},
                    {"cause", f.cause},
                    {"remedy", f.remedy},
                    {"latches", model::latches(f.fault)}});
  for (const auto& s : firmware::loop::kStateTable)
    states.push_back({{"name", s.name}, {"words", s.words}});
  return model::io::text_of(
             nlohmann::json{
                 {"format", "tactd-faults"}, {"version", 1}, {"faults", list}, {"states", states}},
             2) +
         "\n";
}

/// Writes a list to the path of --json; does nothing without a path.
int write_json(const std::string& path, const std::string& json) {
  if (path.empty()) return 0;
  if (path == "-")
    say(stdout, "{}", json);
  else if (const auto error = model::io::write_file(path, json))
    return complain(error->message, 2);
  return 0;
}

int print_faults(const std::string& json_path) {
  if (json_path != "-") print_fault_lines();
  return write_json(json_path, faults_as_json());
}

int print_devices(const std::string& json_path) {
  const auto looked_for = hal::registry::usb_parts();
  const auto parts = hal::list::list_devices(hal::list::system_probes(looked_for));
  if (json_path != "-") say(stdout, "{}", firmware::run::devices_as_text(parts, looked_for));
  return write_json(json_path, firmware::run::devices_as_json(parts));
}

int print_parameters(const model::scene::Scene& scene, const firmware::run::Options& options) {
  if (options.json_path != "-") say(stdout, "{}", firmware::run::parameters_as_text(scene));
  return write_json(options.json_path, firmware::run::parameters_as_json(scene));
}

/// Exit status 0 only if all forces have equal bits and no tick is missing or damaged.
int run_replay(const model::scene::Scene& scene, const std::string& path) {
  const auto tissue = model::scene::make_tissue(scene);
  if (!tissue) return complain(tissue.error().message, 2);
  const auto outcome = firmware::run::replay(path, scene, **tissue);
  if (!outcome) return complain(outcome.error().message, 2);
  say(stdout, "{}: {} ticks computed again, {} differ, force hash {:016x}\n", path, outcome->ticks,
      outcome->different, outcome->force_hash);
  if (!outcome->damage.empty())
    return complain(fmt::format("{}: {}; what came before was compared", path, outcome->damage), 1);
  // In this order, because damage explains a gap, and a gap a difference.
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

/// The --set values of a recorded run, used for its replay unless the command line has some.
model::Result<std::vector<std::string>> recorded_overrides(const std::string& path) {
  const auto log = firmware::protocol::TickLog::open(path);
  if (!log) return log.error();
  return log->header().overrides;
}

/// The scene to run. law = "auto" is replaced by the choice of tact-lab plan on this machine, or of
/// the scene's accuracy file, as --set values; a tick log keeps them, so its replay needs no plan.
model::Result<model::scene::Scene> load(firmware::run::Options& options) {
  if (!options.replay_path.empty() && options.overrides.empty()) {
    auto recorded = recorded_overrides(options.replay_path);
    if (!recorded) return recorded.error();
    options.overrides = std::move(*recorded);
  }
  auto scene = hal::registry::load_scene(options.scene_path, options.overrides);
  if (!scene || scene->law != model::scene::kAutoLaw) return scene;
  const auto plan = model::scene::find_auto_law(*scene, options.overrides);
  if (!plan) return plan.error();
  const auto choice = model::scene::overrides_of(plan->sizes);
  const std::string time = plan->machine.empty()
                               ? "no plan of this machine, by the accuracy file"
                               : fmt::format("p99.9 {:.3g} us", plan->tick_p999_us);
  say(stderr, "tactd: law \"auto\" is{}: {}, force error {:.1f} %\n",
      model::scene::command_text(choice), time, 100.0 * plan->force_error_ratio);
  // Appended last, so that the plan's law overrides law=auto.
  options.overrides.insert(options.overrides.end(), choice.begin(), choice.end());
  return hal::registry::load_scene(options.scene_path, options.overrides);
}

int run(int argc, char** argv) {
  // Both before anything is printed and before any thread starts.
  model::io::watch_standard_output("tactd");
  firmware::console::ignore_other_signals();
  firmware::run::Parsed parsed = firmware::run::parse_options(argc, argv);
  if (parsed.leave) return parsed.status;
  firmware::run::Options& options = parsed.options;
  if (options.faults) return print_faults(options.json_path);
  if (options.list_devices) return print_devices(options.json_path);
  if (options.cite) {
    say(stdout, "{}", firmware::run::citation());
    return 0;
  }
  if (options.help_scene) {
    say(stdout, "{}", model::scene::scene_reference(hal::registry::visit_device));
    return 0;
  }
  // A table of a log needs no scene; only a replay does.
  if (!options.csv_path.empty()) {
    const auto damage = firmware::telemetry::write_tick_csv(options.replay_path, options.csv_path);
    if (!damage) return complain(damage.error().message, 2);
    if (!damage->empty()) return complain(options.replay_path + ": " + *damage, 1);
    if (options.scene_path.empty()) return 0;
  }
  auto scene = load(options);
  if (!scene) return complain(scene.error().message, 2);
  if (options.parameters) return print_parameters(*scene, options);
  // Only from the command line, so that no scene can name a library and declare it trusted.
  scene->device.trust_library = options.trust_library;
  if (options.no_device && !hal::registry::is_simulated(scene->device)) {
    say(stderr,
        "tactd: {} and lines are not opened, a simulated delta replaces them: check again "
        "where they are plugged in\n",
        scene->device.kind);
    scene->device.kind = "sim-delta";
    scene->device.of<hal::LinesSettings>() = {};
  }
  if (!scene->note.empty()) say(stderr, "tactd: {}\n", scene->note);
  if (!options.replay_path.empty()) return run_replay(*scene, options.replay_path);
  if (const auto refused =
          firmware::admission::why_not_unattended(*scene, firmware::console::is_service()))
    return complain(options.scene_path + ": " + refused->message, 2);
  return firmware::run::run_session(*scene, options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {  // the device was closed on the way here
    std::fprintf(stderr, "tactd: %s\n", error.what());
    return 2;
  }
}
