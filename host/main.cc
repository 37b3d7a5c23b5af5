// tact-view: shows what tactd does in a browser, records it, replays it, writes it as CSV.
#include <fmt/format.h>

#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/command_line.h"
#include "host/operator_figure.h"
#include "host/playback.h"
#include "host/recording_csv.h"
#include "host/register_tracker.h"
#include "host/telemetry_client.h"
#include "host/tracking/operator_tracking.h"
#include "host/viewer_server.h"

namespace tact::host {
namespace {

constexpr int kGood = 0, kCheckFailed = 1, kBadInput = 2;

void warn(const std::string& sentence) { fmt::print(stderr, "tact-view: {}\n", sentence); }

int fail(const std::string& sentence) {
  warn(sentence);
  return kBadInput;
}

bool exists(const std::string& path) {
  std::error_code unreadable;
  return std::filesystem::exists(path, unreadable);
}

/// A file name with broken UTF-8 is mended instead of throwing.
std::string to_text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Writes every frame of every run to its own file: FILE, then FILE.2, FILE.3.
class Recorder {
 public:
  Recorder(std::string path, bool is_tracked) : path_(std::move(path)), is_tracked_(is_tracked) {}

  void begin(const Hello& hello, const MeshBytes& mesh) {
    if (path_.empty()) return;
    note(writer_.close());
    ++runs_;
    note(writer_.open(runs_ == 1 ? path_ : fmt::format("{}.{}", path_, runs_), hello, mesh,
                      is_tracked_));
  }
  void add(const Frame& frame, const TrackedOperator* tracked, const FigurePose& figure) {
    note(writer_.write(frame, tracked, &figure));
  }
  void close() { note(writer_.close()); }
  bool failed() const { return failed_; }

 private:
  void note(const std::string& wrong) {
    if (wrong.empty()) return;
    failed_ = true;
    fmt::print(stderr, "tact-view: {}\n", wrong);
  }

  RecordingWriter writer_;
  std::string path_;
  bool is_tracked_;
  int runs_ = 0;
  bool failed_ = false;
};

int export_csv(const Options& options, const ReadResult& read) {
  if (exists(options.export_csv)) {
    return fail(options.export_csv + ": exists already; choose another name");
  }
  std::ofstream out(options.export_csv, std::ios::binary);
  const Recording& recording = read.recording;
  const std::vector<BodyRole> bodies = bodies_in(recording);
  std::string text = csv_header(recording.hello, bodies);
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    append_csv_row(text, recording.frames[i], recording.hello, recording.operator_at(i), bodies);
    out << text;
    text.clear();
  }
  out.flush();
  if (!out) return fail(options.export_csv + ": cannot be written; check folder and free space");
  if (options.json) {
    const nlohmann::json summary{{"file", options.export_csv},
                                 {"frames", recording.frames.size()},
                                 {"length_s", recording.length_s()},
                                 {"damage", read.damage}};
    fmt::print("{}\n", to_text(summary));
  } else {
    fmt::print("{}: {} frames, {:.1f} s\n", options.export_csv, recording.frames.size(),
               recording.length_s());
  }
  return read.damage.empty() ? kGood : kCheckFailed;
}

void say_ready(const Options& options, const ViewerServer& server) {
  if (options.json) {
    const nlohmann::json ready{
        {"url", server.url()}, {"port", server.port()}, {"token", server.token()}};
    fmt::print("{}\n", to_text(ready));
  } else {
    fmt::print("tact-view: {}\n", server.url());
  }
  std::fflush(stdout);
}

/// Runs until a signal. `source` starts what feeds the view.
template <typename Start>
int serve(const Options& options, boost::asio::io_context& io, ViewerServer& server,
          const Start& start) {
  if (std::string wrong = server.open(options.viewer); !wrong.empty()) return fail(wrong);
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&io](boost::system::error_code, int) { io.stop(); });
  server.start();
  start();
  say_ready(options, server);
  io.run();
  return kGood;
}

int show_live(const Options& options) {
  if (!options.record.empty() && exists(options.record)) {
    return fail(options.record +
                ": exists already; a recording is never overwritten, choose "
                "another name");
  }
  OperatorFigure figure(options.height_m);  // outlives the view
  LiveView view;                            // outlives the sessions, which live in io
  boost::asio::io_context io(1);
  std::optional<OperatorTracking> tracking;
  if (!options.tracking.empty()) {
    tracking.emplace(io, warn);
    if (const std::string wrong = tracking->open(options.tracking); !wrong.empty()) {
      return fail(wrong);
    }
    if (const auto& shoulder_m = tracking->setup().shoulder_m) figure.put_shoulder_at(*shoulder_m);
  }
  if (options.figure || tracking) view.accompany(&figure);
  Recorder recorder(options.record, tracking.has_value());
  TelemetryClient client(io, options.socket,
                         {.hello =
                              [&](const Hello& hello, MeshBytes mesh) {
                                recorder.begin(hello, mesh);
                                view.begin(hello, std::move(mesh), Link::kLive);
                              },
                          .frame =
                              [&](const Frame& frame) {
                                const TrackedOperator* now = tracking ? &tracking->now() : nullptr;
                                view.add(frame, now);
                                recorder.add(frame, now, figure.figure());
                              },
                          .lost =
                              [&](const std::string& reason) {
                                if (!reason.empty()) warn(reason);
                                view.lose(reason);
                              }});
  ViewerServer server(io, view, [&client](const double(&position_m)[3], double grip_ratio) {
    client.move_hand(position_m, grip_ratio);
  });
  const int status = serve(options, io, server, [&client, &tracking] {
    client.start();
    if (tracking) tracking->start();
  });
  recorder.close();
  return status == kGood && recorder.failed() ? kCheckFailed : status;
}

int show_recording(const Options& options, ReadResult read) {
  // Outlives the view; a recording that has the operator has the height of the body, too.
  OperatorFigure figure(read.recording.body_height_m().value_or(options.height_m));
  LiveView view;  // outlives the sessions, which live in io
  boost::asio::io_context io(1);
  if (options.figure || !read.recording.operators.empty()) view.accompany(&figure);
  ViewerServer server(io, view, nullptr);
  Playback playback(io, view, std::move(read.recording),
                    std::filesystem::path(options.open).filename().string());
  const int status = serve(options, io, server, [&playback] { playback.start(); });
  return status == kGood && !read.damage.empty() ? kCheckFailed : status;
}

int run(const Options& options) {
  if (options.registration) return register_tracker(options);
  if (options.open.empty()) return show_live(options);
  ReadResult read = read_recording(options.open);
  if (!read.damage.empty()) fmt::print(stderr, "tact-view: {}: {}\n", options.open, read.damage);
  if (!read.usable) return kBadInput;
  if (!options.export_csv.empty()) return export_csv(options, read);
  return show_recording(options, std::move(read));
}

}  // namespace
}  // namespace tact::host

int main(int argc, char** argv) {
  try {
    tact::host::Options options;
    if (const auto status = tact::host::parse_options(argc, argv, options)) return *status;
    return tact::host::run(options);
  } catch (const std::exception& error) {  // a library's, when memory or descriptors run out
    std::fprintf(stderr, "tact-view: %s\n", error.what());
    return 2;
  }
}
