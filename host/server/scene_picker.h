// SPDX-License-Identifier: Apache-2.0
// scene_picker.h - what pages may choose in a session in simulation, what they asked for, and what
// came of it, as the status's "picker".
//
// tact-view starts and tunes nothing: a good wish is handed to who has started it (tools/run), and
// that starts tactd anew or says why not. One wish at a time.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/server/live_view.h"
#include "host/server/scene_wish.h"

namespace tact::host::server {

class ScenePicker {
 public:
  using Hand = std::function<void(const std::string& line)>;
  /// `view` outlives it.
  ScenePicker(LiveView& view, std::vector<OfferedScene> offers, Hand hand);

  /// Of a page.
  void ask(const SceneWish& wish);
  /// After LiveView::begin: what was asked for may be what runs now.
  void begin();
  /// It did not come to what was asked for, and why.
  void refuse(const std::string& sentence);

 private:
  bool is_simulated() const;
  void tell();

  LiveView& view_;
  std::vector<OfferedScene> offers_;
  Hand hand_;
  SceneWish shown_;                 // what runs
  std::optional<SceneWish> asked_;  // and has not come yet
  std::string answer_;              // why the last wish was refused; or empty
};

}  // namespace tact::host::server
