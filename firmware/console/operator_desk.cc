// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/operator_desk.h"

#include <fmt/format.h>
#include <unistd.h>

#include "firmware/console/control_name.h"
#include "model/io/socket_file.h"

namespace tact::firmware::console {
namespace {

constexpr const char* kTooEarly = "the request came before it was ready";

}  // namespace

void OperatorDesk::obey(std::int64_t longest_ns) {
  const Act act = signals_.wait(longest_ns, control_ != nullptr ? control_->fd() : -1);
  // Taken before show(): what was asked before the words
  // were told must not count as an answer to them.
  const auto asked = next_by_socket();
  if (act == Act::kLeave) stop();
  const bool just_told = show();
  if (act == Act::kReset) reset(just_told);
  if (act == Act::kArm) arm(just_told);
  if (asked) asked->answer(do_word(asked->word(), just_told));
}

std::optional<ControlRequest> OperatorDesk::next_by_socket() const {
  return control_ != nullptr ? control_->next() : std::nullopt;
}

// A request that came before the words, and be it in the moment before, is no answer to them.
bool OperatorDesk::show() {
  if (!view_.show(newest_())) return false;
  for (int early = signals_.forget(); early > 0; --early) refuse("armed or reset", kTooEarly);
  while (const auto early = next_by_socket()) early->answer(do_word(early->word(), true));
  return true;
}

Answer OperatorDesk::do_word(const std::string& word, bool too_early) {
  if (word == "arm") return arm(too_early);
  if (word == "reset") return reset(too_early);
  if (word == "disarm") return disarm();
  if (word == "stop") return stop();
  if (word == "status") return {.done = true, .sentence = view_.status()};
  return {.done = false, .sentence = "arm, disarm, reset, stop and status are known, nothing else"};
}

Answer OperatorDesk::arm(bool too_early) {
  if (too_early) return refuse("armed", kTooEarly);
  if (const std::string why = view_.why_not_arm(); !why.empty()) return refuse("armed", why);
  // The loop answers by its counter: it is asked, and counts what it could not do.
  const std::uint32_t before = requests_.refused.load();
  signals_.raise_edge(requests_.arm);
  if (requests_.refused.load() == before)
    return {.done = true, .sentence = view_.device() + ": armed, force is on"};
  constexpr const char* kNotThen =
      "not armed: no power, or no good sample in that moment; look, and "
      "arm again";
  view_.tell(kNotThen);
  return {.done = false, .sentence = fmt::format("{}: {}", view_.device(), kNotThen)};
}

Answer OperatorDesk::reset(bool too_early) {
  if (too_early) return refuse("reset", kTooEarly);
  if (const std::string why = view_.why_not_reset(); !why.empty()) return refuse("reset", why);
  signals_.raise_edge(requests_.reset);
  return {.done = true,
          .sentence = view_.device() + ": reset; it is ready when its cause is gone, then arm it"};
}

// Force goes away by it: never too early, and asked of the loop whatever was shown last.
Answer OperatorDesk::disarm() {
  signals_.raise_edge(requests_.disarm);
  return {.done = true,
          .sentence = view_.device() + ": no force; arm it again when it shall have one"};
}

Answer OperatorDesk::stop() {
  // The one request that is never refused.
  requests_.stop.store(true);
  return {.done = true, .sentence = view_.device() + ": force to zero, then tactd ends"};
}

Answer OperatorDesk::refuse(const char* what, const std::string& why) const {
  // Counted with those that the loop refuses: the report has one number.
  requests_.refused.fetch_add(1);
  view_.tell(fmt::format("not {}: {}", what, why));
  return {.done = false, .sentence = fmt::format("{}: not {}: {}", view_.device(), what, why)};
}

std::unique_ptr<ControlSocket> open_control(const std::string& scene_path,
                                            const OperatorView& view) {
  const auto folder = model::io::runtime_directory();
  auto control = folder ? ControlSocket::open(control_path(*folder, scene_path, getpid()))
                        : model::Result<std::unique_ptr<ControlSocket>>(folder.error());
  if (control) return std::move(*control);
  view.tell(fmt::format("tactctl does not reach this tactd, only signals do: {}",
                        control.error().sentence));
  return nullptr;
}

}  // namespace tact::firmware::console
