// SPDX-License-Identifier: Apache-2.0
// live_view.h - what every browser sees now: link, scene, newest frame, and the last minutes.
//
// One thread. Telemetry or a replay writes; sessions listen. Texts are made once and shared.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "host/record/recording.h"

namespace tact::host::server {

using Text = std::shared_ptr<const std::string>;

enum class Link { kWaiting, kLive, kLost, kReplay };

class LiveListener {
 public:
  virtual void on_status(const Text& status) = 0;
  /// `beside` belongs to the frame and may be null.
  virtual void on_frame(const Text& frame, const Text& beside) = 0;

 protected:
  ~LiveListener() = default;
};

/// What is told beside every frame, made by who knows more than telemetry: the operator's figure.
class OverlaySource {
 public:
  virtual ~OverlaySource() = default;
  /// For every scene; what it gives is the status's "figure".
  virtual nlohmann::json begin(const record::Hello& hello, const record::MeshBytes& mesh) = 0;
  /// One JSON text for each frame. `shown` is the figure of a recording: it is told as it was.
  virtual std::string with(const record::Frame& frame, const tracking::TrackedOperator* tracked,
                           const figure::FigurePose* shown = nullptr) = 0;
  /// The one that was told last.
  virtual const figure::FigurePose& figure() const = 0;
};

class LiveView {
 public:
  LiveView();

  /// Before the first scene. It outlives the view; null: none.
  void accompany(OverlaySource* overlay_source) { overlay_source_ = overlay_source; }

  // From telemetry or a replay:
  void begin(const record::Hello& hello, record::MeshBytes mesh, Link link,
             const std::string& detail = {});
  /// `tracked` is the operator at this frame, if there is a tracker; `shown` as in Companion.
  void add(const record::Frame& frame, const tracking::TrackedOperator* tracked = nullptr,
           const figure::FigurePose* shown = nullptr);
  void rewind();  // a replay starts elsewhere: forget the frames
  /// Of a replay: the status's "replay".
  void report_replay(const nlohmann::json& replay);
  /// Of a session whose scene may be chosen: the status's "picker"; null: none.
  void report_picker(const nlohmann::json& picker);
  /// Once, as soon as somebody looks.
  void when_watched(std::function<void()> then);
  void lose(const std::string& reason);

  // For sessions:
  /// Tells it the status, and of a replay, which may rest, the frame that is shown.
  void subscribe(LiveListener& listener);
  void unsubscribe(LiveListener& listener) { listeners_.erase(&listener); }
  const Text& status() const { return status_; }
  bool has_scene() const { return scene_number_ > 0; }
  const record::Hello& hello() const { return hello_; }
  const std::shared_ptr<const record::MeshBytes>& mesh() const { return mesh_; }
  std::size_t listeners() const { return listeners_.size(); }

  /// The kept frames with first_tick <= tick <= last_tick.
  record::Snapshot recent(std::uint64_t first_tick, std::uint64_t last_tick) const;

 private:
  void report();

  record::Hello hello_;
  std::shared_ptr<const record::MeshBytes> mesh_;
  std::uint64_t scene_number_ = 0;  // grows with every Hello: the page loads the scene again
  Link link_ = Link::kWaiting;
  std::string detail_;  // of the link
  Text replay_;         // how it plays, if it is one
  Text picker_;         // what may be chosen, if anything may
  Text status_;
  std::function<void()> watched_;
  OverlaySource* overlay_source_ = nullptr;
  Text figure_;         // of the companion, for this scene
  Text newest_beside_;  // of the newest frame
  record::RecentFrames recent_;
  std::set<LiveListener*> listeners_;
};

}  // namespace tact::host::server
