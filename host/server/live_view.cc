// SPDX-License-Identifier: Apache-2.0
#include "host/server/live_view.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "host/server/frame_json.h"
#include "model/io/json.h"

namespace tact::host::server {
namespace {

constexpr std::array kLinkNames{"waiting", "live", "lost", "replay"};  // by Link
static_assert(kLinkNames.size() == static_cast<std::size_t>(Link::kReplay) + 1);

}  // namespace

LiveView::LiveView() { report(); }

void LiveView::begin(const record::RunHeader& header, record::MeshBytes mesh, Link link,
                     const std::string& detail) {
  header_ = header;
  mesh_ = std::make_shared<const record::MeshBytes>(std::move(mesh));
  ++scene_number_;
  if (overlay_source_)
    // Before the status is published: that of a new scene contains the figure.
    figure_ = std::make_shared<const std::string>(
        model::io::text_of(overlay_source_->begin(header, *mesh_)));
  recent_.restart(header.frame_rate_Hz);
  file_.clear();
  link_ = link;
  detail_ = detail;
  report();
}

void LiveView::add(const record::Frame& frame, const tracking::TrackedOperator* tracked,
                   const figure::FigurePose* shown) {
  Text beside;
  if (overlay_source_) {
    beside = std::make_shared<const std::string>(overlay_source_->with(frame, tracked, shown));
    shown = &overlay_source_->figure();
  }
  recent_.add(frame, tracked, shown);
  newest_beside_ = beside;
  // The frame is kept above; without listeners no JSON is made.
  if (listeners_.empty()) return;
  const Text text = std::make_shared<const std::string>(frame_json(frame, header_));
  for (LiveListener* listener : listeners_) listener->on_frame(text, beside);
}

void LiveView::lose(const std::string& reason) {
  link_ = has_scene() ? Link::kLost : Link::kWaiting;
  detail_ = reason;
  report();
}

void LiveView::subscribe(LiveListener& listener) {
  listeners_.insert(&listener);
  listener.on_status(status_);
  // A replay may be paused: without this a new page would stay empty.
  if (link_ == Link::kReplay && !recent_.frames().empty())
    listener.on_frame(
        std::make_shared<const std::string>(frame_json(recent_.frames().back()->frame, header_)),
        newest_beside_);
  // Once: a replay starts with its first page.
  if (const auto then = std::exchange(watched_, nullptr)) then();
}

void LiveView::when_watched(std::function<void()> then) {
  if (!listeners_.empty()) return then();
  watched_ = std::move(then);
}

void LiveView::report_replay(const nlohmann::json& replay) {
  replay_ = std::make_shared<const std::string>(model::io::text_of(replay));
  report();
}

void LiveView::report_picker(const nlohmann::json& picker) {
  picker_.reset();
  if (!picker.is_null()) picker_ = std::make_shared<const std::string>(model::io::text_of(picker));
  report();
}

void LiveView::report() {
  nlohmann::json status{{"kind", "status"},
                        {"link", kLinkNames[static_cast<std::size_t>(link_)]},
                        {"detail", detail_},
                        {"scene_number", scene_number_},
                        {"kept_s", record::RecentFrames::kKeep_s}};
  if (figure_) status["figure"] = *model::io::parse_json(*figure_, "figure");
  if (replay_) status["replay"] = *model::io::parse_json(*replay_, "replay");
  if (picker_) status["picker"] = *model::io::parse_json(*picker_, "picker");
  status_ = std::make_shared<const std::string>(model::io::text_of(status));
  for (LiveListener* listener : listeners_) listener->on_status(status_);
}

record::Snapshot LiveView::recent(std::uint64_t first_tick, std::uint64_t last_tick) const {
  record::Snapshot out{.header = header_, .mesh = mesh_, .frames = {}};
  const auto take = [&](const auto& frames) {
    std::ranges::copy_if(frames, std::back_inserter(out.frames), [&](const auto& kept) {
      return kept->frame.tick >= first_tick && kept->frame.tick <= last_tick;
    });
  };
  file_.empty() ? take(recent_.frames()) : take(file_);
  return out;
}

}  // namespace tact::host::server
