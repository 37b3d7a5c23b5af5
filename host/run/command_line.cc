// SPDX-License-Identifier: Apache-2.0
#include "host/run/command_line.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "host/run/telemetry_client.h"
#include "model/io/program/command_line.h"
#include "model/io/program/installed.h"
#include "model/io/program/within.h"

namespace tact::host::run {
namespace {

/// In a build page/ next to the program, in an installation share/tact/page.
std::string default_page() {
  std::error_code wrong;
  const auto installed = model::io::installed("page");
  if (std::filesystem::is_directory(installed, wrong)) return installed.string();
  return (model::io::program_folder() / "page").string();
}

/// Not with --open, where no peer is needed, nor with --register, which needs the tracker alone.
void add_igtl(CLI::App& app, igtl::IgtlOptions& options, CLI::Option* registration) {
  CLI::Option* open = app.get_option("--open");
  CLI::Option* port =
      app.add_option(
             "--igtl", options.port,
             "TCP port for OpenIGTLink (3D Slicer takes 18944), off without it: pose, force "
             "and status out, trackers' poses in; 0 takes any free one")
          ->check(model::io::within(0, 65535))
          ->excludes(open)
          ->excludes(registration);
  app.add_option("--igtl-bind", options.bind_address, "IP address for --igtl; there is no password")
      ->capture_default_str()
      ->needs(port);
  app.add_option("--igtl-from", options.from,
                 "ADDRESS:PORT of an OpenIGTLink server of trackers, such as PLUS; its poses move "
                 "the operator's figure")
      ->excludes(open)
      ->excludes(registration);
}

void add_page(CLI::App& app, Options& options) {
  app.add_option("--port", options.viewer.port, "port of the page; 0 takes any free one")
      ->capture_default_str()
      ->check(model::io::within(0, 65535));
  app.add_option("--bind", options.viewer.bind_address,
                 "IP address to serve on; the link that is printed holds the token")
      ->capture_default_str();
  app.add_option("--url", options.viewer.public_url,
                 "address of a proxy with TLS before it, as https://name:port/, for the link that "
                 "is printed");
  app.add_option(
      "--page", options.viewer.page_folder,
      "folder of the built page (default: ../share/tact/page or page/ beside this program)");
  app.add_flag(
      "--keys", options.keys,
      "for a program that asks for answers, as tact-trial does: a digit that is typed at a "
      "page becomes the line \"key DIGIT\" of the output");
  app.add_flag("--json", options.json, "say what is ready or done as one line of JSON");
}

/// The source to show: a tactd, or a recording.
void add_source(CLI::App& app, Options& options) {
  app.add_option("--socket", options.socket, "tactd's telemetry socket")->capture_default_str();
  app.add_option("--tactd-user", options.tactd_user,
                 "user whose tactd is believed (default: only the same user's and root's)");
  CLI::Option* open = app.add_option(
      "--open", options.open, "replay this recording, or a black box of tactd, instead of tactd");
  app.add_option("--record", options.record, "write all frames to this new file")->excludes(open);
  app.add_option("--export", options.export_csv,
                 "with --open: write this CSV file (m, s, N, us, as its columns say) and leave")
      ->needs(open);
  app.add_option(
         "--scenes", options.scenes,
         "for who starts tactd and tact-view in simulation: folder with the --parameters of "
         "scenes that the page offers; a request is a line of the output")
      ->excludes(open);
}

void add_operator(CLI::App& app, Options& options) {
  CLI::Option* tracking = app.add_option(
      "--tracking", options.tracking, "description of the operator's tracker, SCENE.tracking.toml");
  CLI::Option* registration =
      app.add_flag("--register", options.registration,
                   "with --tracking and a running tactd: find the pose of the tracker from poses "
                   "of the tracked tool, write SCENE.registration.toml and leave");
  app.add_option("--poses", options.poses, "for --register")
      ->capture_default_str()
      ->check(model::io::within(6, 200))
      ->needs(registration);
  add_igtl(app, options.igtl, registration);
  app.add_flag("--figure", options.figure,
               "show the operator without a tracker, too: the arm that holds the tool");
  app.add_option("--height", options.height_m,
                 "the operator's body height, m; a recording with an operator has its own")
      ->capture_default_str()
      ->check(model::io::within(1.2, 2.2));
  // A recording contains its own operator.
  tracking->excludes(app.get_option("--open"));
  registration->needs(tracking)->excludes(app.get_option("--record"));
}

}  // namespace

std::optional<int> parse_options(int argc, char** argv, Options& options) {
  // Before CLI11 parses, because it shows this value as the default.
  options.socket = default_telemetry_path();
  CLI::App app{
      "tact-view: shows what tactd does in a browser: the deforming tissue, the tool, the force "
      "and\n"
      "the time left before each deadline. It cannot command a force. Ctrl-C ends it.\n"
      "Exit status: 0 good, 1 a recording is damaged or incomplete, or a registration failed\n"
      "or has a residual above 2 mm (written all the same), 2 "
      "bad usage\n"
      "or input."};
  add_source(app, options);
  add_page(app, options);
  add_operator(app, options);
  if (const auto status = model::io::parse_command_line(app, "tact-view", argc, argv))
    return status;
  if (options.viewer.page_folder.empty()) options.viewer.page_folder = default_page();
  return std::nullopt;
}

}  // namespace tact::host::run
