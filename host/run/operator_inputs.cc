// SPDX-License-Identifier: Apache-2.0
#include "host/run/operator_inputs.h"

namespace tact::host::run {

std::optional<model::Error> OperatorInputs::open(const Options& options) {
  if (!options.tracking.empty()) {
    tracking_.emplace(io_, say_);
    if (auto error = tracking_->open(options.tracking)) return error;
  }
  if (!options.igtl.is_asked_for()) return std::nullopt;
  igtl_.emplace(io_, say_);
  return igtl_->open(options.igtl);
}

void OperatorInputs::start() {
  if (tracking_) tracking_->start();
  if (igtl_) igtl_->start();
}

std::optional<Eigen::Vector3d> OperatorInputs::shoulder_m() const {
  return tracking_ ? tracking_->setup().shoulder_m : std::nullopt;
}

const tracking::TrackedOperator* OperatorInputs::now() {
  if (!igtl_) return tracking_ ? &tracking_->now() : nullptr;
  now_ = tracking_ ? igtl::joined(tracking_->now(), igtl_->now()) : igtl_->now();
  return &now_;
}

std::optional<std::uint16_t> OperatorInputs::igtl_port() const {
  return igtl_ && igtl_->port() != 0 ? std::optional(igtl_->port()) : std::nullopt;
}

void OperatorInputs::add(const record::Frame& frame) {
  if (igtl_) igtl_->add(frame);
}

void OperatorInputs::lose() {
  if (igtl_) igtl_->lose();
}

}  // namespace tact::host::run
