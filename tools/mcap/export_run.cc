// SPDX-License-Identifier: Apache-2.0
#include "tools/mcap/export_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#include <optional>
#include <unordered_map>

#include "firmware/telemetry/tick_log.h"
#include "host/record/recording.h"
#include "model/io/input_file.h"
#include "model/io/one_line.h"
#include "model/io/program/command_line.h"
#include "tools/mcap/mcap_writer.h"
#include "tools/mcap/messages.h"

namespace tact::tools::mcap {
namespace {

using firmware::telemetry::Frame;
using firmware::telemetry::Hello;
using firmware::telemetry::LoggedTick;
using firmware::telemetry::LogHeader;
using firmware::telemetry::TickLogReader;
using host::record::ReadResult;
using model::Error;
using model::Result;

/// The four topics of one rate.
struct Topics {
  std::uint16_t pose, force, wanted, state;

  static Topics add(McapWriter& out, const std::string& under) {
    return {.pose = out.add_channel(under + "/pose", pose_schema()),
            .force = out.add_channel(under + "/force", wrench_schema()),
            .wanted = out.add_channel(under + "/wanted", wrench_schema()),
            .state = out.add_channel(under + "/state", state_schema())};
  }
};

/// A field of a header, whether it ends with a zero or not.
template <std::size_t n>
std::string text_of(const char (&field)[n]) {
  return model::io::on_one_line({field, strnlen(field, n)});
}

/// 0: no date.
std::uint64_t utc_ns(const std::string& date) {
  std::tm parts{};
  const char* end = strptime(date.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  if (end == nullptr || *end != '\0') return 0;
  const std::time_t seconds = timegm(&parts);
  return seconds > 0 ? static_cast<std::uint64_t>(seconds) * 1'000'000'000u : 0;
}

/// In the file's time; one that would be before 1970 is at its start.
std::uint64_t time_of(std::uint64_t epoch_ns, std::int64_t since_start_ns) {
  // Unsigned: a damaged time may overflow, which is defined here.
  const std::uint64_t sum = epoch_ns + static_cast<std::uint64_t>(since_start_ns);
  return static_cast<std::int64_t>(sum) < 0 ? 0 : sum;
}

Pairs facts_of(const Hello& hello) {
  return {{"scene", text_of(hello.scene_name)},
          {"law", text_of(hello.law_name)},
          {"device", text_of(hello.device_name)},
          {"rate_Hz", fmt::format("{:.10g}", hello.rate_Hz)},
          {"frame_rate_Hz", fmt::format("{:.10g}", hello.frame_rate_Hz)}};
}

Pairs facts_of(const LogHeader& header) {
  const double rate_Hz = header.period_ns > 0 ? 1e9 / static_cast<double>(header.period_ns) : 0.0;
  return {{"scene", text_of(header.scene_name)},
          {"scene_hash", text_of(header.scene_hash)},
          {"law", text_of(header.law)},
          {"rate_Hz", fmt::format("{:.10g}", rate_Hz)},
          {"began_utc", text_of(header.began_utc)},
          {"host", text_of(header.host)},
          {"revision", text_of(header.revision)}};
}

/// Writes moments, and knows how long they are.
class Export {
 public:
  Export(McapWriter out, Exported& told) : out_(std::move(out)), told_(told) {}

  std::optional<Error> describe(const Pairs& facts) { return out_.add_metadata("tact", facts); }

  std::optional<Error> put(const LoggedTick& tick, std::uint64_t time_ns) {
    ++told_.ticks;
    return put(ticks_, "/tact/tick", Moment::of(tick, time_ns));
  }
  std::optional<Error> put(const Frame& frame, std::uint64_t time_ns) {
    ++told_.frames;
    return put(frames_, "/tact/frame", Moment::of(frame, time_ns));
  }
  std::optional<Error> finish() {
    told_.messages = out_.messages();
    told_.length_s = 1e-9 * static_cast<double>(last_ns_ - first_ns_);
    return out_.finish();
  }

 private:
  std::optional<Error> put(std::optional<Topics>& topics, const char* under, const Moment& moment) {
    first_ns_ = out_.messages() == 0 ? moment.time_ns : std::min(first_ns_, moment.time_ns);
    last_ns_ = std::max(last_ns_, moment.time_ns);
    // At its first message: a file has no topic that is always empty.
    if (!topics) topics = Topics::add(out_, under);
    auto error = out_.put(topics->pose, moment.time_ns, pose_message(moment));
    if (!error)
      error = out_.put(topics->force, moment.time_ns, wrench_message(moment, moment.written));
    if (!error)
      error = out_.put(topics->wanted, moment.time_ns, wrench_message(moment, moment.wanted));
    return error ? error : out_.put(topics->state, moment.time_ns, state_message(moment));
  }

  McapWriter out_;
  Exported& told_;
  std::optional<Topics> ticks_, frames_;
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
};

Result<McapWriter> create(const std::string& to) {
  return McapWriter::create(to, "ros2", fmt::format("tact-mcap {}", model::io::tact_version()));
}

Result<Exported> export_recording(const ReadResult& read, const std::string& to) {
  Exported told{.damage = read.damage};
  auto file = create(to);
  if (!file) return file.error();
  Export out(std::move(*file), told);
  if (const auto error = out.describe(facts_of(read.recording.hello))) return *error;
  for (const Frame& frame : read.recording.frames)
    if (const auto error = out.put(frame, time_of(0, frame.time_ns))) return *error;
  if (const auto error = out.finish()) return *error;
  return told;
}

/// due_ns at which the loop started, so that a frame's time is that of its tick. Without a frame
/// whose tick is there: reckoned from the number of the first tick. None: no good tick.
Result<std::optional<std::uint64_t>> start_of(const std::string& from, const ReadResult& read) {
  // Frames name their tick, so one common tick joins the two clocks.
  std::unordered_map<std::uint64_t, std::int64_t> time_ns;  // of frames, by tick
  for (const Frame& frame : read.recording.frames) time_ns[frame.tick] = frame.time_ns;
  auto log = TickLogReader::open(from);
  if (!log) return log.error();
  std::optional<std::uint64_t> reckoned;
  const auto period_ns = static_cast<std::uint64_t>(log->header().period_ns);
  for (LoggedTick tick; log->next(tick);) {
    const auto due_ns = static_cast<std::uint64_t>(tick.due_ns);
    if (const auto found = time_ns.find(tick.tick); found != time_ns.end())
      return std::optional(due_ns - static_cast<std::uint64_t>(found->second));
    if (!reckoned) reckoned = due_ns - tick.tick * period_ns;
    // Without a frame the first tick is all that there is to reckon from.
    if (time_ns.empty()) break;
  }
  return reckoned;
}

std::string joined(const std::string& ticks, const std::string& frames) {
  if (frames.empty()) return ticks;
  return ticks.empty() ? frames : ticks + "; " + frames;
}

Result<Exported> export_ticks(const std::string& from, const std::string& to) {
  auto log = TickLogReader::open(from);
  if (!log) return log.error();
  const LogHeader& header = log->header();
  const bool has_frames = header.ticks != 0;  // a black box
  const ReadResult read = has_frames ? host::record::read_recording(from) : ReadResult{};
  const auto start = start_of(from, read);
  if (!start) return start.error();
  if (!*start && !read.usable)
    return Error{from + ": holds no whole tick; nothing of it can be exported, record it again"};
  Exported told;
  auto file = create(to);
  if (!file) return file.error();
  Export out(std::move(*file), told);
  if (const auto error = out.describe(facts_of(header))) return *error;
  const std::uint64_t epoch_ns = utc_ns(text_of(header.began_utc));
  auto frame = read.recording.frames.begin();
  const auto put_frames_before = [&](std::uint64_t time_ns) -> std::optional<Error> {
    for (; frame != read.recording.frames.end(); ++frame) {
      const std::uint64_t at_ns = time_of(epoch_ns, frame->time_ns);
      if (at_ns > time_ns) break;
      if (auto error = out.put(*frame, at_ns)) return error;
    }
    return std::nullopt;
  };
  for (LoggedTick tick; log->next(tick);) {
    const std::uint64_t since_ns = static_cast<std::uint64_t>(tick.due_ns) - start->value_or(0);
    const std::uint64_t at_ns = time_of(epoch_ns, static_cast<std::int64_t>(since_ns));
    // In the order of time: a reader plays the file from front to back.
    if (const auto error = put_frames_before(at_ns)) return *error;
    if (const auto error = out.put(tick, at_ns)) return *error;
  }
  if (const auto error = put_frames_before(UINT64_MAX)) return *error;
  if (const auto error = out.finish()) return *error;
  told.damage = joined(log->damage(), has_frames ? read.damage : "");
  return told;
}

}  // namespace

Result<Exported> export_run(const std::string& from, const std::string& to) {
  std::array<char, sizeof firmware::telemetry::kLogMagic> magic{};
  {
    auto file = model::io::InputFile::open(from, "name a tick log, a black box or a recording");
    if (!file) return file.error();
    (void)file->read(magic.data(), magic.size());
  }
  // The last letter is the version, of which its reader speaks.
  if (std::memcmp(magic.data(), firmware::telemetry::kLogMagic, magic.size() - 1) == 0)
    return export_ticks(from, to);
  const ReadResult read = host::record::read_recording(from);
  if (!read.usable) return Error{fmt::format("{}: {}", from, read.damage)};
  return export_recording(read, to);
}

}  // namespace tact::tools::mcap
