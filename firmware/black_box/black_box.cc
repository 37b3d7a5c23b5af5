// SPDX-License-Identifier: Apache-2.0
#include "firmware/black_box/black_box.h"

#include <fmt/format.h>

namespace tact::firmware::black_box {

BlackBox::BlackBox(BlackBoxRun run, double rate_Hz, double frame_rate_Hz)
    : run_(std::move(run)),
      ticks_(static_cast<std::size_t>(kKeep_s * rate_Hz)),
      frames_(static_cast<std::size_t>(kKeep_s * frame_rate_Hz)),
      ticks_after_(static_cast<std::uint64_t>(kAfter_s * rate_Hz)) {}

BlackBox::~BlackBox() { finish(); }

void BlackBox::add(const loop::TickRecord& record) {
  ticks_.add(protocol::LoggedTick::of(record, run_.header.non_rt));
  if (to_wait_ > 0) --to_wait_;
  const model::Fault fault = record.output.fault;
  // A fault during the 0.25 s of an earlier one goes into the same file, with its ticks.
  if (fault != before_ && fault != model::Fault::kNone && waiting_ == model::Fault::kNone) {
    waiting_ = fault;
    to_wait_ = ticks_after_;
  }
  before_ = fault;
}

void BlackBox::stands(model::Fault fault) {
  if (fault == model::Fault::kNone || before_ != model::Fault::kNone) return;
  // The loop no longer ticks, so the file does not wait. before_: each fault is recorded once.
  before_ = waiting_ = fault;
  to_wait_ = 0;
}

void BlackBox::work() {
  // While a file is being written, the next one stays pending and this thread continues.
  if (waiting_ == model::Fault::kNone || to_wait_ > 0 || writing_.load()) return;
  // The writer has finished (writing_), so join() returns almost at once.
  if (writer_.joinable()) writer_.join();
  writing_.store(true);
  // Copied in this thread, because the buffers keep changing; formatted and written in the other.
  writer_ = std::thread([this, kept = Kept{waiting_, variants_, ticks_.all(), frames_.all()}] {
    write(kept);
    writing_.store(false);
  });
  waiting_ = model::Fault::kNone;
}

void BlackBox::finish() {
  if (writer_.joinable()) writer_.join();
  to_wait_ = 0;
  work();
  if (writer_.joinable()) writer_.join();
}

void BlackBox::write(const Kept& kept) {
  // The disk first, without the lock: news() and files() must not wait for it.
  const auto path = write_black_box(run_, kept);
  const std::lock_guard lock(reported_mutex_);
  if (!path) {
    news_.push_back("black box: " + path.error().message);
    return;
  }
  files_.push_back(*path);
  news_.push_back(fmt::format("black box of fault {}: {}; tact-view --open shows it",
                              static_cast<int>(kept.fault), *path));
}

std::vector<std::string> BlackBox::news() {
  const std::lock_guard lock(reported_mutex_);
  return std::exchange(news_, {});
}

std::vector<std::string> BlackBox::files() const {
  const std::lock_guard lock(reported_mutex_);
  return files_;
}

}  // namespace tact::firmware::black_box
