// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/telemetry_setup.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <ctime>

#include "firmware/admission/notes.h"
#include "firmware/pc/environment.h"
#include "model/io/socket_file.h"

namespace tact::firmware::run {
namespace {

using model::Error;
using model::Result;

/// As --socket says, or in the folder that only this user can open.
Result<std::string> socket_path(const RunSetup& run) {
  if (!run.options.socket_path.empty()) return run.options.socket_path;
  auto directory = model::io::runtime_directory();
  if (!directory) return directory.error();
  return *directory + "/telemetry.sock";
}

/// The first message to a viewer, with the limits in use on this PC.
telemetry::Hello hello_of(const RunSetup& run, const std::string& hand_path) {
  const gate::Gate& gate = run.parts.controller->gate();
  const telemetry::HelloFacts facts{
      .device = run.parts.device->info(),
      .force_limit_N = gate.force_limit_N(),
      .torque_limit_Nm = gate.torque_limit_Nm(),
      .continuous_force_N = gate.continuous_force_N(),
      .energy_budget_J = gate.energy_budget_J(),
      .limits_checksum = run.parts.limits_checksum,
      .non_rt = run.non_rt,
      .cannot_grip = admission::cannot_grip(run.scene, run.parts.device->info()),
      .hand_socket = hand_path};
  return make_hello(run.scene, *run.parts.tissue, facts);
}

/// Takes ownership of `meshes`.
std::optional<Error> open_sockets(const RunSetup& run, int meshes, Sinks& out) {
  const auto path = socket_path(run);
  if (!path) return path.error();
  std::optional<gid_t> viewers;
  // Before a socket is created: an unknown group then leaves no file.
  if (!run.options.viewers.empty()) {
    const auto group = model::io::find_group(run.options.viewers);
    if (!group) return Error{"--viewers " + group.error().message};
    viewers = *group;
  }
  // Only for a simulated device: no program may move the hand of hardware.
  const std::string hand_path =
      hal::registry::is_simulated(*run.parts.device) ? *path + ".hand" : "";
  auto opened = telemetry::TelemetrySocket::open(*path, hello_of(run, hand_path), meshes, viewers);
  if (!opened) return opened.error();
  out.sinks.socket.emplace(std::move(*opened));
  if (hand_path.empty()) return std::nullopt;
  auto hand = hal::registry::start_hand_socket(*run.parts.device, hand_path);
  if (!hand) return hand.error();
  out.hand = std::move(*hand);
  return viewers ? model::io::share_socket(hand_path, *viewers) : std::nullopt;
}

/// False if the --set values are too long for the header.
bool fill_header(const RunSetup& run, telemetry::LogHeader& header) {
  header.period_ns = run.period_ns;
  header.limits = run.parts.limits;
  header.force_share = run.force_share;
  header.non_rt = run.non_rt ? 1 : 0;
  const auto keep = [](const std::string& text, auto& field) {
    text.copy(field, sizeof field - 1);
  };
  const pc::Environment environment = pc::read_environment(run.scene.hash);
  utsname pc_name{};
  uname(&pc_name);
  keep(run.scene.hash, header.scene_hash);
  keep(run.scene.name, header.scene_name);
  keep(run.parts.tissue->law().title(), header.law);
  keep(environment.git_revision, header.revision);
  keep(pc_name.nodename, header.host);
  keep(fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))), header.began_utc);
  // Last, so that the rest of the header is filled if this fails: a black box does without them.
  return header.keep_overrides(run.options.overrides);
}

Result<telemetry::TickLogWriter> open_log(const RunSetup& run) {
  telemetry::LogHeader header;
  if (!fill_header(run, header))
    return Error{
        fmt::format("{}: has no room for --set values of more than {} letters; write them "
                    "into the scene",
                    run.options.record_path, sizeof header.overrides - 1)};
  return telemetry::TickLogWriter::create(run.options.record_path, header);
}

/// Takes ownership of `meshes`.
std::unique_ptr<black_box::BlackBox> make_black_box(const RunSetup& run, const std::string& folder,
                                                    int meshes) {
  black_box::BlackBoxRun facts{.folder = folder,
                               .scene_name = run.scene.name,
                               .header = {},
                               .hello = hello_of(run, ""),
                               .mesh_fd = meshes};
  fill_header(run, facts.header);  // --set values that are too long are left out: no replay here
  return std::make_unique<black_box::BlackBox>(std::move(facts), run.scene.rate_Hz,
                                               run.scene.frame_rate_Hz);
}

}  // namespace

Result<Sinks> open_sinks(const RunSetup& run) {
  Sinks out;
  if (!run.options.no_telemetry) {
    const auto meshes = telemetry::make_mesh_file(run.scene);
    if (!meshes) return meshes.error();
    if (auto failed = open_sockets(run, *meshes, out)) return std::move(*failed);
  }
  if (!run.options.record_path.empty()) {
    auto log = open_log(run);
    if (!log) return log.error();
    out.sinks.log.emplace(std::move(*log));
  }
  if (run.options.no_black_box) return out;
  const auto folder = black_box::black_box_folder(run.options.black_box_folder);
  // A folder named by --black-box must work; without the default folder there is only a message.
  if (!folder && !run.options.black_box_folder.empty()) return folder.error();
  if (!folder) {
    out.no_black_box = folder.error().message;
    return out;
  }
  // A separate memory file, because socket and black box each close their own.
  const auto meshes = telemetry::make_mesh_file(run.scene);
  if (!meshes) return meshes.error();
  out.black_box = make_black_box(run, *folder, *meshes);
  out.sinks.recorder = out.black_box.get();
  return out;
}

}  // namespace tact::firmware::run
