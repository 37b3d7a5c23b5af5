// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/edge_monitor.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/gpio/gpio_lines.h"

namespace tact::hal::gpio {
namespace {

using model::Error;
using model::Result;

class GpioEdges final : public EdgeMonitor {
 public:
  GpioEdges(Chip chip, LineRequest line) : chip_(std::move(chip)), line_(std::move(line)) {}

  std::vector<Edge> read(std::chrono::milliseconds longest) override {
    return line_.edges(longest);
  }

 private:
  Chip chip_;
  LineRequest line_;
};

}  // namespace

Result<std::unique_ptr<EdgeMonitor>> open_edge_monitor(const std::string& wanted, int line,
                                                       const std::string& who,
                                                       const SystemRoots& roots) {
  const auto chip = choose_chip(find_permitted_chips(roots), wanted);
  if (!chip) return chip.error();
  if (line < 0 || line >= chip->lines)
    return Error{fmt::format("line {} is none of {} \"{}\", which has lines 0 to {}", line,
                             chip->name, chip->label, chip->lines - 1)};
  Chip handle(chip->path);
  LineRequest found;
  if (!handle.empty()) found = handle.request(LineUse::kEdges, {&line, 1}, who.c_str());
  if (found.empty())
    return Error{fmt::format("line {} of {} cannot be watched: {}; gpioinfo {} shows who uses it",
                             line, chip->name, std::strerror(errno), chip->name)};
  return std::unique_ptr<EdgeMonitor>(new GpioEdges(std::move(handle), std::move(found)));
}

}  // namespace tact::hal::gpio
