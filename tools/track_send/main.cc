// SPDX-License-Identifier: Apache-2.0
// tact-track-send: plays a file of tracker observations to tact-view, as a tracker would.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/tracking/observation_player.h"
#include "model/io/json.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "model/io/program/within.h"
#include "model/result.h"

namespace {

using boost::asio::ip::udp;
using tact::host::tracking::KeepText;
using tact::host::tracking::ObservationFile;
using tact::host::tracking::ObservationPlayer;
using tact::host::tracking::PlayedLine;
using tact::model::Error;
using tact::model::Result;

constexpr int kGood = 0, kCheckFailed = 1, kBadInput = 2;

struct Options {
  std::string file;
  std::uint16_t port = 8322;
  ObservationPlayer::Options play{.loop = false};
  bool json = false;
};

int send_all(const Options& options) {
  Result<ObservationFile> file = read_observation_file(options.file, KeepText::kYes);
  std::optional<Error> refused = file ? std::nullopt : std::optional(file.error());
  if (file && options.play.loop) refused = check_loop(options.file, *file);
  if (refused) {
    fmt::print(stderr, "tact-track-send: {}\n", refused->sentence);
    return kBadInput;
  }
  if (file->bad > 0) {
    fmt::print(stderr, "tact-track-send: {}; {} such lines are left out\n", file->first_bad,
               file->bad);
  }
  boost::asio::io_context io(1);
  udp::socket socket(io, udp::v4());
  const udp::endpoint viewer(boost::asio::ip::address_v4::loopback(), options.port);
  std::uint64_t sent = 0, unsent = 0;
  ObservationPlayer player(
      io, std::move(file->lines), options.play,
      [&](const PlayedLine& line) {
        boost::system::error_code wrong;
        socket.send_to(boost::asio::buffer(line.text), viewer, 0, wrong);
        ++(wrong ? unsent : sent);
      },
      [&io] { io.stop(); });
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&io](boost::system::error_code, int) { io.stop(); });
  player.start();
  io.run();
  if (options.json) {
    fmt::print("{}\n", tact::model::io::text_of(nlohmann::json{{"format", "tact-track-send"},
                                                               {"version", 1},
                                                               {"sent", sent},
                                                               {"unsent", unsent},
                                                               {"bad", file->bad}}));
  } else {
    fmt::print(
        "tact-track-send: {} observations sent to 127.0.0.1:{}, {} not taken by the kernel\n", sent,
        options.port, unsent);
  }
  return unsent == 0 && file->bad == 0 ? kGood : kCheckFailed;
}

}  // namespace

int main(int argc, char** argv) {
  tact::model::io::watch_standard_output("tact-track-send");
  tact::model::io::tell_uncaught("tact-track-send");
  Options options;
  CLI::App app{
      "tact-track-send: plays a file of tracker observations (one JSON object per line, see\n"
      "host/tracking/README.md) as UDP datagrams to tact-view --tracking, with their own timing.\n"
      "Ctrl-C ends it. Exit status: 0 good, 1 lines were no observation or could not be sent, 2 "
      "bad usage\nor input."};
  app.add_option("file", options.file, "observations, one per line")->required();
  app.add_option("--port", options.port, "UDP port of tact-view on 127.0.0.1")
      ->capture_default_str()
      ->check(tact::model::io::within(1, 65535));
  app.add_option("--speed", options.play.speed_ratio, "times as fast as recorded")
      ->capture_default_str()
      ->check(tact::model::io::within(0.01, 100.0));
  app.add_flag("--loop", options.play.loop, "from the start again at the end");
  app.add_flag("--json", options.json, "say what was sent as one line of JSON");
  if (const auto status = tact::model::io::parse_command_line(app, "tact-track-send", argc, argv))
    return *status;
  try {
    return send_all(options);
  } catch (const std::exception& error) {  // a library's, when memory or descriptors run out
    fmt::print(stderr, "tact-track-send: {}\n", error.what());
    return kBadInput;
  }
}
