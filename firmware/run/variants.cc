// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "firmware/admission/stiffness_check.h"
#include "firmware/pc/rt_setup.h"

namespace tact::firmware::run {
namespace {

// Of poll(): the answer comes within a second, also while the tool touches.
constexpr int kMaxTurns = 5;

std::string key_of(const std::string& set) { return set.substr(0, set.find('=')); }

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

model::Result<std::unique_ptr<Variants>> Variants::make(const model::scene::Scene& scene,
                                                        const LoopParts& parts,
                                                        loop::Requests& requests,
                                                        loop::ContactExchange& contacts,
                                                        telemetry::Telemetry& telemetry) {
  std::unique_ptr<Variants> made(new Variants(scene, parts, requests, contacts, telemetry));
  auto thread = hal::threads::start_thread("tact-law", [&variants = *made] { variants.run(); });
  if (!thread) return thread.error();
  made->thread_ = std::move(*thread);
  return made;
}

Variants::~Variants() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

std::optional<std::string> Variants::why_not(const std::vector<std::string>& set) const {
  if (waiting_) return "other numbers are being prepared; ask again";
  if (set.empty()) return "no number is named; write KEY=VALUE";
  if (hal::registry::is_simulated(scene_.device)) return std::nullopt;
  for (const std::string& each : set)
    if (std::ranges::find(scene_.live, key_of(each)) == scene_.live.end())
      return fmt::format("the device is hardware, and the scene has no [[live]] with key = \"{}\"",
                         key_of(each));
  return std::nullopt;
}

std::string Variants::refuse(const console::ControlRequest& request, const std::string& why) const {
  requests_.refused.fetch_add(1);
  request.answer({.done = false, .message = "not set: " + why});
  return "not set: " + why;
}

std::optional<std::string> Variants::ask(console::ControlRequest request, const std::string& set) {
  const std::vector<std::string> words = words_of(set);
  if (const auto why = why_not(words)) return refuse(request, *why);
  asked_ = set_;
  asked_what_ = fmt::format("{}", fmt::join(words, " "));
  for (const std::string& word : words) {
    std::erase_if(asked_, [&](const std::string& old) { return key_of(old) == key_of(word); });
    asked_.push_back(word);
  }
  waiting_.emplace(std::move(request));
  turns_left_ = kMaxTurns;
  is_in_work_ = true;
  const std::lock_guard lock(mutex_);
  job_ = asked_;
  changed_.notify_one();
  return std::nullopt;
}

void Variants::run() {
  pc::flush_denormals();  // as a replay that makes the same tissue
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || job_; });
    if (ends_) return;
    const auto set = std::exchange(job_, std::nullopt);
    lock.unlock();
    Outcome outcome = make(*set);
    lock.lock();
    outcome_ = std::move(outcome);
  }
}

Variants::Outcome Variants::make(const std::vector<std::string>& set) const {
  auto variant = make_variant(scene_, set);
  if (!variant) return variant.error();
  const hal::DeviceInfo device = parts_.device->info();
  const auto stiffness = admission::check_renderable(*variant->scene, *variant->tissue, device);
  if (!stiffness) return stiffness.error();
  const auto presses = admission::check_presses(*variant->scene, variant->tissue->law(), device,
                                                stiffness->limit_N_per_m);
  if (!presses) return presses.error();
  return std::make_unique<Made>(std::move(*variant));
}

std::optional<std::string> Variants::poll() {
  forget_old();
  std::optional<Outcome> outcome;
  {
    const std::lock_guard lock(mutex_);
    outcome = std::exchange(outcome_, std::nullopt);
  }
  if (outcome) is_in_work_ = false;
  if (outcome && !*outcome) return refuse(take_waiting(), outcome->error().message);
  if (outcome) offer(std::move(**outcome));
  const bool is_used = !contacts_.is_pending();
  if (!is_offered_) return std::nullopt;
  // While a newer request is prepared, the older offer does not answer it.
  const bool is_waited_for = waiting_ && !is_in_work_;
  if (!is_used && !(is_waited_for && --turns_left_ == 0)) return std::nullopt;
  is_offered_ = !is_used;
  std::string report = fmt::format(
      "{}{}", what_, is_used ? ": set" : ": prepared, used as soon as the tool is out of contact");
  if (is_waited_for) take_waiting().answer({.done = true, .message = report});
  return report;
}

console::ControlRequest Variants::take_waiting() {
  console::ControlRequest request = std::move(*waiting_);
  waiting_.reset();
  return request;
}

void Variants::offer(std::unique_ptr<Made> made) {
  set_ = asked_;
  what_ = asked_what_;
  is_offered_ = true;
  made->contact.variant = ++count_;
  telemetry_.expect_variant(count_, set_, made->variant.tissue->law().contact_law());
  loop::OfferedContact* const before = contacts_.offer(made->contact);
  // The loop has not taken it, and cannot any more.
  if (before != nullptr)
    std::erase_if(kept_, [before](const auto& kept) { return &kept->contact == before; });
  kept_.push_back(std::move(made));
}

// Telemetry may still draw the one that is in use, and those before it.
void Variants::forget_old() {
  while (kept_.size() > 1 && (*std::next(kept_.begin()))->contact.variant <= telemetry_.variant())
    kept_.pop_front();
}

}  // namespace tact::firmware::run
