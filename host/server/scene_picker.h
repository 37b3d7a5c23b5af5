// SPDX-License-Identifier: Apache-2.0
// scene_picker.h - which scenes of a simulation a page may choose, what one asked for, and what
// came of it, as the status's "picker".
//
//     {"request": {"scene": "heart", "set": {"disc_stack.layers": 12}}}
//
// tact-view starts and sets nothing: a request becomes a line for the program that started it
// (tools/run), which starts tactd again or answers why not. tactd alone checks the numbers; here
// only names are compared with what it offers. One request at a time.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/server/live_view.h"
#include "model/result.h"

namespace tact::host::server {

class ScenePicker {
 public:
  using Send = std::function<void(const std::string& line)>;
  /// `view` outlives it.
  ScenePicker(LiveView& view, Send send) : view_(view), send_(std::move(send)) {}

  /// Offers the scenes of a folder: one file of `tactd SCENE --parameters --json` each.
  std::optional<model::Error> load(const std::string& folder);
  /// The files as one JSON list, by name of the scene.
  std::string list() const;

  /// Of a page.
  void ask(const nlohmann::json& request);
  /// After LiveView::begin: what was asked for may be what runs now.
  void begin();
  /// The program that started tact-view did not start what was asked for, and why.
  void refuse(const std::string& reason);

 private:
  struct Choice {
    std::string scene;
    nlohmann::json set = nlohmann::json::object();  // numbers by key, the others as shipped
  };
  bool is_simulated() const;
  std::optional<model::Error> check(const Choice& choice) const;
  void publish();

  LiveView& view_;
  Send send_;
  std::map<std::string, nlohmann::json> offers_;  // the files, by name of the scene
  Choice shown_;                                  // what runs
  std::optional<Choice> asked_;                   // and does not run yet
  std::string answer_;                            // why the last request was refused; or empty
};

}  // namespace tact::host::server
