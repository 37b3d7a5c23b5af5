// SPDX-License-Identifier: Apache-2.0
// tact-view: shows tactd in a browser, records it, replays recordings and exports them as CSV.
#include <fmt/format.h>
#include <unistd.h>

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/read_until.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/net/stop_signals.h"
#include "host/record/recording_csv.h"
#include "host/run/command_line.h"
#include "host/run/operator_inputs.h"
#include "host/run/register_tracker.h"
#include "host/run/telemetry_client.h"
#include "host/server/operator_figure.h"
#include "host/server/playback.h"
#include "host/server/scene_picker.h"
#include "host/server/viewer_server.h"
#include "model/io/file_writer.h"
#include "model/io/json.h"
#include "model/io/program/program_end.h"
#include "model/result.h"

namespace tact::host::run {
namespace {

constexpr int kGood = 0, kCheckFailed = 1, kBadInput = 2;

void warn(const std::string& message) { fmt::print(stderr, "tact-view: {}\n", message); }

int fail(const std::string& message) {
  warn(message);
  return kBadInput;
}

bool exists(const std::string& path) {
  std::error_code unreadable;
  return std::filesystem::exists(path, unreadable);
}

/// 0: a frame came again (TelemetryEvents).
void warn_of_silence(double silence_s) {
  if (silence_s == 0.0) return warn("news from tactd again");
  warn(fmt::format("no news from tactd for {:.1f} s: its force is not known", silence_s));
}

/// Reads the answers to requests, as lines of standard input, from the program that set --scenes.
class Answers {
 public:
  Answers(boost::asio::io_context& io, server::ScenePicker& picker) : input_(io), picker_(picker) {}

  void start() {
    boost::system::error_code wrong;
    input_.assign(::dup(STDIN_FILENO), wrong);  // a copy, so that closing it keeps the input open
    read_next();
  }

 private:
  void read_next() {
    static constexpr std::size_t kMaxLine_bytes = 4096;  // as much as a pipe takes at once
    boost::asio::async_read_until(input_, boost::asio::dynamic_buffer(text_, kMaxLine_bytes), '\n',
                                  [this](boost::system::error_code wrong, std::size_t bytes) {
                                    if (wrong) return;  // no program can answer any more
                                    picker_.answer(text_.substr(0, bytes - 1));
                                    text_.erase(0, bytes);
                                    read_next();
                                  });
  }

  boost::asio::posix::stream_descriptor input_;
  server::ScenePicker& picker_;
  std::string text_;
};

/// Writes every frame of every run to its own file: FILE, then FILE.2, FILE.3.
class Recorder {
 public:
  explicit Recorder(std::string path) : path_(std::move(path)) {}

  void begin(const record::RunHeader& header, const record::MeshBytes& mesh) {
    if (path_.empty()) return;
    note(writer_.close());
    ++runs_;
    // A new run of tactd has another scene, so it needs another file.
    note(writer_.open(runs_ == 1 ? path_ : fmt::format("{}.{}", path_, runs_), header, mesh));
  }
  void add(const record::Frame& frame, const tracking::TrackedOperator* tracked,
           const figure::FigurePose& figure) {
    note(writer_.write(frame, tracked, &figure));
  }
  void close() { note(writer_.close()); }
  bool failed() const { return failed_; }

 private:
  void note(const std::optional<model::Error>& error) {
    if (!error) return;
    failed_ = true;
    warn(error->message);
  }

  record::RecordingWriter writer_;
  std::string path_;
  int runs_ = 0;
  bool failed_ = false;
};

int export_csv(const Options& options, const record::ReadResult& read) {
  const record::Recording& recording = read.recording;
  const std::vector<tracking::BodyRole> bodies = bodies_in(recording);
  std::string text =
      record::csv_facts(recording.header) + record::csv_header(recording.header, bodies);
  auto out = model::io::FileWriter::replace(options.export_csv, text);
  if (!out) return fail(out.error().message);
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    record::append_csv_row(text, recording.frames[i], recording.header, recording.operator_at(i),
                           bodies);
    if (const auto error = out->put(text)) return fail(error->message);
    text.clear();
  }
  if (const auto error = out->finish()) return fail(error->message);
  if (options.json) {
    const nlohmann::json summary{
        {"format", "tact-view-export"},     {"version", 1},
        {"file", options.export_csv},       {"frames", recording.frames.size()},
        {"length_s", recording.length_s()}, {"damage", read.damage}};
    fmt::print("{}\n", model::io::text_of(summary));
  } else {
    fmt::print("{}: {} frames, {:.1f} s\n", options.export_csv, recording.frames.size(),
               recording.length_s());
  }
  // The good part was written, but a script must learn that it is incomplete.
  return read.damage.empty() ? kGood : kCheckFailed;
}

void say_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);  // for a program that reads it through a pipe
}

void say_ready(const Options& options, const server::ViewerServer& server) {
  if (options.json) {
    const nlohmann::json ready{{"format", "tact-view"},
                               {"version", 1},
                               {"url", server.url()},
                               {"port", server.port()},
                               {"token", server.token()}};
    say_line(model::io::text_of(ready));
  } else {
    say_line("tact-view: " + server.url());
  }
}

/// Runs until a signal. `start` starts the source of the view.
template <typename Start>
int serve(const Options& options, boost::asio::io_context& io, server::ViewerServer& server,
          const Start& start) {
  if (const std::optional<model::Error> error = server.open(options.viewer))
    return fail(error->message);
  net::StopSignals signals(io);
  if (const auto wrong = signals.wait([&io] { io.stop(); }))
    return fail("Ctrl-C cannot be waited for: " + wrong.message());
  server.start();
  start();
  say_ready(options, server);
  io.run();
  return kGood;
}

