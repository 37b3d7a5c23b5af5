// SPDX-License-Identifier: Apache-2.0
// host/PROTOCOL.md says what the structs are.
#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "firmware/telemetry/tick_log.h"
#include "hal/sim/hand_target.h"

#pragma GCC diagnostic ignored "-Winvalid-offsetof"  // LogHeader has a base; g++ and clang know it

namespace tact::firmware::telemetry::protocol_test {

/// "field offset bytes", as the document says and as the compiler does.
using Layout = std::set<std::string>;

std::string row(const std::string& field, std::size_t offset, std::size_t bytes) {
  return field + " at " + std::to_string(offset) + ", " + std::to_string(bytes) + " bytes";
}

#define FIELD(type, field) row(#field, offsetof(type, field), sizeof(std::declval<type&>().field))

const std::map<std::string, Layout> kStructs{
    {"MessageHeader",
     {row("MessageHeader", 0, sizeof(MessageHeader)), FIELD(MessageHeader, magic),
      FIELD(MessageHeader, version), FIELD(MessageHeader, kind)}},
    {"Hello",
     {row("Hello", 0, sizeof(Hello)),
      FIELD(Hello, header),
      FIELD(Hello, organ_vertices),
      FIELD(Hello, organ_triangles),
      FIELD(Hello, tool_vertices),
      FIELD(Hello, tool_triangles),
      FIELD(Hello, site_count),
      FIELD(Hello, ring_count),
      FIELD(Hello, ring_pitch_m),
      FIELD(Hello, rate_Hz),
      FIELD(Hello, frame_rate_Hz),
      FIELD(Hello, force_limit_N),
      FIELD(Hello, continuous_force_N),
      FIELD(Hello, energy_budget_J),
      FIELD(Hello, sphere_radius_m),
      FIELD(Hello, sphere_offset_m),
      FIELD(Hello, non_rt),
      FIELD(Hello, simulated),
      FIELD(Hello, scene_name),
      FIELD(Hello, torque_limit_mNm),
      FIELD(Hello, cannot_grip),
      FIELD(Hello, limits_checksum),
      FIELD(Hello, device_name),
      FIELD(Hello, law_name),
      FIELD(Hello, hand_socket),
      FIELD(Hello, organ_material),
      FIELD(Hello, tool_material),
      FIELD(Hello, piece_count),
      FIELD(Hello, piece_color_ratio)}},
    {"FrameSite",
     {row("FrameSite", 0, sizeof(FrameSite)), FIELD(FrameSite, surface_point_m),
      FIELD(FrameSite, normal), FIELD(FrameSite, shift_m), FIELD(FrameSite, depth_m),
      FIELD(FrameSite, profile_m), FIELD(FrameSite, tilt), FIELD(FrameSite, state),
      FIELD(FrameSite, pad)}},
    {"FramePatch",
     {row("FramePatch", 0, sizeof(FramePatch)), FIELD(FramePatch, vertex_count),
      FIELD(FramePatch, cut_total), FIELD(FramePatch, cut_first), FIELD(FramePatch, cut_count),
      FIELD(FramePatch, vertex), FIELD(FramePatch, cut_triangle),
      FIELD(FramePatch, displacement_um)}},
    {"Frame",
     {row("Frame", 0, sizeof(Frame)),
      FIELD(Frame, header),
      FIELD(Frame, tick),
      FIELD(Frame, time_ns),
      FIELD(Frame, late_ticks),
      FIELD(Frame, skipped_ticks),
      FIELD(Frame, dropped_records),
      FIELD(Frame, tool_position_m),
      FIELD(Frame, tool_orientation),
      FIELD(Frame, tool_velocity_mps),
      FIELD(Frame, grip_ratio),
      FIELD(Frame, force_N),
      FIELD(Frame, torque_Nm),
      FIELD(Frame, wanted_force_N),
      FIELD(Frame, worst_margin_us),
      FIELD(Frame, median_tick_us),
      FIELD(Frame, peak_force_N),
      FIELD(Frame, rms_force_N),
      FIELD(Frame, given_energy_J),
      FIELD(Frame, fault),
      FIELD(Frame, limit),
      FIELD(Frame, state),
      FIELD(Frame, non_rt),
      FIELD(Frame, grip_force_mN),
      FIELD(Frame, contact_losses),
      FIELD(Frame, site),
      FIELD(Frame, patch)}},
    {"FileHeader",
     {row("FileHeader", 0, sizeof(FileHeader)), FIELD(FileHeader, magic),
      FIELD(FileHeader, version), FIELD(FileHeader, hello_bytes), FIELD(FileHeader, frame_bytes),
      FIELD(FileHeader, setup_crc), FIELD(FileHeader, mesh_bytes)}},
    {"FrameRecord",
     {row("FrameRecord", 0, sizeof(FrameRecord)), FIELD(FrameRecord, frame),
      FIELD(FrameRecord, crc), FIELD(FrameRecord, pad)}},
    {"LogHeader",
     {row("LogHeader", 0, sizeof(LogHeader)), FIELD(LogHeader, magic),
      FIELD(LogHeader, header_bytes), FIELD(LogHeader, tick_bytes), FIELD(LogHeader, ticks),
      FIELD(LogHeader, period_ns), FIELD(LogHeader, limits), FIELD(LogHeader, force_share),
      FIELD(LogHeader, non_rt), FIELD(LogHeader, scene_hash), FIELD(LogHeader, overrides),
      FIELD(LogHeader, scene_name), FIELD(LogHeader, law), FIELD(LogHeader, revision),
      FIELD(LogHeader, host), FIELD(LogHeader, began_utc), FIELD(LogHeader, header_crc),
      FIELD(LogHeader, pad)}},
    {"LoggedTick",
     {row("LoggedTick", 0, sizeof(LoggedTick)),
      FIELD(LoggedTick, tick),
      FIELD(LoggedTick, non_rt),
      FIELD(LoggedTick, due_ns),
      FIELD(LoggedTick, margin_ns),
      FIELD(LoggedTick, phase_ns),
      FIELD(LoggedTick, input.sample.tool.position_m),
      FIELD(LoggedTick, input.sample.tool.orientation),
      FIELD(LoggedTick, input.sample.tool.velocity_mps),
      FIELD(LoggedTick, input.sample.tool.angular_velocity_radps),
      FIELD(LoggedTick, input.sample.tool.grip_ratio),
      FIELD(LoggedTick, input.sample.grip_gap_m),
      FIELD(LoggedTick, input.sample.grip_speed_mps),
      FIELD(LoggedTick, input.sample.stamp_ns),
      FIELD(LoggedTick, input.sample.sequence),
      FIELD(LoggedTick, input.sample.fresh),
      FIELD(LoggedTick, input.device_fault),
      FIELD(LoggedTick, input.commands.arm),
      FIELD(LoggedTick, input.commands.stop),
      FIELD(LoggedTick, input.commands.reset),
      FIELD(LoggedTick, input.commands.disarm),
      FIELD(LoggedTick, input.ready),
      FIELD(LoggedTick, input.clutch),
      FIELD(LoggedTick, input.skipped_periods),
      FIELD(LoggedTick, input.clutches),
      FIELD(LoggedTick, input.clutch_shift_m),
      FIELD(LoggedTick, output.wanted.force_N),
      FIELD(LoggedTick, output.wanted.torque_Nm),
      FIELD(LoggedTick, output.written.force_N),
      FIELD(LoggedTick, output.written.torque_Nm),
      FIELD(LoggedTick, output.state),
      FIELD(LoggedTick, output.limit),
      FIELD(LoggedTick, output.fault),
      FIELD(LoggedTick, output.given_energy_J),
      FIELD(LoggedTick, output.rms_force_N),
      FIELD(LoggedTick, output.contact_losses),
      FIELD(LoggedTick, output.wanted_grip_N),
      FIELD(LoggedTick, output.written_grip_N)}},
    {"LogRecord",
     {row("LogRecord", 0, sizeof(LogRecord)), FIELD(LogRecord, tick), FIELD(LogRecord, crc),
      FIELD(LogRecord, pad)}},
    {"HandTarget",
     {row("HandTarget", 0, sizeof(hal::sim::HandTarget)), FIELD(hal::sim::HandTarget, magic),
      FIELD(hal::sim::HandTarget, version), FIELD(hal::sim::HandTarget, pad),
      FIELD(hal::sim::HandTarget, position_m), FIELD(hal::sim::HandTarget, rotation_rad),
      FIELD(hal::sim::HandTarget, grip_ratio)}},
};

#undef FIELD

std::size_t bytes_of(const std::string& type) {
  static const std::map<std::string, std::size_t> kScalars{
      {"char", 1}, {"u8", 1},  {"u16", 2}, {"i16", 2}, {"u32", 4},
      {"i32", 4},  {"f32", 4}, {"u64", 8}, {"i64", 8}, {"f64", 8}};
  static const std::map<std::string, std::size_t> kOurs{{"MessageHeader", sizeof(MessageHeader)},
                                                        {"FrameSite", sizeof(FrameSite)},
                                                        {"FramePatch", sizeof(FramePatch)},
                                                        {"Frame", sizeof(Frame)},
                                                        {"LoggedTick", sizeof(LoggedTick)}};
  const std::string word = type.substr(0, type.find('['));
  std::size_t bytes = kScalars.contains(word) ? kScalars.at(word) : kOurs.at(word);
  static const std::regex kCount(R"(\[(\d+)\])");
  for (std::sregex_iterator i(type.begin(), type.end(), kCount), end; i != end; ++i)
    bytes *= std::stoul((*i)[1]);
  return bytes;
}

std::map<std::string, Layout> reported_structs() {
  static const std::regex kHead(R"(### (\w+), (\d+) bytes)");
  static const std::regex kRow(R"(\| `([\w.]+)` \| (\d+) \| `([\w\[\]]+)` \|.*)");
  std::ifstream file(TACT_SOURCE_DIR "/host/PROTOCOL.md");
  std::map<std::string, Layout> out;
  std::string line, name;
  for (std::smatch m; std::getline(file, line);) {
    if (line.starts_with("#")) name.clear();
    if (std::regex_match(line, m, kHead)) {
      name = m[1];
      out[name].insert(row(name, 0, std::stoul(m[2])));
    } else if (!name.empty() && std::regex_match(line, m, kRow)) {
      out[name].insert(row(m[1], std::stoul(m[2]), bytes_of(m[3])));
    }
  }
  return out;
}

TEST(Protocol, TheDocumentHasTheFieldsOfEachStructWhereTheyAre) {
  const auto reported = reported_structs();
  EXPECT_EQ(reported.size(), kStructs.size());
  for (const auto& [name, layout] : kStructs) {
    ASSERT_TRUE(reported.contains(name)) << name;
    EXPECT_EQ(reported.at(name), layout) << name;
  }
}

TEST(Protocol, TheDocumentHasTheVersions) {
  std::ifstream file(TACT_SOURCE_DIR "/host/PROTOCOL.md");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string log(kLogMagic, sizeof kLogMagic);
  for (const std::string& reported :
       {"| `version` | 4 | `u16` | " + std::to_string(kTelemetryVersion) + " |",
        "| " + std::to_string(kRecordingVersion) + ", or " +
            std::to_string(kTrackedRecordingVersion) + " with the tracked operator |",
        "`" + log + "`"})
    EXPECT_NE(text.find(reported), std::string::npos) << reported;
}

}  // namespace tact::firmware::telemetry::protocol_test
