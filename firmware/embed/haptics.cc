// SPDX-License-Identifier: Apache-2.0
#include "firmware/embed/haptics.h"

#include <algorithm>
#include <utility>

#include "firmware/gate/limits_for.h"
#include "model/scene/variant.h"

namespace tact::firmware::embed {

using loop::OfferedContact;
using model::contact::Contact;

/// A tissue that was set, and the contact with it.
struct Haptics::Made {
  Made(model::scene::Variant from, std::uint32_t number)
      : variant(std::move(from)), offer{number, Contact(variant.tissue->contact_scene())} {}

  model::scene::Variant variant;
  OfferedContact offer;
};

Haptics::Haptics() = default;
Haptics::~Haptics() = default;

model::Result<std::unique_ptr<Haptics>> Haptics::make(const std::string& scene_path,
                                                      const HapticsSettings& settings) {
  auto scene = model::scene::load_scene(scene_path, settings.set);
  if (!scene) return scene.error();
  std::unique_ptr<Haptics> out(new Haptics);
  out->scene_ = std::make_unique<const model::scene::Scene>(std::move(*scene));
  auto own = make_variant(*out->scene_, {});
  if (!own) return own.error();
  const Made& made = out->made_.emplace_back(std::move(*own), 0);
  const double period_s = 1.0 / out->scene_->rate_Hz;
  const double share = settings.hard_real_time ? 1.0 : gate::kNonRtForceShare;
  const model::Limits limits = settings.device
                                   ? gate::limits_for(out->scene_->limits, *settings.device)
                                   : out->scene_->limits;
  out->controller_ = std::make_unique<loop::Controller>(made.variant.tissue->contact_scene(),
                                                        gate::Gate(limits, period_s, share),
                                                        settings.hard_real_time);
  return out;
}

loop::TickOutput Haptics::tick(const hal::Sample& sample, std::uint32_t skipped_periods,
                               model::Fault device_fault) RT_SAFE {
  contacts_.take(*controller_, input_);
  in_use_.store(input_.variant, std::memory_order_release);
  input_.sample = sample;
  input_.skipped_periods = skipped_periods;
  input_.device_fault = device_fault;
  input_.commands = std::exchange(commands_, {});
  return controller_->tick(input_);
}

std::optional<model::Error> Haptics::set(const std::vector<std::string>& numbers) {
  auto all = model::scene::merged(numbers_, numbers);
  auto variant = make_variant(*scene_, all);
  if (!variant) return variant.error();
  numbers_ = std::move(all);
  Made& made = made_.emplace_back(std::move(*variant), ++count_);
  // One that no tick has taken is never used; nor is any before the one in use.
  const OfferedContact* const replaced = contacts_.offer(made.offer);
  const std::uint32_t in_use = in_use_.load(std::memory_order_acquire);
  made_.remove_if([&](const Made& old) {
    return &old.offer == replaced || (old.offer.variant < in_use && old.offer.variant > 0);
  });
  return std::nullopt;
}

}  // namespace tact::firmware::embed
