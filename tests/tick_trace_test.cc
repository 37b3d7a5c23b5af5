// The trace, read by a parser that shares no code with its writer.
#include "tools/jitter/tick_trace.h"

#include <gtest/gtest.h>

#include <map>

#include "tools/jitter/tick_sink.h"

namespace tact::tools {
namespace {

struct Field {
  std::uint64_t number = 0, value = 0;
  std::string bytes;
};

std::uint64_t take_varint(const std::string& in, std::size_t& at) {
  std::uint64_t value = 0;
  for (unsigned shift = 0;; shift += 7) {
    const auto byte = static_cast<unsigned char>(in.at(at++));
    value |= std::uint64_t{byte & 0x7fU} << shift;
    if (byte < 0x80) return value;
  }
}

std::vector<Field> fields_of(const std::string& message) {
  std::vector<Field> fields;
  for (std::size_t at = 0; at < message.size();) {
    const std::uint64_t key = take_varint(message, at);
    Field field{.number = key >> 3, .value = take_varint(message, at), .bytes = {}};
    EXPECT_TRUE((key & 7) == 0 || (key & 7) == 2);
    if ((key & 7) == 2) {
      field.bytes = message.substr(at, field.value);
      EXPECT_EQ(field.bytes.size(), field.value) << "a length that the file does not have";
      at += field.value;
    }
    fields.push_back(field);
  }
  return fields;
}

const Field* find(const std::vector<Field>& fields, std::uint64_t number) {
  for (const Field& f : fields)
    if (f.number == number) return &f;
  return nullptr;
}

TEST(Trace, SlicesNestOnTheirTracksAndTimesAreThoseOfTheTicks) {
  TickSink sink({});
  for (std::uint64_t i = 0; i < 3; ++i) {
    firmware::TickRecord record;
    record.tick = i;
    record.due_ns = 1'000'000'000 + static_cast<std::int64_t>(i) * 1'000'000;
    record.phase_ns = {i == 2 ? 2'000'000 : 5'000, 100, 200, 300, 400, 500, 600, 2'100};
    sink.add(record);
  }
  constexpr std::int64_t kOffset_ns = 1'000'000'000'000;  // needs six bytes as a varint
  const std::string bytes = make_tick_trace(sink.kept_ticks(), kOffset_ns);
  std::map<std::uint64_t, std::string> track_name;
  std::map<std::uint64_t, std::vector<std::string>> open;
  std::map<std::uint64_t, std::uint64_t> newest_ns;
  std::map<std::string, std::vector<std::uint64_t>> begun_ns;
  std::vector<std::uint64_t> latencies;
  for (const Field& packet : fields_of(bytes)) {
    ASSERT_EQ(packet.number, 1u);
    const auto fields = fields_of(packet.bytes);
    ASSERT_NE(find(fields, 10), nullptr) << "every packet names its sequence";
    if (const Field* descriptor = find(fields, 60)) {
      const auto about = fields_of(descriptor->bytes);
      track_name[find(about, 1)->value] = find(about, 2) != nullptr ? find(about, 2)->bytes : "";
      continue;
    }
    const auto event = fields_of(find(fields, 11)->bytes);
    const std::uint64_t type = find(event, 9)->value, track = find(event, 11)->value;
    const std::uint64_t time_ns = find(fields, 8)->value;
    ASSERT_TRUE(track_name.contains(track)) << "an event on a track that nobody described";
    EXPECT_GE(time_ns, newest_ns[track]);
    newest_ns[track] = time_ns;
    if (type == 1) {
      open[track].push_back(find(event, 23)->bytes);
      begun_ns[open[track].back()].push_back(time_ns);
    } else if (type == 2) {
      ASSERT_FALSE(open[track].empty());
      open[track].pop_back();
    } else if (type == 4) {
      latencies.push_back(find(event, 30)->value);
    }
  }
  for (const auto& [track, slices] : open) EXPECT_TRUE(slices.empty()) << track_name[track];
  EXPECT_EQ(latencies, (std::vector<std::uint64_t>{5'000, 5'000, 2'000'000}));
  const std::uint64_t first_wake_ns = kOffset_ns + 1'000'000'000 + 5'000;
  EXPECT_EQ(begun_ns["tick 0"].at(0), first_wake_ns);
  EXPECT_EQ(begun_ns["read"].at(0), first_wake_ns);
  EXPECT_EQ(begun_ns["touch"].at(0), first_wake_ns + 100);
  EXPECT_EQ(begun_ns["write"].at(0), first_wake_ns + 100 + 200 + 300 + 400);
  EXPECT_EQ(begun_ns["tell"].size(), 2u) << "nobody told how the last tick ended";
  EXPECT_EQ(begun_ns["wake"].size(), 3u);
}

}  // namespace
}  // namespace tact::tools