/// The user whose tactd is trusted, in addition to the same user and root.
model::Result<model::io::Trust> trust_of(const Options& options) {
  if (options.tactd_user.empty()) return model::io::Trust{};
  const auto user = model::io::find_user(options.tactd_user);
  if (!user) return model::Error{"--tactd-user " + user.error().message};
  model::io::Trust trust;
  trust.user = *user;
  return trust;
}

/// Passes tactd's frames to page and recording, with the operator at that moment.
TelemetryEvents show_and_record(server::LiveView& view, Recorder& recorder, OperatorInputs& inputs,
                                const server::OperatorFigure& figure, server::ScenePicker& picker) {
  return {.start =
              [&](const record::RunHeader& header, record::MeshBytes mesh) {
                recorder.begin(header, mesh);
                view.begin(header, std::move(mesh), server::Link::kLive);
                picker.begin();
              },
          .frame =
              [&](const record::Frame& frame) {
                // Read once per frame, so that page and recording get the same poses.
                const tracking::TrackedOperator* now = inputs.now();
                inputs.add(frame);
                view.add(frame, now);
                recorder.add(frame, now, figure.figure());
              },
          .lost =
              [&view, &inputs](const std::string& reason) {
                if (!reason.empty()) warn(reason);
                view.lose(reason);
                inputs.lose();
              },
          .silent =
              [&inputs](double silence_s) {
                warn_of_silence(silence_s);
                if (silence_s > 0.0) inputs.lose();
              }};
}

int show_live(const Options& options) {
  // Checked before the server starts, so that no run is shown without its recording.
  if (!options.record.empty() && exists(options.record))
    return fail(options.record +
                ": exists already; a recording is never overwritten, choose another name");
  const auto trust = trust_of(options);
  if (!trust) return fail(trust.error().message);
  server::OperatorFigure figure(options.height_m);  // outlives the view
  server::LiveView view;                            // outlives the sessions, which live in io
  boost::asio::io_context io(1);
  OperatorInputs inputs(io, warn);
  if (const std::optional<model::Error> error = inputs.open(options)) return fail(error->message);
  if (const auto shoulder_m = inputs.shoulder_m()) figure.put_shoulder_at(*shoulder_m);
  if (options.figure || inputs.is_there()) view.accompany(&figure);
  Recorder recorder(options.record);
  server::ScenePicker picker(view, say_line);
  Answers answers(io, picker);
  if (!options.scenes.empty())
    if (const auto error = picker.load(options.scenes)) return fail(error->message);
  TelemetryClient client(io, options.socket,
                         show_and_record(view, recorder, inputs, figure, picker), *trust);
  server::ViewerServer server(
      io, view,
      [&client](const server::HandRequest& request) {
        client.move_hand(request.position_m, request.rotation_rad, request.grip_ratio);
      },
      warn);
  if (!options.scenes.empty())
    server.let_choose([&picker](const nlohmann::json& request) { picker.ask(request); },
                      picker.list());
  if (options.keys) server.let_answer([](char digit) { say_line(fmt::format("key {}", digit)); });
  const int status = serve(options, io, server, [&] {
    client.start();
    inputs.start();
    if (!options.scenes.empty()) answers.start();
    if (const auto port = inputs.igtl_port()) warn(fmt::format("OpenIGTLink on port {}", *port));
  });
  recorder.close();
  return status == kGood && recorder.failed() ? kCheckFailed : status;
}

int show_recording(const Options& options, record::ReadResult read) {
  // Outlives the view. A recording with an operator also has the body height.
  server::OperatorFigure figure(read.recording.body_height_m().value_or(options.height_m));
  server::LiveView view;  // outlives the sessions, which live in io
  boost::asio::io_context io(1);
  if (options.figure || !read.recording.operators.empty()) view.accompany(&figure);
  // No hand to move, because a recording has no tactd.
  server::ViewerServer server(io, view, nullptr, warn);
  server::Playback playback(io, view, std::move(read.recording),
                            std::filesystem::path(options.open).filename().string());
  server.let_steer([&playback](const server::ReplayRequest& request) { playback.steer(request); });
  const int status = serve(options, io, server, [&playback] { playback.start(); });
  return status == kGood && !read.damage.empty() ? kCheckFailed : status;
}

int serve_or_export(const Options& options) {
  if (options.registration) return register_tracker(options);
  if (options.open.empty()) return show_live(options);
  record::ReadResult read = record::read_recording(options.open);
  if (!read.damage.empty()) fmt::print(stderr, "tact-view: {}: {}\n", options.open, read.damage);
  if (!read.usable) return kBadInput;
  if (!options.export_csv.empty()) return export_csv(options, read);
  return show_recording(options, std::move(read));
}

}  // namespace
}  // namespace tact::host::run

int main(int argc, char** argv) {
  tact::model::io::watch_standard_output("tact-view");
  tact::model::io::report_uncaught("tact-view");
  try {
    tact::host::run::Options options;
    if (const auto status = tact::host::run::parse_options(argc, argv, options)) return *status;
    return tact::host::run::serve_or_export(options);
  } catch (const std::exception& error) {  // by a library, without memory or descriptors
    std::fprintf(stderr, "tact-view: %s\n", error.what());
    return 2;
  }
}
