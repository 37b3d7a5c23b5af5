// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/gpio_lines.h"

#include <fmt/format.h>
#include <gpiod.h>
#include <sys/syscall.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/gpio/safety_logic.h"

namespace tact::hal::gpio {
namespace {

using model::Error;
using model::Fault;
using model::LinesSettings;
using model::Result;

constexpr const char* kConsumer = "tactd";
constexpr std::size_t kMaxLines = 3;
using Values = std::array<int, kMaxLines>;

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }  // releases its lines, too
};
using ChipHandle = std::unique_ptr<gpiod_chip, CloseChip>;

// One ioctl each, on a chip that is known not to sleep; libgpiod only copies the values.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
bool get_levels(gpiod_line_bulk& lines, Values& values) RT_SAFE {
  return gpiod_line_get_value_bulk(&lines, values.data()) == 0;
}
bool set_levels(gpiod_line_bulk& lines, const Values& values) RT_SAFE {
  return gpiod_line_set_value_bulk(&lines, values.data()) == 0;
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

/// Lines of one direction, requested and moved together. Each level knows its place in the request.
class LineGroup {
 public:
  LineGroup() { gpiod_line_bulk_init(&bulk_); }

  /// Adds a line and tells its place.
  int add(gpiod_line* line) {
    gpiod_line_bulk_add(&bulk_, line);
    return static_cast<int>(bulk_.num_lines) - 1;
  }
  bool empty() const RT_SAFE { return bulk_.num_lines == 0; }
  gpiod_line_bulk& bulk() RT_SAFE { return bulk_; }

 private:
  gpiod_line_bulk bulk_{};
};

struct Groups {
  LineGroup inputs, outputs, scope;
  int estop_a = -1, estop_b = -1, dead_man = -1;
  int enable = -1, heartbeat = -1, led = -1;
};

class GpioLines final : public SafetyLines {
 public:
  GpioLines(ChipHandle chip, const Groups& lines)
      : chip_(std::move(chip)),
        lines_(lines),
        logic_({.estop = lines.estop_a >= 0, .dead_man = lines.dead_man >= 0}) {}
  ~GpioLines() override { release(); }
  GpioLines(const GpioLines&) = delete;
  GpioLines& operator=(const GpioLines&) = delete;

  Fault read(std::int64_t now_ns) RT_SAFE override {
    Values values{};
    if (!lost() && !lines_.inputs.empty() && !get_levels(lines_.inputs.bulk(), values)) lose();
    const Fault fault = logic_.judge({.estop_a = level(values, lines_.estop_a),
                                      .estop_b = level(values, lines_.estop_b),
                                      .dead_man = level(values, lines_.dead_man)},
                                     now_ns);
    return lost() ? Fault::kLinesLost : fault;
  }

  Fault write(const LinesTick& tick) RT_SAFE override {
    const SafetyOutputs outputs = logic_.drive(tick);
    Values values{};
    set_level(values, lines_.enable, outputs.enable && !dropped());
    set_level(values, lines_.heartbeat, outputs.heartbeat && !dropped());
    set_level(values, lines_.led, outputs.led);
    if (!lost() && !lines_.outputs.empty() && !set_levels(lines_.outputs.bulk(), values)) lose();
    return lost() ? Fault::kLinesLost : Fault::kNone;
  }

  bool enabled() const RT_SAFE override { return !lost() && !dropped() && logic_.enabled(); }

  // libgpiod keeps the last level of each line in plain memory that nobody reads: two threads here
  // disturb no more than that.
  void drop() RT_SAFE override {
    dropped_.store(true, std::memory_order_relaxed);
    if (!lost() && !lines_.outputs.empty()) set_levels(lines_.outputs.bulk(), {});
  }

  std::span<const int> loop_calls() const override {
    static constexpr std::array kCalls{SYS_ioctl};
    return kCalls;
  }

  void scope(bool up) RT_SAFE override {
    if (!lost() && !lines_.scope.empty()) set_levels(lines_.scope.bulk(), {up ? 1 : 0});
  }

  std::string trouble() const override {
    return words(lost() ? LinesCause::kChipLost : logic_.cause());
  }

  void stop() override { release(); }

 private:
  static bool level(const Values& values, int place) RT_SAFE {
    return place >= 0 && values[static_cast<std::size_t>(place)] != 0;
  }
  static void set_level(Values& values, int place, bool high) RT_SAFE {
    if (place >= 0) values[static_cast<std::size_t>(place)] = high ? 1 : 0;
  }
  bool lost() const RT_SAFE { return lost_.load(std::memory_order_relaxed); }
  void lose() RT_SAFE { lost_.store(true, std::memory_order_relaxed); }
  bool dropped() const RT_SAFE { return dropped_.load(std::memory_order_relaxed); }

  void release() {
    if (chip_ == nullptr) return;
    if (!lines_.outputs.empty()) set_levels(lines_.outputs.bulk(), {});
    scope(false);
    lose();
    chip_.reset();
  }

  ChipHandle chip_;
  Groups lines_;
  SafetyLogic logic_;
  std::atomic<bool> lost_{false}, dropped_{false};
};

struct NamedOffset {
  const char* key;
  int offset;
};
std::array<NamedOffset, 7> offsets_of(const LinesSettings& s) {
  return {{{"estop_a", s.estop_a},
           {"estop_b", s.estop_b},
           {"dead_man", s.dead_man},
           {"enable", s.enable},
           {"heartbeat", s.heartbeat},
           {"led", s.led},
           {"scope", s.scope}}};
}

Error why_not_requested(gpiod_chip* handle, const GpioChip& chip, const LinesSettings& settings,
                        int error) {
  if (error == EACCES || error == EPERM) return not_permitted(chip);
  for (const auto& [key, offset] : offsets_of(settings)) {
    if (offset < 0) continue;
    gpiod_line* line = gpiod_chip_get_line(handle, static_cast<unsigned>(offset));
    if (line == nullptr || gpiod_line_is_requested(line) || !gpiod_line_is_used(line)) continue;
    const char* user = gpiod_line_consumer(line);
    return Error{fmt::format(
        "device.lines.{} is line {} of {} \"{}\", which {} uses already; end it, or choose another "
        "line (gpioinfo {} shows them)",
        key, offset, chip.name, chip.label, user == nullptr ? "the kernel" : user, chip.name)};
  }
  return Error{fmt::format("the lines of {} \"{}\" cannot be requested: {}; gpioinfo {} shows them",
                           chip.name, chip.label, std::strerror(error), chip.name)};
}

bool request(Groups& lines) {
  const Values low{};
  if (!lines.inputs.empty() && gpiod_line_request_bulk_input(&lines.inputs.bulk(), kConsumer) != 0)
    return false;
  if (!lines.outputs.empty() &&
      gpiod_line_request_bulk_output(&lines.outputs.bulk(), kConsumer, low.data()) != 0)
    return false;
  return lines.scope.empty() ||
         gpiod_line_request_bulk_output(&lines.scope.bulk(), kConsumer, low.data()) == 0;
}

/// All lines that the scene wires. One that the chip does not give is an error: an e-stop or a
/// dead-man without its line would be none.
Result<Groups> find_lines(gpiod_chip* handle, const GpioChip& chip, const LinesSettings& settings) {
  Groups lines;
  int scope = -1;
  LineGroup *const in = &lines.inputs, *const out = &lines.outputs;
  const std::array<LineGroup*, 7> groups{in, in, in, out, out, out, &lines.scope};
  const std::array<int*, 7> places{&lines.estop_a,   &lines.estop_b, &lines.dead_man, &lines.enable,
                                   &lines.heartbeat, &lines.led,     &scope};
  const auto wanted = offsets_of(settings);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto& [key, offset] = wanted[i];
    if (offset < 0) continue;
    gpiod_line* line = gpiod_chip_get_line(handle, static_cast<unsigned>(offset));
    if (line == nullptr)
      return Error{fmt::format(
          "device.lines.{} is line {} of {} \"{}\", which the chip does not give: {}; correct the "
          "number (gpioinfo {} shows the lines), or check its driver (dmesg)",
          key, offset, chip.name, chip.label, std::strerror(errno), chip.name)};
    *places[i] = groups[i]->add(line);
  }
  return lines;
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
  const auto chip = choose_chip(find_gpio_chips(roots), settings.chip);
  if (!chip) return chip.error();
  if (const auto good = check_offsets(settings, *chip); !good) return good.error();
  return open_lines_of(*chip, settings);
}

Result<std::unique_ptr<SafetyLines>> open_lines_of(const GpioChip& chip,
                                                   const LinesSettings& settings) {
  ChipHandle handle(gpiod_chip_open(chip.path.c_str()));
  if (handle == nullptr)
    return Error{fmt::format("{} cannot be opened: {}; check its driver (dmesg)", chip.path,
                             std::strerror(errno))};
  auto lines = find_lines(handle.get(), chip, settings);
  if (!lines) return lines.error();
  if (!request(*lines)) return why_not_requested(handle.get(), chip, settings, errno);
  return std::unique_ptr<SafetyLines>(new GpioLines(std::move(handle), *lines));
}

}  // namespace tact::hal::gpio
