// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/gpio_lines.h"

#include <fmt/format.h>
#include <sys/syscall.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "hal/gpio/line_request.h"
#include "hal/gpio/safety_logic.h"

namespace tact::hal::gpio {
namespace {

using model::Error;
using model::Fault;
using model::Result;

constexpr const char* kConsumer = "tactd";

/// The requested lines, and the place of each in its request; -1: not wired.
struct Groups {
  LineRequest inputs, outputs, scope;
  int estop_a = -1, estop_b = -1, dead_man = -1, grip = -1, clutch = -1;
  int enable = -1, heartbeat = -1, led = -1, sync = -1;
  std::array<int, kEventKeys.size()> event{};
  bool grip_closes_low = false;
};

class GpioLines final : public SafetyLines {
 public:
  GpioLines(Chip chip, Groups lines)
      : chip_(std::move(chip)),
        lines_(std::move(lines)),
        logic_({.estop = lines_.estop_a >= 0,
                .dead_man = lines_.dead_man >= 0,
                .grip = lines_.grip >= 0,
                .clutch = lines_.clutch >= 0}) {}
  ~GpioLines() override { release(); }
  GpioLines(const GpioLines&) = delete;
  GpioLines& operator=(const GpioLines&) = delete;

  Fault read(std::int64_t now_ns) RT_SAFE override {
    // A failed read leaves zeros: every contact open, which is a stop.
    Levels values{};
    if (!is_lost() && !lines_.inputs.empty() && !lines_.inputs.get(values)) lose();
    const Fault fault = logic_.evaluate({.estop_a = level(values, lines_.estop_a),
                                         .estop_b = level(values, lines_.estop_b),
                                         .dead_man = level(values, lines_.dead_man),
                                         .grip = grip_pressed(values),
                                         .clutch = level(values, lines_.clutch)},
                                        now_ns);
    event_word_ = 0;
    for (std::size_t i = 0; i < kEventKeys.size(); ++i)
      if (level(values, lines_.event[i])) event_word_ |= static_cast<std::uint8_t>(1U << i);
    return is_lost() ? Fault::kLinesLost : fault;
  }

  Fault write(const LinesTick& tick) RT_SAFE override {
    const SafetyOutputs outputs = logic_.drive(tick);
    Levels values{};
    // drop() may come from the watch at any time; what it took away no tick gives back.
    set_level(values, lines_.enable, outputs.enable && !dropped());
    set_level(values, lines_.heartbeat, outputs.heartbeat && !dropped());
    set_level(values, lines_.led, outputs.led);
    set_level(values, lines_.sync, tick.sync);
    if (!is_lost() && !lines_.outputs.empty() && !lines_.outputs.set(values)) lose();
    return is_lost() ? Fault::kLinesLost : Fault::kNone;
  }

  std::optional<bool> grip() const RT_SAFE override { return logic_.grip(); }
  std::optional<bool> clutch() const RT_SAFE override { return logic_.clutch(); }
  std::uint8_t event_word() const RT_SAFE override { return event_word_; }
  bool enabled() const RT_SAFE override { return !is_lost() && !dropped() && logic_.enabled(); }

  // libgpiod 1.6 keeps the last level of each line in plain memory that is not read: two threads
  // here disturb no more than that.
  void drop() RT_SAFE override {
    // Before the levels, so that a write after this cannot raise them; one under way may, hence
    // "again" in safety_lines.h.
    dropped_.store(true, std::memory_order_relaxed);
    if (!is_lost() && !lines_.outputs.empty()) lines_.outputs.set({});
  }

  std::span<const int> loop_calls() const override {
    static constexpr std::array kCalls{SYS_ioctl};
    return kCalls;
  }

  void scope(bool up) RT_SAFE override {
    if (!is_lost() && !lines_.scope.empty()) lines_.scope.set({up ? 1 : 0});
  }

  std::string notice() const override { return logic_.notice(); }
  std::string fault_detail() const override {
    return text_of(is_lost() ? LinesCause::kChipLost : logic_.cause());
  }

  void stop() override { release(); }

 private:
  static bool level(const Levels& values, int place) RT_SAFE {
    return place >= 0 && values[static_cast<std::size_t>(place)] != 0;
  }
  // A chip that does not answer closes no jaws.
  bool grip_pressed(const Levels& values) const RT_SAFE {
    return !is_lost() && level(values, lines_.grip) != lines_.grip_closes_low;
  }
  static void set_level(Levels& values, int place, bool high) RT_SAFE {
    if (place >= 0) values[static_cast<std::size_t>(place)] = high ? 1 : 0;
  }
  bool is_lost() const RT_SAFE { return lost_.load(std::memory_order_relaxed); }
  void lose() RT_SAFE { lost_.store(true, std::memory_order_relaxed); }
  bool dropped() const RT_SAFE { return dropped_.load(std::memory_order_relaxed); }

  void release() {
    if (chip_.empty()) return;
    if (!lines_.outputs.empty()) lines_.outputs.set({});
    scope(false);
    lose();
    lines_ = {};
    chip_ = {};
  }

