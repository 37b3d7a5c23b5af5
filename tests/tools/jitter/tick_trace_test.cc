// SPDX-License-Identifier: Apache-2.0
// The trace of tact-jitter, read by Google's own protoc: what ui.perfetto.dev is given.
#include "tools/jitter/trace/tick_trace.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "tests/support/program.h"
#include "tools/program/run_program.h"

namespace tact::tools::jitter::tick_trace_test {

using firmware::loop::Phase;

/// One packet as protoc prints it: "track_event.type" -> "TYPE_SLICE_BEGIN".
using Packet = std::map<std::string, std::string>;

std::vector<Packet> decode(const std::string& path) {
  const auto text = tests::run_command(std::string("protoc --proto_path=") + TACT_SOURCE_DIR +
                                       "/tests/data --decode=Trace track_event.proto <" + path);
  EXPECT_EQ(text.status, 0) << text.output;
  std::vector<Packet> packets;
  std::vector<std::string> inside;
  std::istringstream lines(text.output);
  for (std::string line; std::getline(lines, line);) {
    line.erase(0, line.find_first_not_of(' '));
    if (line == "}") {
      inside.pop_back();
    } else if (line.ends_with(" {")) {
      inside.push_back(line.substr(0, line.size() - 2));
      if (inside.size() == 1) packets.emplace_back();
    } else {
      const auto colon = line.find(": ");
      EXPECT_NE(colon, std::string::npos) << line << ": a field that the schema does not know";
      std::string key;
      for (std::size_t i = 1; i < inside.size(); ++i) key += inside[i] + ".";
      packets.back()[key + line.substr(0, colon)] = line.substr(colon + 2);
    }
  }
  return packets;
}

class PerfettoTraceFile : public testing::Test {
 protected:
  std::vector<Packet> written_and_decoded(const std::vector<TickTimes>& ticks) const {
    const std::string path = scratch.file("ticks.perfetto-trace");
    std::ofstream(path, std::ios::binary) << make_tick_trace(ticks, 1'000);
    return decode(path);
  }
  program::ScratchFolder scratch = std::move(*program::ScratchFolder::make("tact-perfetto-test"));
};

TickTimes tick_at(std::uint64_t tick, std::int64_t due_ns, std::uint32_t skipped = 0) {
  return {.tick = tick,
          .due_ns = due_ns,
          .skipped_before = skipped,
          .phase_ns = {5'000, 300, 200, 100, 150, 80, 60, 5'890}};
}

TEST_F(PerfettoTraceFile, EverySliceEndsInItsTrackInOrderOfTime) {
  const auto packets =
      written_and_decoded({tick_at(1, 1'000'000), tick_at(2, 2'000'000), tick_at(5, 5'000'000, 2)});
  std::map<std::string, int> depth;
  std::map<std::string, std::uint64_t> newest_ns;
  std::map<std::string, int> types;
  for (const Packet& packet : packets) {
    EXPECT_EQ(packet.at("trusted_packet_sequence_id"), "1");
    if (!packet.contains("track_event.type")) continue;
    const std::string &type = packet.at("track_event.type"),
                      &track = packet.at("track_event.track_uuid");
    ++types[type];
    const std::uint64_t time_ns = std::stoull(packet.at("timestamp"));
    EXPECT_GE(time_ns, newest_ns[track]) << type;
    newest_ns[track] = time_ns;
    depth[track] += type == "TYPE_SLICE_BEGIN" ? 1 : type == "TYPE_SLICE_END" ? -1 : 0;
    EXPECT_GE(depth[track], 0) << "an end without a beginning";
    EXPECT_LE(depth[track], 2) << "phases lie in their tick";
  }
  for (const auto& [track, open] : depth) EXPECT_EQ(open, 0) << "track " << track;
  // A wake-up, a tick and six phases each.
  EXPECT_EQ(types["TYPE_SLICE_BEGIN"], 3 * 8);
  EXPECT_EQ(types["TYPE_SLICE_END"], 3 * 8);
  EXPECT_EQ(types["TYPE_COUNTER"], 3);
  EXPECT_EQ(types["TYPE_INSTANT"], 1) << "the points of the grid that a late tick skipped";
}

TEST_F(PerfettoTraceFile, TracksAreNamedBelowOneProcess) {
  const auto packets = written_and_decoded({tick_at(7, 7'000'000)});
  std::map<std::string, std::string> name_of, parent_of;
  for (const Packet& packet : packets) {
    if (!packet.contains("track_descriptor.uuid")) continue;
    const std::string& uuid = packet.at("track_descriptor.uuid");
    if (packet.contains("track_descriptor.process.process_name")) {
      EXPECT_EQ(packet.at("track_descriptor.process.process_name"), "\"tact-jitter\"");
      name_of[uuid] = "process";
    } else {
      name_of[uuid] = packet.at("track_descriptor.name");
      parent_of[uuid] = packet.at("track_descriptor.parent_uuid");
    }
    const auto unit = packet.find("track_descriptor.counter.unit_name");
    EXPECT_TRUE(unit == packet.end() || unit->second == "\"ns\"");
  }
  EXPECT_EQ(name_of.size(), 4u) << "the process, its wake-ups, its ticks, the latency";
  for (const auto& [uuid, parent] : parent_of) EXPECT_EQ(name_of[parent], "process") << uuid;
  std::int64_t latency_ns = 0;
  std::string wake_ns;
  for (const Packet& packet : packets) {
    if (!packet.contains("track_event.type")) continue;
    EXPECT_TRUE(name_of.contains(packet.at("track_event.track_uuid")));
    if (packet.at("track_event.type") == "TYPE_COUNTER")
      latency_ns = std::stoll(packet.at("track_event.counter_value"));
    if (packet.contains("track_event.name") && packet.at("track_event.name") == "\"tick 7\"")
      wake_ns = packet.at("timestamp");
  }
  EXPECT_EQ(latency_ns, 5'000);
  EXPECT_EQ(wake_ns, "7006000") << "7 ms, woken 5 us late, on a clock that is 1 us ahead";
}

TEST_F(PerfettoTraceFile, ARealLoopWritesOneThatProtocReads) {
  const std::string out = scratch.file("run");
  const auto run =
      tests::run_program("tact-jitter", std::string(TACT_SOURCE_DIR) +
                                            "/model/scenes/liver.toml --duration 0.2 --out " + out);
  ASSERT_EQ(run.status, 0) << run.output;
  std::size_t ticks = 0;
  for (const Packet& packet : decode(out + "/ticks.perfetto-trace"))
    if (const auto name = packet.find("track_event.name"); name != packet.end())
      ticks += name->second.starts_with("\"tick ") ? 1 : 0;
  EXPECT_GT(ticks, 100u);
  EXPECT_LE(ticks, 200u);
}

}  // namespace tact::tools::jitter::tick_trace_test
