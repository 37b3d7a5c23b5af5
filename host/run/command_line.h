// SPDX-License-Identifier: Apache-2.0
// command_line.h - what tact-view was asked to do.
#pragma once

#include <optional>
#include <string>

#include "host/igtl/igtl_link.h"
#include "host/server/viewer_server.h"

namespace tact::host::run {

struct Options {
  server::ViewerOptions viewer;
  std::string socket;         // of tactd's telemetry
  std::string tactd_user;     // whose tactd is believed too
  std::string record;         // new file for hello and frames
  std::string open;           // recording to replay instead of tactd
  std::string export_csv;     // with open: write this table and leave
  std::string scenes;         // folder of what pages may choose; empty: nothing
  std::string tracking;       // description of the operator's tracker
  igtl::IgtlOptions igtl;     // OpenIGTLink; none is asked for by default
  bool registration = false;  // with tracking: find the tracker's place and leave
  std::size_t poses = 12;     // for it
  bool figure = false;        // show the operator, without a tracker too
  double height_m = 1.75;     // the operator's
  bool json = false;
};

/// Fills the options; or the status to leave with, after --help or bad usage.
std::optional<int> parse_options(int argc, char** argv, Options& options);

}  // namespace tact::host::run
