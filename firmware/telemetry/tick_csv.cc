// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/tick_csv.h"

#include <fmt/format.h>

#include <cstring>
#include <initializer_list>
#include <iterator>

#include "firmware/loop/state.h"
#include "model/io/file_writer.h"
#include "model/io/one_line.h"

namespace tact::firmware::telemetry {
namespace {

using model::Vec3;

/// A field of the header, with or without a terminating zero.
template <std::size_t n>
std::string text_of(const char (&field)[n]) {
  return model::io::on_one_line({field, strnlen(field, n)});
}

void put(std::string& out, const Vec3& v) {
  fmt::format_to(std::back_inserter(out), ",{},{},{}", v.x, v.y, v.z);
}

}  // namespace

std::string tick_csv_head(const LogHeader& header) {
  std::string out = fmt::format(
      "# tact ticks\n# scene: {}\n# scene_hash: {}\n# law: {}\n# revision: {}\n# began: {}\n"
      "# host: {}\n# rate_Hz: {:.10g}\n",
      text_of(header.scene_name), text_of(header.scene_hash), text_of(header.law),
      text_of(header.revision), text_of(header.began_utc), text_of(header.host),
      header.period_ns > 0 ? 1e9 / static_cast<double>(header.period_ns) : 0.0);
  out +=
      "tick,time_s,non_rt,state,fault,limit,acted,skipped_periods,fresh,"
      "tool_x_m,tool_y_m,tool_z_m,tool_qw,tool_qx,tool_qy,tool_qz,"
      "tool_vx_mps,tool_vy_mps,tool_vz_mps,tool_wx_radps,tool_wy_radps,tool_wz_radps,grip_ratio,"
      "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,"
      "wanted_x_N,wanted_y_N,wanted_z_N,wanted_x_Nm,wanted_y_Nm,wanted_z_Nm,"
      "rms_force_N,given_energy_J,contact_losses,wanted_grip_N,grip_N,clutches,margin_us";
  // From the table of phase names, so that columns and record agree.
  for (const char* phase : loop::kPhaseName)
    fmt::format_to(std::back_inserter(out), ",{}_us", phase);
  return out + '\n';
}

std::string tick_csv_row(const LoggedTick& tick) {
  const model::Tool& tool = tick.input.sample.tool;
  const loop::TickOutput& o = tick.output;
  std::string out = fmt::format(
      "{},{:.9f},{},{},{},{},{},{},{}", tick.tick, static_cast<double>(tick.due_ns) * 1e-9,
      tick.non_rt, loop::name_of(o.state), static_cast<int>(o.fault), static_cast<int>(o.limit),
      model::describe(o.limit).name, tick.input.skipped_periods, tick.input.sample.fresh ? 1 : 0);
  put(out, tool.position_m);
  fmt::format_to(std::back_inserter(out), ",{},{},{},{}", tool.orientation.w, tool.orientation.x,
                 tool.orientation.y, tool.orientation.z);
  put(out, tool.velocity_mps);
  put(out, tool.angular_velocity_radps);
  fmt::format_to(std::back_inserter(out), ",{}", tool.grip_ratio);
  for (const Vec3& v :
       {o.written.force_N, o.written.torque_Nm, o.wanted.force_N, o.wanted.torque_Nm})
    put(out, v);
  fmt::format_to(std::back_inserter(out), ",{},{},{},{},{},{},{:.3f}", o.rms_force_N,
                 o.given_energy_J, o.contact_losses, o.wanted_grip_N, o.written_grip_N,
                 tick.input.clutches, 1e-3 * static_cast<double>(tick.margin_ns));
  for (const std::int32_t ns : tick.phase_ns)
    fmt::format_to(std::back_inserter(out), ",{:.3f}", 1e-3 * static_cast<double>(ns));
  return out + '\n';
}

model::Result<std::string> write_tick_csv(const std::string& log_path,
                                          const std::string& csv_path) {
  auto log = TickLogReader::open(log_path);
  if (!log) return log.error();
  const std::string head = tick_csv_head(log->header());
  // Only after the log was opened: an unreadable log leaves an older table unchanged.
  auto out = model::io::FileWriter::replace(csv_path, head);
  if (!out) return out.error();
  if (auto error = out->put(head)) return *error;
  // Damaged ticks are left out, so their numbers are missing in the first column.
  for (LoggedTick tick; log->next(tick);)
    if (auto error = out->put(tick_csv_row(tick))) return *error;
  if (auto error = out->finish()) return *error;
  return log->damage();
}

}  // namespace tact::firmware::telemetry
