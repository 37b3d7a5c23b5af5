// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/telemetry_setup.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include "firmware/admission/notes.h"
#include "firmware/pc/environment.h"
#include "firmware/protocol/run_file.h"
#include "firmware/telemetry/utc_clock.h"
#include "hal/monotonic.h"
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

/// The head of a run: scene, device, the limits in use on this PC, and date.
protocol::RunHeader header_of(const RunSetup& run, const protocol::UtcOffset& utc) {
  protocol::RunHeader header = telemetry::header_of(run.scene, *run.parts.tissue);
  const gate::Gate& gate = run.parts.controller->gate();
  const hal::DeviceInfo device = run.parts.device->info();
  header.overrides = run.options.overrides;
  header.device_name = device.name;
  header.revision = pc::read_environment(run.scene.hash).git_revision;
  utsname pc_name{};
  uname(&pc_name);
  header.host_name = pc_name.nodename;
  // Simulated time begins at 0.
  header.began_monotonic_ns = run.options.free_run ? 0 : hal::monotonic_ns();
  header.began_utc = telemetry::date_of(header.began_monotonic_ns + utc.offset_ns);
  header.utc_max_error_us = utc.max_error_us;
  header.utc_error_us = utc.error_us;
  header.limits = run.parts.limits;
  header.force_share = run.force_share;
  header.force_limit_N = gate.force_limit_N();
  header.torque_limit_Nm = gate.torque_limit_Nm();
  header.continuous_force_N = gate.continuous_force_N();
  header.energy_budget_J = gate.energy_budget_J();
  header.limits_checksum = run.parts.limits_checksum;
  header.non_rt = run.non_rt;
  header.simulated = hal::registry::is_simulated(*run.parts.device);
  header.joints = hal::registry::joints_of(run.scene.device);
  header.cannot_grip = admission::cannot_grip(run.scene, device);
  return header;
}

std::optional<Error> open_sockets(const RunSetup& run, protocol::RunHeader header,
                                  std::span<const std::byte> meshes, Sinks& out) {
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
  const std::string hand_path = header.simulated ? *path + ".hand" : "";
  header.hand_socket = hand_path;
  out.sinks.frame_fields = protocol::Frame::fields(header.spheres.size());
  const auto start = telemetry::make_memory_file(
      start_of_run(header, meshes, {protocol::schema_of<protocol::Frame>(out.sinks.frame_fields)}));
  if (!start) return start.error();
  auto opened = telemetry::TelemetrySocket::open(*path, *start, viewers);
  if (!opened) return opened.error();
  out.sinks.socket.emplace(std::move(*opened));
  if (hand_path.empty()) return std::nullopt;
  auto hand = hal::registry::start_hand_socket(*run.parts.device, hand_path);
  if (!hand) return hand.error();
  out.hand = std::move(*hand);
  return viewers ? model::io::share_socket(hand_path, *viewers) : std::nullopt;
}

}  // namespace

Result<Sinks> open_sinks(const RunSetup& run) {
  Sinks out;
  out.utc = telemetry::read_utc_offset();
  if (run.options.free_run) out.utc.offset_ns += hal::monotonic_ns();
  const protocol::RunHeader header = header_of(run, out.utc);
  const std::vector<std::byte> meshes = telemetry::mesh_bytes(run.scene);
  if (!run.options.no_telemetry)
    if (auto failed = open_sockets(run, header, meshes, out)) return std::move(*failed);
  if (!run.options.record_path.empty()) {
    out.sinks.tick_fields = protocol::LoggedTick::fields(header.spheres.size());
    auto log = protocol::RunWriter::create(
        run.options.record_path,
        start_of_run(header, {},
                     {protocol::schema_of<protocol::LoggedTick>(out.sinks.tick_fields)}),
        protocol::kMaxRecord_bytes);
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
  auto black_box = black_box::BlackBox::make({*folder, header, meshes}, run.scene.rate_Hz,
                                             run.scene.frame_rate_Hz);
  if (!black_box) return black_box.error();
  out.black_box = std::move(*black_box);
  out.sinks.recorder = out.black_box.get();
  if (run.options.free_run) return out;  // the PC's time is not the run's
  auto history = telemetry::YearHistory::open(*folder + "/year.tacthistory");
  if (history)
    out.sinks.history.emplace(std::move(*history));
  else
    out.no_black_box = history.error().message;
  return out;
}

}  // namespace tact::firmware::run
