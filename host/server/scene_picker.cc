// SPDX-License-Identifier: Apache-2.0
#include "host/server/scene_picker.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "host/record/telemetry_check.h"
#include "model/io/json.h"

namespace tact::host::server {
namespace {

using model::Error;
using model::io::text_of;
using nlohmann::json;

constexpr std::string_view kDone = "done ";
constexpr std::string_view kRemedy = "write it again: tactd SCENE --parameters --json FILE";

bool is_offer(const json& reported) {
  const auto has_key = [](const json& row) { return row.is_object() && row.contains("key"); };
  return reported.is_object() && reported.value("format", json()) == "tactd-parameters" &&
         reported.value("simulated", json()) == true &&
         reported.value("scene", json()).is_string() && reported.contains("parameters") &&
         std::ranges::all_of(reported["parameters"], has_key);
}

}  // namespace

std::optional<Error> ScenePicker::load(const std::string& folder) {
  std::error_code wrong;
  for (const auto& entry : std::filesystem::directory_iterator(folder, wrong)) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".json") continue;
    const auto reported = model::io::read_json(path, kRemedy);
    if (!reported) return reported.error();
    if (!is_offer(*reported))
      return Error{fmt::format("{}: not the parameters of a simulated scene; {}", path, kRemedy)};
    offers_[(*reported)["scene"].get<std::string>()] = *reported;
  }
  if (!offers_.empty()) return std::nullopt;
  return Error{
      fmt::format("--scenes {}: no folder with parameters of scenes; {}", folder, kRemedy)};
}

std::string ScenePicker::list() const {
  json list = json::array();
  for (const auto& [name, reported] : offers_) list.push_back(reported);
  return text_of(list);
}

/// Only names that tactd has listed may become words of a command line.
std::optional<Error> ScenePicker::check(const Choice& choice) const {
  const auto offer = offers_.find(choice.scene);
  if (offer == offers_.end())
    return Error{fmt::format("there is no scene {} here", text_of(json(choice.scene)))};
  if (!choice.set.is_object()) return Error{"\"set\" has no numbers by key"};
  for (const auto& [key, value] : choice.set.items()) {
    const auto is_it = [&key](const json& row) { return row["key"] == key; };
    if (std::ranges::none_of(offer->second["parameters"], is_it))
      return Error{fmt::format("{} has no parameter {}", choice.scene, text_of(json(key)))};
    if (!value.is_number()) return Error{fmt::format("{} = {} is no number", key, text_of(value))};
  }
  return std::nullopt;
}

void ScenePicker::ask(const json& request) {
  const json scene = request.value("scene", json());
  const Choice choice{scene.is_string() ? scene.get<std::string>() : "",
                      request.value("set", json::object())};
  // Never for hardware: an operator who sees the device must start tactd.
  if (!is_simulated()) {
    answer_ = "a scene is chosen here in simulation only";
  } else if (asked_) {
    answer_ = "a scene is being started; ask again when it runs";
  } else if (const auto error = check(choice)) {
    answer_ = error->message;
  } else {
    answer_.clear();
    asked_ = choice;
    send_(line_of(choice));
  }
  publish();
}

/// The scene runs, and all that differs may change while it does.
bool ScenePicker::is_set_live(const Choice& choice) const {
  if (choice.scene != shown_.scene || choice.set == shown_.set) return false;
  return std::ranges::all_of(offers_.at(choice.scene)["parameters"], [&](const json& row) {
    const std::string key = row["key"];
    return row.value("live", false) ||
           choice.set.value(key, row["value"]) == shown_.set.value(key, row["value"]);
  });
}

std::string ScenePicker::line_of(const Choice& choice) const {
  const bool is_live = is_set_live(choice);
  std::string line = (is_live ? "set " : "request ") + choice.scene;
  if (is_live) {
    for (const json& row : offers_.at(choice.scene)["parameters"]) {
      const std::string key = row["key"];
      const json value = choice.set.value(key, row["value"]);
      if (value != shown_.set.value(key, row["value"]))
        line += fmt::format(" {}={}", key, text_of(value));
    }
  } else {
    for (const auto& [key, value] : choice.set.items())
      line += fmt::format(" {}={}", key, text_of(value));
  }
  return line;
}

bool ScenePicker::is_simulated() const { return view_.has_scene() && view_.header().simulated; }

void ScenePicker::begin() {
  const std::string& name = view_.header().scene_name;
  const auto asked = std::exchange(asked_, std::nullopt);
  note_.clear();
  if (asked) answer_.clear();
  if (asked && asked->scene == name)
    shown_ = *asked;
  else if (shown_.scene != name)
    shown_ = {.scene = name};
  publish();
}

void ScenePicker::answer(const std::string& line) {
  const auto asked = std::exchange(asked_, std::nullopt);
  const bool is_done = asked && line.starts_with(kDone);
  if (is_done) shown_ = *asked;
  note_ = is_done ? line.substr(kDone.size()) : "";
  answer_ = is_done ? "" : line;
  publish();
}

void ScenePicker::publish() {
  if (offers_.empty() || !is_simulated()) return view_.report_picker(nullptr);
  view_.report_picker({{"scene", shown_.scene},
                       {"set", shown_.set},
                       {"asked", asked_ ? asked_->scene : ""},
                       {"answer", answer_},
                       {"note", note_}});
}

}  // namespace tact::host::server
