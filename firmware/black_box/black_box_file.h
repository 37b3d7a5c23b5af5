// SPDX-License-Identifier: Apache-2.0
// black_box_file.h - one file for one fault: a tick log of every tick, then pictures of them.
//
//     SCENE-DATE-NUMBER-FAULT.tactlog      liver-20260131T120000Z-105-loop-late.tactlog
//
// The pictures are a recording as tact-view makes them (recording_format.h), at the frame rate, and
// tick by tick in the last half second. No file is ever written over.
#pragma once

#include <string>
#include <vector>

#include "firmware/telemetry/tick_log.h"

namespace tact::firmware::black_box {

/// What was kept, oldest first.
struct Kept {
  model::Fault fault = model::Fault::kNone;
  std::vector<telemetry::LoggedTick> ticks;
  std::vector<telemetry::Frame> frames;
};

/// What is the same in every file of a run.
struct BlackBoxRun {
  std::string folder;
  std::string scene_name;
  telemetry::LogHeader header;
  telemetry::Hello hello;
  int mesh_fd = -1;  // the memory file of telemetry_frame.h
};

/// `asked`, or $XDG_STATE_HOME/tact/black-box, or that below ~/.local/state; not made yet. An
/// error if nothing can be written there.
model::Result<std::string> black_box_folder(const std::string& asked);

/// The new file's path; an error names what did not reach the disk.
model::Result<std::string> write_black_box(const BlackBoxRun& run, const Kept& kept);

/// The frames with one more for each tick of the last half second: the picture is that of the frame
/// before it, tool, force and state are the tick's own.
std::vector<telemetry::Frame> with_last_ticks(const Kept& kept);

}  // namespace tact::firmware::black_box
