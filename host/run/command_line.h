// SPDX-License-Identifier: Apache-2.0
// command_line.h - the command line of tact-view.
#pragma once

#include <optional>
#include <string>

#include "host/igtl/igtl_link.h"
#include "host/server/viewer_server.h"

namespace tact::host::run {

struct Options {
  server::ViewerOptions viewer;
  std::string socket;         // of tactd's telemetry
  std::string tactd_user;     // user whose tactd is trusted, too
  std::string record;         // new file for header and frames
  std::string open;           // recording to replay instead of tactd
  std::string export_csv;     // with open: write this table and exit
  std::string scenes;         // folder of the scenes offered to pages; empty: none
  std::string tracking;       // description of the operator's tracker
  igtl::IgtlOptions igtl;     // OpenIGTLink; off by default
  bool registration = false;  // with tracking: find the tracker's pose and exit
  std::size_t poses = 12;     // for the registration
  bool figure = false;        // show the operator even without a tracker
  double height_m = 1.75;     // the operator's
  bool keys = false;          // digits of pages become lines of the output
  bool json = false;
};

/// Fills the options, or returns the exit status after --help or bad usage.
std::optional<int> parse_options(int argc, char** argv, Options& options);

}  // namespace tact::host::run
