// SPDX-License-Identifier: Apache-2.0
// operator_figure.h - the operator's figure as the overlay of every frame: the tool from telemetry,
// the bodies from a tracker or a recording, the hand at the handle of the tool's mesh. A recorded
// figure is shown unchanged. When tactd restarts, bound bones stay bound.
#pragma once

#include <string>

#include "host/figure/figure.h"
#include "host/server/live_view.h"

namespace tact::host::server {

/// grip_m() of the tool's mesh; the default without a mesh.
Eigen::Vector3d grip_of(const record::RunHeader& header, const record::MeshBytes& mesh);

class OperatorFigure final : public OverlaySource {
 public:
  explicit OperatorFigure(double height_m);

  /// Position of the right shoulder while none is tracked, W, m. Resets the figure.
  void put_shoulder_at(const Eigen::Vector3d& shoulder_m);

  nlohmann::json begin(const record::RunHeader& header, const record::MeshBytes& mesh) override;
  /// Without `tracked` only the tool moves the figure.
  std::string with(const record::Frame& frame, const tracking::TrackedOperator* tracked,
                   const figure::FigurePose* shown = nullptr) override;
  const figure::FigurePose& figure() const override { return reported_; }

 private:
  figure::FigureSettings settings_;
  figure::Figure figure_;
  figure::FigurePose reported_;
};

}  // namespace tact::host::server
