// SPDX-License-Identifier: Apache-2.0
// operator_inputs.h - all that moves the operator's figure beside the tool: the tracker of a
// description, and OpenIGTLink, which also tells others what tactd does. No force depends on it.
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

  /// What the options ask for, if anything. Error: what is wrong and what to do.
  std::optional<model::Error> open(const Options& options);
  void start();

  bool is_there() const { return tracking_ || igtl_; }
  /// Where the description has the right shoulder, frame W, m.
  std::optional<Eigen::Vector3d> shoulder_m() const;
  /// The bodies as they are now; of one role the description's goes first. Null: no input is there.
  const tracking::TrackedOperator* now();

  std::optional<std::uint16_t> igtl_port() const;
  /// What tactd does, for OpenIGTLink.
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
