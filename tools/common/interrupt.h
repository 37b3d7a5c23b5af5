// interrupt.h - Ctrl-C as a question that long work asks between its steps.
#pragma once

namespace tact::tools {

/// While it lives, the first Ctrl-C (or SIGTERM) is remembered; a second one ends the program.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;
};

/// True once Ctrl-C was pressed under a watch that still lives.
bool is_interrupted();

}  // namespace tact::tools
