#include "tools/common/interrupt.h"

#include <atomic>
#include <csignal>

namespace tact::tools {
namespace {

std::atomic<bool> pressed{false};
static_assert(std::atomic<bool>::is_always_lock_free, "may be set by a signal handler");

void remember(int signal) {
  pressed.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptWatch::InterruptWatch() {
  pressed.store(false);
  std::signal(SIGINT, remember);
  std::signal(SIGTERM, remember);
}

InterruptWatch::~InterruptWatch() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  pressed.store(false);
}

bool is_interrupted() { return pressed.load(); }

}  // namespace tact::tools
