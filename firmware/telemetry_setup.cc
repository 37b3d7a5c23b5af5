#include "firmware/telemetry_setup.h"

#include <fmt/format.h>

namespace tact::firmware {
namespace {

using model::Error;
using model::Result;

std::optional<Error> open_sockets(const RunSetup& run, Outlets& out) {
  std::string path = run.options.socket_path;
  if (path.empty()) {
    auto directory = runtime_directory();
    if (!directory) return directory.error();
    path = *directory + "/telemetry.sock";
  }
  auto meshes = make_mesh_file(run.scene);
  if (!meshes) return meshes.error();
  const bool simulated = hal::is_simulated(run.device);
  const HelloFacts facts{.device = run.device.info(),
                         .force_limit_N = run.gate.force_limit_N(),
                         .continuous_force_N = run.gate.continuous_force_N(),
                         .energy_budget_J = run.gate.energy_budget_J(),
                         .non_rt = run.non_rt,
                         .hand_socket = simulated ? path + ".hand" : ""};
  auto opened = TelemetrySocket::open(path, make_hello(run.scene, run.tissue, facts), *meshes);
  if (!opened) return opened.error();
  out.socket.emplace(std::move(*opened));
  if (!simulated) return std::nullopt;
  auto hand = hal::start_hand_socket(run.device, facts.hand_socket);
  if (!hand) return hand.error();
  out.hand = std::move(*hand);
  return std::nullopt;
}

Result<TickLogWriter> open_log(const RunSetup& run) {
  LogHeader header;
  header.period_ns = run.period_ns;
  header.limits = run.limits;
  header.force_share = run.force_share;
  header.non_rt = run.non_rt ? 1 : 0;
  run.scene.hash.copy(header.scene_hash, sizeof header.scene_hash - 1);
  if (!header.keep_overrides(run.options.overrides))
    return Error{
        fmt::format("{}: has no room for --set values of more than {} letters; write them "
                    "into the scene",
                    run.options.record_path, sizeof header.overrides - 1)};
  return TickLogWriter::create(run.options.record_path, header);
}

}  // namespace

Result<Outlets> open_outlets(const RunSetup& run) {
  Outlets out;
  if (!run.options.no_telemetry)
    if (auto failed = open_sockets(run, out)) return std::move(*failed);
  if (run.options.record_path.empty()) return out;
  auto log = open_log(run);
  if (!log) return log.error();
  out.log.emplace(std::move(*log));
  return out;
}

}  // namespace tact::firmware
