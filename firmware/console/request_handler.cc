// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/request_handler.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <ctime>
#include <iterator>
#include <limits>

#include "firmware/console/control_name.h"
#include "firmware/loop/clock.h"
#include "model/io/socket_file.h"
#include "model/time_ns.h"

namespace tact::firmware::console {
namespace {

constexpr const char* kTooEarly = "the request came before it was ready";
// Chosen: five periods of the lowest rate, and more than a stock kernel delays a tick.
constexpr std::int64_t kSilence_ns = 50 * model::kMillisecond_ns;
constexpr int kMaxPauses = 200;  // of 1 ms; at the lowest rate a tick is 10 ms

}  // namespace

void pause_a_moment() {
  constexpr timespec kMoment{.tv_sec = 0, .tv_nsec = model::kMillisecond_ns};
  nanosleep(&kMoment, nullptr);
}

void RequestHandler::serve(std::int64_t longest_ns) {
  const bool ends = signals_.wait_for_end(longest_ns, control_ != nullptr ? control_->fd() : -1);
  // Taken before show(): a request made before the ready message must not count as a response to
  // it.
  auto asked = next_request();
  if (ends) stop();
  const bool just_reported = show();
  if (asked) handle(std::move(*asked), just_reported);
}

std::optional<ControlRequest> RequestHandler::next_request() const {
  return control_ != nullptr ? control_->next() : std::nullopt;
}

// Requests that arrived before the ready message, even just before it, are refused as too early.
bool RequestHandler::show() {
  if (!view_.show(newest())) return false;
  while (auto early = next_request()) handle(std::move(*early), true);
  return true;
}

// Other numbers of the law change no force where they are used, so no request is too early.
void RequestHandler::handle(ControlRequest request, bool too_early) {
  const std::string word = request.word();
  if (set_ && word.starts_with(kSetWord))
    return set_(std::move(request), word.substr(kSetWord.size()));
  request.answer(do_word(word, too_early));
}

protocol::Frame RequestHandler::newest() const {
  protocol::Frame frame = newest_();
  const loop::Shown now = progress_ != nullptr ? progress_->shown() : loop::Shown{};
  if (now.time_ns == 0) return frame;
  // A loop that no longer ticks cannot report the fault of its watch.
  const model::Fault found = requests_.fault.load();
  const bool is_new = now.fault == model::Fault::kNone && found != model::Fault::kNone;
  frame.state = is_new ? loop::State::kStopped : now.state;
  frame.fault = static_cast<std::uint16_t>(is_new ? found : now.fault);
  std::ranges::copy(now.force_N, std::begin(frame.force_N));
  return frame;
}

Answer RequestHandler::status() const {
  const loop::Shown now = progress_ != nullptr ? progress_->shown() : loop::Shown{};
  if (now.time_ns == 0) return {.done = true, .message = view_.status()};
  const std::int64_t age_ns = loop::MonotonicClock().now_ns() - now.time_ns;
  const std::string at =
      fmt::format("{}, {:.1f} ms ago", view_.status(), 1e-6 * static_cast<double>(age_ns));
  if (age_ns < kSilence_ns) return {.done = true, .message = at};
  return {.done = false, .message = "not answered: the loop has stopped; " + at};
}

Answer RequestHandler::do_word(const std::string& word, bool too_early) {
  if (word == "arm") return arm(too_early);
  if (word == "reset") return reset(too_early);
  if (word == "disarm") return disarm();
  if (word == "stop") return stop();
  if (word == "status") return status();
  if (word.starts_with("event ")) return event(word.substr(strlen("event ")));
  return {.done = false,
          .message = "arm, disarm, reset, stop, status, set and event are known, nothing else"};
}

Answer RequestHandler::arm(bool too_early) {
  if (too_early) return refuse("armed", kTooEarly);
  if (const std::string why = view_.why_not_arm(); !why.empty()) return refuse("armed", why);
  const auto armed = ask_loop(loop::Request::kArm);
  if (armed == true) return {.done = true, .message = view_.device() + ": armed, force is on"};
  return not_done("armed", armed,
                  "no power, or no good sample in that moment; look, and arm again");
}

Answer RequestHandler::reset(bool too_early) {
  if (too_early) return refuse("reset", kTooEarly);
  if (const std::string why = view_.why_not_reset(); !why.empty()) return refuse("reset", why);
  const auto ready = ask_loop(loop::Request::kReset);
  if (ready != true) return not_done("reset", ready, "its cause is not gone, or no good sample");
  return {.done = true, .message = view_.device() + ": reset, ready; arm it"};
}

// Removes force, so it is never too early and does not depend on the frame shown last.
Answer RequestHandler::disarm() {
  // Not withdrawn: a loop that ticks again later removes the force then.
  const auto off = wait_for(requests_.ask(loop::Request::kDisarm));
  if (!off)
    return not_done("disarmed", false,
                    "the loop gives no answer; its next tick takes the force away");
  if (!*off) return not_done("disarmed", off, "it is armed again");
  view_.wait_for_person();
  const bool stopped = newest().state == loop::State::kStopped;
  return {
      .done = true,
      .message = view_.device() + (stopped ? ": no force; it has stopped: reset it, then arm it"
                                           : ": no force; arm it again when it shall have one")};
}

// A request that no tick has taken by the timeout is withdrawn, so that it cannot act later. It may
// still succeed if a tick had already taken it.
std::optional<bool> RequestHandler::ask_loop(loop::Request request) {
  const std::uint32_t number = requests_.ask(request);
  if (const auto answer = wait_for(number)) return answer;
  requests_.take_back();
  return wait_for(number) == true ? std::optional(true) : std::nullopt;
}

// Waits for the echo of a request, at most kMaxPauses.
std::optional<bool> RequestHandler::wait_for(std::uint32_t number) {
  for (int i = 0; i < kMaxPauses; ++i) {
    if (const auto answer = requests_.answer(number)) return answer;
    pause_();
  }
  return std::nullopt;
}

Answer RequestHandler::not_done(const char* what, const std::optional<bool>& answer,
                                const char* why) const {
  const auto words = fmt::format("not {}: {}", what, answer ? why : "the loop gives no answer");
  view_.report(words);
  return {.done = false, .message = fmt::format("{}: {}", view_.device(), words)};
}

Answer RequestHandler::stop() {
  // A stop is never refused.
  requests_.stop.store(true);
  return {.done = true, .message = view_.device() + ": force to zero, then tactd ends"};
}

// Into the record of one tick. It changes no force, so it is never too early.
Answer RequestHandler::event(std::string_view number_text) {
  constexpr std::uint8_t kMax_event = std::numeric_limits<std::uint8_t>::max();
  std::uint64_t now = 0;
  const char* const end = number_text.data() + number_text.size();
  const auto read = std::from_chars(number_text.data(), end, now);
  if (read.ec != std::errc{} || read.ptr != end || now < 1 || now > kMax_event)
    return {.done = false, .message = "event takes a number from 1 to 255"};
  const std::uint64_t number = now;
  requests_.event.store(number);
  for (int i = 0; i < kMaxPauses && (now & kMax_event) != 0; ++i) {
    pause_();
    now = requests_.event.load();
  }
  if ((now & kMax_event) != 0 && requests_.event.compare_exchange_strong(now, 0))
    return {.done = false, .message = view_.device() + ": no event: the loop gives no answer"};
  return {.done = true, .message = fmt::format("event {} in tick {}", number, (now >> 8) - 1)};
}

Answer RequestHandler::refuse(const char* what, const std::string& why) const {
  // Counted with the loop's own refusals, so the report has one number.
  requests_.refused.fetch_add(1);
  view_.report(fmt::format("not {}: {}", what, why));
  return {.done = false, .message = fmt::format("{}: not {}: {}", view_.device(), what, why)};
}

std::unique_ptr<ControlSocket> open_control(const std::string& scene_path,
                                            const OperatorView& view) {
  const auto folder = model::io::runtime_directory();
  auto control = folder ? ControlSocket::open(control_path(*folder, scene_path, getpid()))
                        : model::Result<std::unique_ptr<ControlSocket>>(folder.error());
  if (control) return std::move(*control);
  view.report(fmt::format("tactctl does not reach this tactd, so it cannot be armed: {}",
                          control.error().message));
  return nullptr;
}

}  // namespace tact::firmware::console