  Chip chip_;
  Groups lines_;
  SafetyLogic logic_;
  std::uint8_t event_word_ = 0;
  std::atomic<bool> lost_{false}, dropped_{false};
};

struct NamedOffset {
  const char* key;
  int offset;
};
std::vector<NamedOffset> offsets_of(const LinesSettings& s) {
  std::vector<NamedOffset> out{
      {"estop_a", s.estop_a}, {"estop_b", s.estop_b}, {"dead_man", s.dead_man},   {"grip", s.grip},
      {"clutch", s.clutch},   {"enable", s.enable},   {"heartbeat", s.heartbeat}, {"led", s.led},
      {"scope", s.scope},     {"sync", s.sync}};
  for (std::size_t i = 0; i < kEventKeys.size(); ++i) out.push_back({kEventKeys[i], s.event[i]});
  return out;
}

/// After the refusal, with all lines of this scene free again.
Error why_not_requested(const Chip& handle, const GpioChip& chip, const LinesSettings& settings,
                        int error) {
  if (error == EACCES || error == EPERM) return not_permitted(chip);
  for (const auto& [key, offset] : offsets_of(settings)) {
    if (offset < 0) continue;
    const auto user = handle.user_of(offset);
    if (!user) continue;
    return Error{fmt::format(
        "device.lines.{} is line {} of {} \"{}\", which {} uses already; end it, or choose another "
        "line (gpioinfo {} shows them)",
        key, offset, chip.name, chip.label, user->empty() ? "the kernel" : *user, chip.name)};
  }
  return Error{fmt::format("the lines of {} \"{}\" cannot be requested: {}; gpioinfo {} shows them",
                           chip.name, chip.label, std::strerror(error), chip.name)};
}

/// One that the chip does not give is an error: an e-stop or a dead-man without its line would be
/// none.
std::optional<Error> check_given(const Chip& handle, const GpioChip& chip,
                                 const LinesSettings& settings) {
  for (const auto& [key, offset] : offsets_of(settings)) {
    if (offset < 0 || handle.gives(offset)) continue;
    return Error{fmt::format(
        "device.lines.{} is line {} of {} \"{}\", which the chip does not give: {}; correct the "
        "number (gpioinfo {} shows the lines), or check its driver (dmesg)",
        key, offset, chip.name, chip.label, std::strerror(errno), chip.name)};
  }
  return std::nullopt;
}

/// Lines of one direction on their way into a request.
class Wanted {
 public:
  /// Its place; -1 if it is not wired. More lines than Levels has places end the set-up here, not
  /// behind an array in the loop.
  int add(int offset) {
    if (offset < 0) return -1;
    offsets_.at(count_) = offset;
    return static_cast<int>(count_++);
  }
  /// False, with errno, if the kernel refuses. No line, no request.
  bool request(Chip& chip, LineUse use, LineRequest& out) const {
    if (count_ == 0) return true;
    out = chip.request(use, std::span(offsets_).first(count_), kConsumer);
    return !out.empty();
  }

 private:
  std::array<int, kMaxRequestLines> offsets_{};
  std::size_t count_ = 0;
};

/// All lines that the scene wires; nothing, with errno and all lines free, if one is refused.
std::optional<Groups> request(Chip& chip, const LinesSettings& s) {
  Groups lines;
  Wanted inputs, outputs, scope;
  lines.estop_a = inputs.add(s.estop_a);
  lines.estop_b = inputs.add(s.estop_b);
  lines.dead_man = inputs.add(s.dead_man);
  lines.grip = inputs.add(s.grip);
  lines.grip_closes_low = s.grip_closes_low;
  lines.clutch = inputs.add(s.clutch);
  for (std::size_t i = 0; i < kEventKeys.size(); ++i) lines.event[i] = inputs.add(s.event[i]);
  lines.enable = outputs.add(s.enable);
  lines.heartbeat = outputs.add(s.heartbeat);
  lines.led = outputs.add(s.led);
  lines.sync = outputs.add(s.sync);
  scope.add(s.scope);
  const bool given = inputs.request(chip, LineUse::kInput, lines.inputs) &&
                     outputs.request(chip, LineUse::kOutput, lines.outputs) &&
                     scope.request(chip, LineUse::kOutput, lines.scope);
  if (given) return lines;
  const int error = errno;
  lines = {};  // may change errno
  errno = error;
  return std::nullopt;
}

}  // namespace

Result<bool> check_offsets(const LinesSettings& settings, const GpioChip& chip) {
  const auto lines = offsets_of(settings);
  bool any = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].offset < 0) continue;
    any = true;
    if (lines[i].offset >= chip.lines)
      return Error{fmt::format("device.lines.{} is {}, but {} \"{}\" has lines 0 to {}",
                               lines[i].key, lines[i].offset, chip.name, chip.label,
                               chip.lines - 1)};
    for (std::size_t j = 0; j < i; ++j)
      if (lines[j].offset == lines[i].offset)
        return Error{fmt::format("device.lines.{} and {} are both line {}; give each its own",
                                 lines[j].key, lines[i].key, lines[i].offset)};
  }
  if (!any)
    return Error{fmt::format(
        "device.lines names the chip {} but no line of it; set estop_a, estop_b, enable or others",
        settings.chip)};
  return true;
}

Result<std::unique_ptr<SafetyLines>> open_safety_lines(const LinesSettings& settings,
                                                       const SystemRoots& roots) {
  if (!settings.wired()) return std::unique_ptr<SafetyLines>(new NoSafetyLines);
  const auto chip = choose_chip(find_permitted_chips(roots), settings.chip);
  if (!chip) return chip.error();
  if (const auto good = check_offsets(settings, *chip); !good) return good.error();
  return open_lines_of(*chip, settings);
}

Result<std::unique_ptr<SafetyLines>> open_lines_of(const GpioChip& chip,
                                                   const LinesSettings& settings) {
  Chip handle(chip.path);
  if (handle.empty())
    return Error{fmt::format("{} cannot be opened: {}; check its driver (dmesg)", chip.path,
                             std::strerror(errno))};
  if (auto error = check_given(handle, chip, settings)) return *error;
  auto lines = request(handle, settings);
  if (!lines) return why_not_requested(handle, chip, settings, errno);
  return std::unique_ptr<SafetyLines>(new GpioLines(std::move(handle), *std::move(lines)));
}

}  // namespace tact::hal::gpio
