// SPDX-License-Identifier: Apache-2.0
// operator_figure.h - the operator's figure beside every frame: the tool from telemetry, the bodies
// from a tracker or a recording, the hand at the handle of the tool's mesh. A recording that has
// the figure itself is shown as it was. When tactd begins again, what is bound stays bound.
#pragma once

#include <string>

#include "host/figure/figure.h"
#include "host/server/live_view.h"

namespace tact::host::server {

/// grip_m() of the tool's mesh; the default without a mesh.
Eigen::Vector3d grip_of(const record::Hello& hello, const record::MeshBytes& mesh);

class OperatorFigure final : public OverlaySource {
 public:
  explicit OperatorFigure(double height_m);

  /// Where the right shoulder is while none is tracked, W, m. It begins the figure again.
  void put_shoulder_at(const Eigen::Vector3d& shoulder_m);

  nlohmann::json begin(const record::Hello& hello, const record::MeshBytes& mesh) override;
  /// Without `tracked` the tool alone moves the figure.
  std::string with(const record::Frame& frame, const tracking::TrackedOperator* tracked,
                   const figure::FigurePose* shown = nullptr) override;
  const figure::FigurePose& figure() const override { return reported_; }

 private:
  figure::FigureSettings settings_;
  figure::Figure figure_;
  figure::FigurePose reported_;
};

}  // namespace tact::host::server
