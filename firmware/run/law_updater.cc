// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/law_updater.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "firmware/admission/stiffness_check.h"
#include "firmware/pc/rt_setup.h"

namespace tact::firmware::run {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

LawUpdater::State LawUpdater::next(State state, Event event) {
  switch (event) {
    case Event::kRequested:
      return state == State::kDeferred ? State::kReplacing : State::kPreparing;
    case Event::kFailed:
      return state == State::kReplacing ? State::kDeferred : State::kIdle;
    case Event::kPrepared:
      return State::kOffered;
    case Event::kUsed:
      return state == State::kReplacing ? State::kPreparing : State::kIdle;
    case Event::kTimedOut:
      return State::kDeferred;
  }
  return state;
}

model::Result<std::unique_ptr<LawUpdater>> LawUpdater::make(const Use& use) {
  std::unique_ptr<LawUpdater> made(new LawUpdater(use));
  auto thread = hal::threads::start_thread("tact-law", [&updater = *made] { updater.run(); });
  if (!thread) return thread.error();
  made->thread_ = std::move(*thread);
  return made;
}

LawUpdater::~LawUpdater() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

std::optional<std::string> LawUpdater::why_not(const std::vector<std::string>& set) const {
  if (waits(state_)) return "other numbers are being prepared; ask again";
  if (set.empty()) return "no number is named; write KEY=VALUE";
  if (hal::registry::is_simulated(use_.scene.device)) return std::nullopt;
  for (const std::string& each : set)
    if (const std::string key = each.substr(0, each.find('='));
        std::ranges::find(use_.scene.live, key) == use_.scene.live.end())
      return fmt::format("the device is hardware, and the scene has no [[live]] with key = \"{}\"",
                         key);
  return std::nullopt;
}

std::string LawUpdater::refuse(const console::ControlRequest& request,
                               const std::string& why) const {
  use_.requests.refused.fetch_add(1);
  request.answer({.done = false, .message = "not set: " + why});
  return "not set: " + why;
}

std::optional<std::string> LawUpdater::request(console::ControlRequest request,
                                               const std::string& set) {
  const std::vector<std::string> words = words_of(set);
  if (const auto why = why_not(words)) return refuse(request, *why);
  requested_ = {.set = model::scene::merged(offered_.set, words),
                .named = fmt::format("{}", fmt::join(words, " "))};
  waiting_.emplace(std::move(request));
  state_ = next(state_, Event::kRequested);
  const std::lock_guard lock(mutex_);
  job_ = requested_.set;
  changed_.notify_one();
  return std::nullopt;
}

void LawUpdater::run() {
  pc::flush_denormals();  // as a replay that makes the same tissue
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || job_; });
    if (ends_) return;
    const auto set = std::exchange(job_, std::nullopt);
    lock.unlock();
    Outcome outcome = prepare(*set);
    lock.lock();
    outcome_ = std::move(outcome);
  }
}

LawUpdater::Outcome LawUpdater::prepare(const std::vector<std::string>& set) const {
  auto variant = make_variant(use_.scene, set);
  if (!variant) return variant.error();
  const hal::DeviceInfo device = use_.device.info();
  const auto stiffness = admission::check_renderable(*variant->scene, *variant->tissue, device);
  if (!stiffness) return stiffness.error();
  const auto presses =
      admission::check_presses(*variant->scene, *variant->tissue, device, stiffness->limit_N_per_m);
  if (!presses) return presses.error();
  return std::make_unique<Prepared>(std::move(*variant));
}

std::optional<std::string> LawUpdater::poll() {
  forget_old();
  std::unique_lock lock(mutex_);
  auto outcome = std::exchange(outcome_, std::nullopt);
  lock.unlock();
  std::string older;  // its client has its answer
  if (outcome && state_ == State::kReplacing && !use_.contacts.is_pending()) {
    state_ = next(state_, Event::kUsed);
    older = offered_.named + ": set";
  }
  if (outcome) {
    state_ = next(state_, *outcome ? Event::kPrepared : Event::kFailed);
    if (!*outcome) {
      const std::string refused = refuse(take_waiting(), outcome->error().message);
      return older.empty() ? refused : older + "; " + refused;
    }
    offer(std::move(**outcome));
    if (!older.empty()) return older;
  }
  if (state_ == State::kIdle || state_ == State::kPreparing) return std::nullopt;
  const bool is_used = !use_.contacts.is_pending();
  // In kReplacing the older offer does not answer the newer request.
  const bool is_waited_for = state_ == State::kOffered;
  if (!is_used && !(is_waited_for && --polls_left_ == 0)) return std::nullopt;
  state_ = next(state_, is_used ? Event::kUsed : Event::kTimedOut);
  std::string report =
      offered_.named +
      (is_used ? ": set" : ": prepared, used as soon as the tool is out of contact");
  if (is_waited_for) take_waiting().answer({.done = true, .message = report});
  return report;
}

console::ControlRequest LawUpdater::take_waiting() {
  console::ControlRequest request = std::move(*waiting_);
  waiting_.reset();
  return request;
}

void LawUpdater::offer(std::unique_ptr<Prepared> prepared) {
  offered_ = requested_;
  polls_left_ = kMaxPolls;
  prepared->contact.variant = ++count_;
  use_.telemetry.expect_variant(count_, offered_.set,
                                prepared->variant.tissue->law().contact_law());
  loop::OfferedContact* const before = use_.contacts.offer(prepared->contact);
  // The loop has not taken it, and cannot any more.
  if (before != nullptr)
    std::erase_if(kept_, [before](const auto& kept) { return &kept->contact == before; });
  kept_.push_back(std::move(prepared));
}

// Telemetry may still draw the one that is in use, and those before it.
void LawUpdater::forget_old() {
  while (kept_.size() > 1 &&
         (*std::next(kept_.begin()))->contact.variant <= use_.telemetry.variant())
    kept_.pop_front();
}

}  // namespace tact::firmware::run
