// SPDX-License-Identifier: Apache-2.0
#include "host/server/scene_picker.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "host/record/telemetry_check.h"

namespace tact::host::server {

ScenePicker::ScenePicker(LiveView& view, std::vector<OfferedScene> offers, Hand hand)
    : view_(view), offers_(std::move(offers)), hand_(std::move(hand)) {}

void ScenePicker::ask(const SceneWish& wish) {
  // Never of hardware: there a person starts tactd, with the device before the eyes.
  if (!is_simulated())
    answer_ = "a scene is chosen here in simulation only";
  else if (asked_)
    answer_ = "a scene is being started; ask again when it runs";
  else
    answer_ = why_not(wish, offers_);
  if (answer_.empty()) {
    asked_ = wish;
    hand_(line_of(wish));
  }
  tell();
}

bool ScenePicker::is_simulated() const { return view_.has_scene() && view_.hello().simulated == 1; }

void ScenePicker::begin() {
  const std::string name(record::text_of(view_.hello().scene_name));
  const auto asked = std::exchange(asked_, std::nullopt);
  if (asked) answer_.clear();
  if (asked && asked->scene == name)
    shown_ = *asked;
  else if (shown_.scene != name)
    shown_ = {.scene = name};
  tell();
}

void ScenePicker::refuse(const std::string& sentence) {
  asked_.reset();
  answer_ = sentence;
  tell();
}

void ScenePicker::tell() {
  if (!is_simulated()) return view_.tell_picker(nullptr);
  view_.tell_picker({{"scene", shown_.scene},
                     {"set", shown_.set},
                     {"asked", asked_ ? asked_->scene : ""},
                     {"answer", answer_}});
}

}  // namespace tact::host::server
