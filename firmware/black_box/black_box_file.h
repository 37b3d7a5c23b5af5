// SPDX-License-Identifier: Apache-2.0
// black_box_file.h - one file for one fault: a tick log of every tick, then frames for the viewer.
//
//     SCENE-DATE-NUMBER-FAULT.tactbox      liver-20260131T120000Z-105-loop-late.tactbox
//
// Head, meshes, changes of the law's numbers, ticks and frames (firmware/protocol/run_file.h);
// frames at the frame rate, and one per tick in the last half second. An existing file is never
// overwritten.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "firmware/protocol/logged_tick.h"
#include "firmware/protocol/run_file.h"

namespace tact::firmware::black_box {

/// Ticks and frames, oldest first.
struct Kept {
  model::Fault fault = model::Fault::kNone;
  std::string variants;  // chunks
  std::vector<protocol::LoggedTick> ticks;
  std::vector<protocol::Frame> frames;
};

/// The same in every file of a run.
struct BlackBoxRun {
  BlackBoxRun(std::string to, const protocol::RunHeader& header, std::span<const std::byte> meshes);

  std::string folder, scene_name;
  protocol::FieldTable tick_fields, frame_fields;
  std::string start;  // head and meshes, as bytes
};

/// `asked`, else $XDG_STATE_HOME/tact/black-box, else the same below ~/.local/state. It need not
/// exist yet. An error if it could not be created or written to.
model::Result<std::string> black_box_folder(const std::string& asked);

/// Chosen: about a hundred black boxes of a run at 1 kHz.
inline constexpr std::uintmax_t kMaxFolder_bytes = std::uintmax_t{1} << 30;
/// Removes the oldest black boxes of the folder while all together are larger; how many.
std::size_t remove_oldest(const std::string& folder, std::uintmax_t most_bytes = kMaxFolder_bytes);

/// The new file's path; an error names what was not written to the disk.
model::Result<std::string> write_black_box(const BlackBoxRun& run, const Kept& kept);

/// Calls `add` for each frame, and once more for each tick of the last half second: organ from the
/// frame before it, tool, force and state from the tick.
void each_frame(const Kept& kept, const std::function<void(const protocol::Frame&)>& add);

}  // namespace tact::firmware::black_box
