// SPDX-License-Identifier: Apache-2.0
// scene_picker.h - the scenes of a simulation that a page may choose, the request of a page and its
// result, as the status's "picker".
//
//     {"request": {"scene": "heart", "set": {"disc_stack.layers": 12}}}
//
// tact-view starts and sets nothing: a request becomes a line for the program that started it
// (tools/run), which starts tactd again, or sets the numbers while it runs, or answers with the
// reason. Only tactd checks the numbers; here only the names are compared with the offered ones.
// One request at a time.
//
//     request SCENE KEY=VALUE ...   another start; keys that are not named are as shipped
//     set SCENE KEY=VALUE ...       while the scene runs; other keys keep their values
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
  /// `view` must outlive the picker.
  ScenePicker(LiveView& view, Send send) : view_(view), send_(std::move(send)) {}

  /// Offers the scenes of a folder: one file of `tactd SCENE --parameters --json` each.
  std::optional<model::Error> load(const std::string& folder);
  /// The files as one JSON list, by name of the scene.
  std::string list() const;

  /// A request of a page.
  void ask(const nlohmann::json& request);
  /// Call after LiveView::begin: compares the scene that now runs with the request.
  void begin();
  /// The answer of the program that started tact-view: "done" and what it says about numbers that
  /// it has set, or the reason of a refusal.
  void answer(const std::string& line);

 private:
  struct Choice {
    std::string scene;
    nlohmann::json set = nlohmann::json::object();  // numbers by key, the others as shipped
  };
  bool is_simulated() const;
  std::optional<model::Error> check(const Choice& choice) const;
  bool is_set_live(const Choice& choice) const;
  std::string line_of(const Choice& choice) const;
  void publish();

  LiveView& view_;
  Send send_;
  std::map<std::string, nlohmann::json> offers_;  // the files, by name of the scene
  Choice shown_;                                  // the scene that runs
  std::optional<Choice> asked_;                   // the pending request
  std::string answer_;                            // why the last request was refused; or empty
  std::string note_;                              // about the numbers that were set last
};

}  // namespace tact::host::server
