// SPDX-License-Identifier: Apache-2.0
#include "host/server/live_view.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "host/server/frame_json.h"
#include "model/io/json.h"

namespace tact::host::server {
namespace {

const char* name_of(Link link) {
  switch (link) {
    case Link::kWaiting:
      return "waiting";
    case Link::kLive:
      return "live";
    case Link::kLost:
      return "lost";
    case Link::kReplay:
      return "replay";
  }
  return "waiting";
}

}  // namespace

LiveView::LiveView() { tell(Link::kWaiting, {}); }

void LiveView::begin(const record::Hello& hello, record::MeshBytes mesh, Link link,
                     const std::string& detail) {
  hello_ = hello;
  mesh_ = std::make_shared<const record::MeshBytes>(std::move(mesh));
  ++scene_number_;
  if (companion_)
    figure_ = std::make_shared<const std::string>(companion_->begin(hello, *mesh_).dump());
  recent_.restart(static_cast<double>(hello.frame_rate_Hz));
  tell(link, detail);
}

void LiveView::add(const record::Frame& frame, const tracking::TrackedOperator* tracked,
                   const figure::FigurePose* shown) {
  Text beside;
  if (companion_) {
    beside = std::make_shared<const std::string>(companion_->with(frame, tracked, shown));
    shown = &companion_->figure();
  }
  recent_.add(frame, tracked, shown);
  if (listeners_.empty()) return;
  const Text text = std::make_shared<const std::string>(frame_json(frame, hello_));
  for (LiveListener* listener : listeners_) listener->on_frame(text, beside);
}

void LiveView::rewind() { recent_.restart(static_cast<double>(hello_.frame_rate_Hz)); }

void LiveView::lose(const std::string& reason) {
  tell(has_scene() ? Link::kLost : Link::kWaiting, reason);
}

void LiveView::subscribe(LiveListener& listener) {
  listeners_.insert(&listener);
  listener.on_status(status_);
}

void LiveView::tell(Link link, const std::string& detail) {
  nlohmann::json status{{"kind", "status"},
                        {"link", name_of(link)},
                        {"detail", detail},
                        {"scene_number", scene_number_},
                        {"kept_s", record::RecentFrames::kKeep_s}};
  if (figure_) status["figure"] = *model::io::parse_json(*figure_, "figure");
  status_ = std::make_shared<const std::string>(
      status.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  for (LiveListener* listener : listeners_) listener->on_status(status_);
}

record::Snapshot LiveView::recent(std::uint64_t first_tick, std::uint64_t last_tick) const {
  record::Snapshot out{
      .hello = hello_, .mesh = mesh_, .frames = {}, .is_tracked = recent_.is_tracked()};
  std::ranges::copy_if(recent_.frames(), std::back_inserter(out.frames), [&](const auto& kept) {
    return kept->frame.tick >= first_tick && kept->frame.tick <= last_tick;
  });
  return out;
}

}  // namespace tact::host::server
