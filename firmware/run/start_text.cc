// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/start_text.h"

#include <fmt/format.h>

#include "firmware/admission/notes.h"
#include "firmware/console/say.h"
#include "firmware/pc/pc_check.h"
#include "firmware/watch/runaway.h"
#include "hal/mounting.h"
#include "hal/registry/open_device.h"
#include "model/scene/accuracy_file.h"
#include "model/time_ns.h"

namespace tact::firmware::run {

std::vector<std::string> start_notes(const model::scene::Scene& scene, const LoopParts& parts,
                                     bool is_check) {
  std::vector<std::string> notes{admission::inertia_note(scene, parts.tissue->law()),
                                 parts.device->info().caution,
                                 admission::grip_note(scene, parts.device->info())};
  if (is_check) {
    notes.push_back(admission::reach_note(scene));
    notes.push_back(admission::open_organ_note(scene));
    notes.push_back(admission::parts_note(scene));
    notes.push_back(admission::torque_note(scene, parts.device->info()));
    if (parts.presses) notes.push_back(parts.presses->note);
  }
  std::erase(notes, std::string());
  return notes;
}

bool wait_for_bus(const model::scene::Scene& scene, const console::OperatorSignals& signals) {
  std::string reported;
  for (;;) {
    const std::string missing = hal::registry::missing_interface(scene.device);
    if (missing.empty()) return true;
    if (reported != missing)
      console::say(stderr, "tactd: waiting for {}: it is not there, or not up; ip link shows it\n",
                   missing);
    reported = missing;
    if (signals.wait_for_end(model::kSecond_ns)) return false;
  }
}

std::string check_lines(const model::scene::Scene& scene, const LoopParts& parts) {
  const model::scene::TissueLaw& law = parts.tissue->law();
  std::string out = fmt::format(
      "{}: sound. {} on {}, {} vertices; law {}, range {:.1f} to {:.1f} mm, stiffness {:.4g} of "
      "{:.4g} N/m",
      scene.path, scene.name, parts.device->info().name, scene.organ_mesh.vertex_m.size(),
      law.title(), 1e3 * law.range().pull_m, 1e3 * law.range().press_m,
      parts.stiffness.needed_N_per_m, parts.stiffness.limit_N_per_m);
  if (const auto& time = parts.time)
    out += fmt::format(", {:.3g} of {:g} us a tick in contact ({}; longest {:.3g}), {} sphere{}",
                       time->checked_us, time->budget_us, time->tail_counts ? "p99.9" : "median",
                       time->measured.longest_us, scene.tool.spheres.size(),
                       scene.tool.spheres.size() == 1 ? "" : "s");
  if (const auto& presses = parts.presses)
    out += fmt::format("\nlargest felt slope {:.4g} N/m at {}, of {} presses of the whole tool{}",
                       presses->slope_N_per_m, presses->place, presses->presses,
                       presses->slope_N_per_m > parts.stiffness.limit_N_per_m
                           ? ": more than the device shows"
                           : "");
  out += "\n" + hal::text_of(hal::mounting_of(scene.device));
  return out + "\n" + model::scene::accuracy_line(scene);
}

void RealTime::enter(const pc::RtSettings& settings) {
  process_.emplace(shortfalls_);
  for (pc::Shortfall& s : watch::lift_time_limits()) shortfalls_.push_back(std::move(s));
  for (pc::Shortfall& s : probe_rt_threads(settings)) shortfalls_.push_back(std::move(s));
}

// The last line is a summary of tact-doctor.
void RealTime::report(const pc::RtSettings& settings) const {
  for (const pc::Shortfall& s : shortfalls_) console::say(stderr, "tactd: {}\n", s.message);
  const std::string red = name_red_rows(pc::check_pc(
      {.files = pc::PcFiles{}, .usb = hal::registry::usb_parts(), .core = choose_core(settings)}));
  if (!red.empty()) console::say(stderr, "tactd: {}\n", red);
}

}  // namespace tact::firmware::run
