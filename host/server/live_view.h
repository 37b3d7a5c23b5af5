// SPDX-License-Identifier: Apache-2.0
// live_view.h - the state that every browser shows: link, scene, newest frame, and the last
// minutes.
//
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/record/recording.h"

namespace tact::host::server {

using Text = std::shared_ptr<const std::string>;

enum class Link { kWaiting, kLive, kLost, kReplay };

class LiveListener {
 public:
  virtual void on_status(const Text& status) = 0;
  /// `beside` is the overlay of the frame and may be null.
  virtual void on_frame(const Text& frame, const Text& beside) = 0;

 protected:
  ~LiveListener() = default;
};

/// Adds an overlay to every frame from data that telemetry lacks: the operator's figure.
class OverlaySource {
 public:
  virtual ~OverlaySource() = default;
  /// Called for every scene; the result is the status's "figure".
  virtual nlohmann::json begin(const record::RunHeader& header, const record::MeshBytes& mesh) = 0;
  /// One JSON text per frame. `shown` is the figure of a recording, which is passed on unchanged.
  virtual std::string with(const record::Frame& frame, const tracking::TrackedOperator* tracked,
                           const figure::FigurePose* shown = nullptr) = 0;
  /// The figure reported last.
  virtual const figure::FigurePose& figure() const = 0;
};

class LiveView {
 public:
  LiveView();

  /// Call before the first scene. The source must outlive the view; null: none.
  void accompany(OverlaySource* overlay_source) { overlay_source_ = overlay_source; }

  // From telemetry or a replay:
  void begin(const record::RunHeader& header, record::MeshBytes mesh, Link link,
             const std::string& detail = {});
  /// `tracked`: the operator at this frame, null without a tracker; `shown`: as in OverlaySource.
  void add(const record::Frame& frame, const tracking::TrackedOperator* tracked = nullptr,
           const figure::FigurePose* shown = nullptr);
  /// In a replay: recent() then gives these, the whole file, independent of what was shown.
  void keep(std::vector<std::shared_ptr<const record::KeptFrame>> frames) {
    file_ = std::move(frames);
  }
  /// Sets the status's "replay" of a replay.
  void report_replay(const nlohmann::json& replay);
  /// Sets the status's "picker" of a session with scenes to choose; null: none.
  void report_picker(const nlohmann::json& picker);
  /// Called once, at the first subscription.
  void when_watched(std::function<void()> then);
  void lose(const std::string& reason);

  // For sessions:
  /// Sends the status, and the shown frame of a replay, which may be paused.
  void subscribe(LiveListener& listener);
  void unsubscribe(LiveListener& listener) { listeners_.erase(&listener); }
  const Text& status() const { return status_; }
  bool has_scene() const { return scene_number_ > 0; }
  const record::RunHeader& header() const { return header_; }
  const std::shared_ptr<const record::MeshBytes>& mesh() const { return mesh_; }
  std::size_t listeners() const { return listeners_.size(); }

  /// The kept frames with first_tick <= tick <= last_tick.
  record::Snapshot recent(std::uint64_t first_tick, std::uint64_t last_tick) const;

 private:
  void report();

  record::RunHeader header_;
  std::shared_ptr<const record::MeshBytes> mesh_;
  std::uint64_t scene_number_ = 0;  // grows with every run: the page loads the scene again
  Link link_ = Link::kWaiting;
  std::string detail_;  // of the link
  Text replay_;         // playback state; null for a live view
  Text picker_;         // the offered scenes; null if there are none
  Text status_;
  std::function<void()> watched_;
  OverlaySource* overlay_source_ = nullptr;
  Text figure_;         // of the overlay source, for this scene
  Text newest_beside_;  // of the newest frame
  record::RecentFrames recent_;
  std::vector<std::shared_ptr<const record::KeptFrame>> file_;  // of a replay
  std::set<LiveListener*> listeners_;
};

}  // namespace tact::host::server
