// SPDX-License-Identifier: Apache-2.0
// scene_wish.h - what a page may ask of a session in simulation: another scene, or other numbers of
// its law; and which wish is good.
//
//     {"wish": {"scene": "heart", "set": {"disc_stack.layers": 12}}}
//
// What is offered stands in files of `tactd SCENE --parameters --json`: names, keys and ranges are
// those of tactd. A wish is only passed on (scene_picker.h).
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/result.h"

namespace tact::host::server {

struct SceneWish {
  std::string scene;
  std::map<std::string, double> set{};  // by key; what it does not name is as shipped
};

using AskScene = std::function<void(const SceneWish&)>;

/// None if the message has no "wish", or one of another form.
std::optional<SceneWish> parse_scene_wish(const std::string& text);

/// A number that may be set, its ends included.
struct OfferedNumber {
  double low = 0.0, high = 0.0;
  bool is_whole = false;
};

struct OfferedScene {
  std::string name;
  std::map<std::string, OfferedNumber> numbers;  // by key
  std::string told;                              // its file, for the page
};

/// Of one file. Error: it is none of tactd's, or of a scene that is not simulated.
model::Result<OfferedScene> parse_offer(const std::string& text, const std::string& source);
/// Of every *.json of a folder, by name.
model::Result<std::vector<OfferedScene>> load_offers(const std::string& folder);

/// Their files as one JSON list.
std::string list_of(const std::vector<OfferedScene>& offers);

/// Empty: it may be passed on.
std::string why_not(const SceneWish& wish, const std::vector<OfferedScene>& offers);

/// "wish heart disc_stack.layers=12": words that a shell can read, of a wish that is good.
std::string line_of(const SceneWish& wish);

}  // namespace tact::host::server
