// SPDX-License-Identifier: Apache-2.0
#include "firmware/black_box/black_box_file.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <utility>

#include "firmware/telemetry/frame_builder.h"

namespace tact::firmware::black_box {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

// Duration before the end with one frame per tick; chosen.
constexpr std::int64_t kEveryTick_ns = 500'000'000;

// Replaces all but letters, digits, dots and underscores of a scene's name.
std::string plain(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '_'; }, '-');
  return text;
}

/// SCENE-DATE-NUMBER-FAULT.tactbox with the present time, and a suffix if that name is taken.
std::string free_path(const BlackBoxRun& run, model::Fault fault) {
  const std::time_t now = std::time(nullptr);
  const std::string stem =
      fmt::format("{}/{}-{:%Y%m%dT%H%M%SZ}-{}-{}", run.folder, plain(run.scene_name),
                  fmt::gmtime(now), static_cast<int>(fault), plain(model::describe(fault).name));
  std::string path = stem + ".tactbox";
  // Two faults in one second. If the file appears meanwhile, RunWriter::create refuses it.
  std::error_code unknown;
  for (int n = 2; fs::exists(path, unknown); ++n) path = fmt::format("{}-{}.tactbox", stem, n);
  return path;
}

}  // namespace

Result<std::string> black_box_folder(const std::string& asked) {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);  // before threads
    return fs::path(value == nullptr ? "" : value);
  };
  fs::path folder = asked;
  if (folder.empty()) {
    fs::path state = variable("XDG_STATE_HOME");
    if (state.empty() && !variable("HOME").empty()) state = variable("HOME") / ".local" / "state";
    if (state.empty())
      return Error{
          "no folder for the black box: neither XDG_STATE_HOME nor HOME is set; set one, or name a "
          "folder with --black-box"};
    folder = state / "tact" / "black-box";
  }
  std::error_code failed;
  // The folder may not exist yet: check the nearest existing one above it.
  fs::path there = fs::absolute(folder, failed);
  while (!fs::exists(there, failed) && there.has_relative_path()) there = there.parent_path();
  int wrong = 0;
  if (access(there.c_str(), W_OK | X_OK) != 0) wrong = errno;
  if (!fs::is_directory(there, failed)) wrong = ENOTDIR;
  if (wrong != 0)
    return Error{
        fmt::format("{}: {}: no black box can be written there; name a folder of yours "
                    "with --black-box, or run with --no-black-box",
                    folder.string(), std::strerror(wrong))};
  return folder.string();
}

std::size_t remove_oldest(const std::string& folder, std::uintmax_t most_bytes) {
  // Files of free_path() alone: the folder may hold others.
  constexpr const char* kOurs = "*-????????T??????Z-[0-9][0-9]*-*.tactbox";
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::uintmax_t all_bytes = 0;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; at != end; at.increment(failed)) {
    if (fnmatch(kOurs, at->path().filename().c_str(), 0) != 0 || !at->is_regular_file(failed))
      continue;
    all_bytes += at->file_size(failed);
    found.emplace_back(at->last_write_time(failed), at->path());
  }
  std::ranges::sort(found);
  std::size_t removed = 0;
  for (const auto& [written, path] : found) {
    if (all_bytes <= most_bytes) break;
    const std::uintmax_t bytes = fs::file_size(path, failed);
    if (!fs::remove(path, failed)) continue;
    all_bytes -= bytes;
    ++removed;
  }
  return removed;
}

void each_frame(const Kept& kept, const std::function<void(const protocol::Frame&)>& add) {
  const auto tick = [&kept](std::uint64_t number) {
    return std::lower_bound(
        kept.ticks.begin(), kept.ticks.end(), number,
        [](const protocol::LoggedTick& t, std::uint64_t n) { return t.tick < n; });
  };
  const std::int64_t from_ns = kept.ticks.empty() ? 0 : kept.ticks.back().due_ns - kEveryTick_ns;
  for (std::size_t i = 0; i < kept.frames.size(); ++i) {
    const protocol::Frame& picture = kept.frames[i];
    add(picture);
    const bool last = i + 1 == kept.frames.size();
    const auto shown = tick(picture.tick);
    // The tick of this frame is no longer kept: no frames of ticks can follow it.
    if (shown == kept.ticks.end() || shown->tick != picture.tick) continue;
    const auto end = last ? kept.ticks.end() : tick(kept.frames[i + 1].tick);
    for (auto t = shown + 1; t < end; ++t)
      if (t->due_ns >= from_ns)
        add(telemetry::frame_of_tick(picture, *t, picture.time_ns + t->due_ns - shown->due_ns));
  }
}

BlackBoxRun::BlackBoxRun(std::string to, const protocol::RunHeader& header,
                         std::span<const std::byte> meshes)
    : folder(std::move(to)),
      scene_name(header.scene_name),
      tick_fields(protocol::LoggedTick::fields(header.spheres.size())),
      frame_fields(protocol::Frame::fields(header.spheres.size())),
      start(protocol::start_of_run(header, meshes,
                                   {protocol::schema_of<protocol::LoggedTick>(tick_fields),
                                    protocol::schema_of<protocol::Frame>(frame_fields)})) {}

Result<std::string> write_black_box(const BlackBoxRun& run, const Kept& kept) {
  std::error_code failed;  // RunWriter::create then fails and reports it
  fs::create_directories(run.folder, failed);
  const std::string path = free_path(run, kept.fault);
  auto file = protocol::RunWriter::create(path, run.start);
  if (!file) return file.error();
  file->add(kept.variants);
  // Ticks before frames: a truncated file then still has the ticks.
  for (const protocol::LoggedTick& tick : kept.ticks) file->add(chunk_of(tick, run.tick_fields));
  each_frame(kept,
             [&](const protocol::Frame& frame) { file->add(chunk_of(frame, run.frame_fields)); });
  if (auto error = file->close()) return std::move(*error);
  return path;
}

}  // namespace tact::firmware::black_box
