// SPDX-License-Identifier: Apache-2.0
// operator_inputs.h - the inputs that move the operator's figure in addition to the tool: a tracker
// by its description, and OpenIGTLink, which also publishes tactd's state. No force depends on it.
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <optional>
#include <string>

#include "host/igtl/igtl_link.h"
#include "host/record/telemetry_check.h"
#include "host/run/command_line.h"
#include "host/tracking/operator_tracking.h"
#include "model/result.h"

namespace tact::host::run {

class OperatorInputs {
 public:
  using Say = std::function<void(const std::string& message)>;
  OperatorInputs(boost::asio::io_context& io, Say say) : io_(io), say_(std::move(say)) {}

  /// Opens the inputs of the options, if any. The error states the cause and the remedy.
  std::optional<model::Error> open(const Options& options);
  void start();

  bool is_there() const { return tracking_ || igtl_; }
  /// The right shoulder of the description, frame W, m.
  std::optional<Eigen::Vector3d> shoulder_m() const;
  /// The present bodies; for one role the description has precedence. Null without any input.
  const tracking::TrackedOperator* now();

  std::optional<std::uint16_t> igtl_port() const;
  /// Publishes a frame of tactd by OpenIGTLink.
  void add(const record::Frame& frame);
  void lose();

 private:
  boost::asio::io_context& io_;
  Say say_;
  std::optional<tracking::OperatorTracking> tracking_;
  std::optional<igtl::IgtlLink> igtl_;
  tracking::TrackedOperator now_;
};

}  // namespace tact::host::run
