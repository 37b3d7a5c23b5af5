// operator_figure.h - the operator's figure beside every frame: the tool from telemetry, the bodies
// from a tracker or a recording, the hand at the handle of the tool's mesh. A recording that has the
// figure itself is shown as it was. When tactd begins anew, what is bound stays bound.
#pragma once

#include <string>

#include "host/live_view.h"
#include "host/tracking/figure.h"

namespace tact::host {

/// grip_m() of the tool's mesh; the default without a mesh.
Eigen::Vector3d grip_of(const Hello& hello, const MeshBytes& mesh);

class OperatorFigure final : public Companion {
 public:
  explicit OperatorFigure(double height_m);

  /// Where the right shoulder is while none is tracked, W, m. It begins the figure anew.
  void put_shoulder_at(const Eigen::Vector3d& shoulder_m);

  nlohmann::json begin(const Hello& hello, const MeshBytes& mesh) override;
  /// Without `tracked` the tool alone moves the figure.
  std::string with(const Frame& frame, const TrackedOperator* tracked,
                   const FigurePose* shown = nullptr) override;
  const FigurePose& figure() const override { return told_; }

 private:
  FigureSettings settings_;
  Figure figure_;
  FigurePose told_;
};

}  // namespace tact::host
