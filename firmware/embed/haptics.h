// SPDX-License-Identifier: Apache-2.0
// haptics.h - a scene in a program with its own loop: from a sample of the tool to the force that
// the device may get.
//
//     const auto made = tact::Haptics::make("liver.toml");
//     if (!made) return report(made.error().message);
//     tact::Haptics& haptics = **made;
//     haptics.arm();                                       // on the request of a person
//     const auto out = haptics.tick(sample);               // once a period, out.written
//     haptics.set({"elastic.youngs_modulus_Pa=4000"});     // used when the tool is out of contact
#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/gate/gate.h"
#include "firmware/loop/contact_exchange.h"
#include "firmware/loop/controller.h"
#include "hal/device.h"
#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::firmware::embed {

/// How a scene is used.
struct HapticsSettings {
  std::vector<std::string> set{};  // KEY=VALUE, as tactd --set takes them
  /// Limits of the device; those of the scene hold as well. nullopt: those of the scene alone.
  std::optional<hal::DeviceInfo> device{};
  // false: a quarter of the force limit, and an overrun fault after 100 late periods, not 20
  bool hard_real_time = false;
};

class Haptics {
 public:
  /// Set-up code: reads scene, meshes and map. The error names file, line and what is allowed. Does
  /// not check whether your device can render so stiff a law; tactd does (firmware/admission).
  static model::Result<std::unique_ptr<Haptics>> make(const std::string& scene_path,
                                                      const HapticsSettings& settings = {});
  Haptics(const Haptics&) = delete;
  Haptics& operator=(const Haptics&) = delete;
  ~Haptics();

  /// One period; from one thread. `skipped_periods`: before this one, if the loop was late.
  /// `device_fault`: of the last read or write. Write `written` to the device, and no other force.
  loop::TickOutput tick(const hal::Sample& sample, std::uint32_t skipped_periods = 0,
                        model::Fault device_fault = model::Fault::kNone) RT_SAFE;

  /// Requests for the next tick, from the thread that calls tick(). arm() acts in state Ready only;
  /// after a fault it needs reset() in an earlier tick.
  void arm() RT_SAFE { commands_.arm = true; }
  void disarm() RT_SAFE { commands_.disarm = true; }
  void reset() RT_SAFE { commands_.reset = true; }

  /// Prepares other numbers of the law; takes some tenths of a second, so not in the loop. The tick
  /// uses them as soon as the tool is out of contact. Other keys keep their values. One thread at a
  /// time.
  std::optional<model::Error> set(const std::vector<std::string>& numbers);
  /// All numbers that were set are in use.
  bool is_set() const { return !contacts_.is_pending(); }

  /// Contacts of the last tick, one for each sphere of the tool.
  std::span<const model::contact::SphereContact> contacts() const RT_SAFE {
    return controller_->contacts();
  }
  const model::scene::Scene& scene() const { return *scene_; }
  /// In use: that of scene and device, without hard real time a quarter of it.
  double force_limit_N() const { return controller_->gate().force_limit_N(); }

 private:
  struct Made;
  Haptics();

  std::unique_ptr<const model::scene::Scene> scene_;
  std::list<Made> made_;  // the scene's own tissue first
  std::unique_ptr<loop::Controller> controller_;
  std::vector<std::string> numbers_;  // set so far, the newest last
  std::uint32_t count_ = 0;           // of set()
  loop::ContactExchange contacts_;
  std::atomic<std::uint32_t> in_use_{0};
  loop::Commands commands_;
  loop::TickInput input_;
};

}  // namespace tact::firmware::embed

namespace tact {
using firmware::embed::Haptics;
using firmware::embed::HapticsSettings;
}  // namespace tact
