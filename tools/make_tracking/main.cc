// SPDX-License-Identifier: Apache-2.0
// tact-make-tracking: writes the tracked operator of the scene maintenance, the same bytes on every
// run: what two cameras see in 30 s, and the tracking description that belongs to it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "model/io/file_writer.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "tools/make_tracking/seen_operator.h"

namespace {

namespace fs = std::filesystem;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using tact::host::pose::Pose;

constexpr const char* kName = "maintenance";

// No "-0.0".
double rounded(double x, double steps) { return std::round(x * steps) / steps + 0.0; }

std::string text_of(const Vector3d& v) {
  return fmt::format("[{:.9f}, {:.9f}, {:.9f}]", rounded(v.x(), 1e9), rounded(v.y(), 1e9),
                     rounded(v.z(), 1e9));
}

std::string text_of(const Quaterniond& q) {
  return fmt::format("[{:.12f}, {:.12f}, {:.12f}, {:.12f}]", rounded(q.w(), 1e12),
                     rounded(q.x(), 1e12), rounded(q.y(), 1e12), rounded(q.z(), 1e12));
}

std::string observations() {
  std::string out;
  for (const tact::tools::make_tracking::Sight& s : tact::tools::make_tracking::look()) {
    std::string points;
    for (const auto& [id, p_px] : s.points) {
      points += fmt::format("{}[{},{:.1f},{:.1f}]", points.empty() ? "" : ",", id,
                            rounded(p_px.x(), 10.0), rounded(p_px.y(), 10.0));
    }
    out +=
        fmt::format(R"({{"time_s":{:.4f},"sequence":{},"camera":"{}","body":"{}","points":[{}]}})"
                    "\n",
                    s.time_s, s.sequence, s.camera->name, s.body->name, points);
  }
  return out;
}

std::string description() {
  const Pose to_W = tact::tools::make_tracking::registration();
  std::string out = fmt::format(
      "# SPDX-License-Identifier: Apache-2.0\n"
      "# The tracked operator of {0}.toml, for tact-view alone: made by tact-make-tracking. He "
      "leans,\n"
      "# looks and presses for {1:g} s; {2} px of noise, hidden and wrong markers, and a tracker "
      "that\n"
      "# loses him here and there. host/tracking/README.md says what each key is.\n\n"
      "[input]\nrecording = \"{0}.observations.jsonl\"\n",
      kName, tact::tools::make_tracking::kLength_s, tact::tools::make_tracking::kNoise_px);
  for (const auto& eye : tact::tools::make_tracking::tracking_cameras()) {
    const Quaterniond rotation =
        tact::host::pose::canonical(to_W.rotation.conjugate() * eye.pose.rotation);
    const Vector3d position_m = tact::host::pose::to_local(to_W, eye.pose.position_m);
    out += fmt::format(
        "\n[[camera]]\nname = \"{}\"\nfx_px = {:.1f}\nfy_px = {:.1f}\ncx_px = {:.1f}\n"
        "cy_px = {:.1f}\nposition_m = {}\nrotation_wxyz = {}\n",
        eye.name, eye.lens.fx_px, eye.lens.fy_px, eye.lens.cx_px, eye.lens.cy_px,
        text_of(position_m), text_of(rotation));
  }
  for (const auto& body : tact::tools::make_tracking::tracked_bodies()) {
    out += fmt::format("\n[[body]]\nname = \"{0}\"\nrole = \"{0}\"\nmarkers_m = [\n", body.name);
    for (std::size_t id = 0; id < body.marker_m.size(); ++id) {
      const Vector3d& p_m = body.marker_m[id];
      out += fmt::format("  [{}, {:.2f}, {:.2f}, {:.2f}],\n", id, p_m.x(), p_m.y(), p_m.z());
    }
    out += "]\n";
  }
  return out + fmt::format(
                   "\n# The tracker's frame, y up and its origin on the floor, to the device's.\n"
                   "[registration]\nposition_m = {}\nrotation_wxyz = {}\n",
                   text_of(to_W.position_m), text_of(to_W.rotation));
}

// One line for each look: where the body really was, in W.
std::string truth() {
  std::string out;
  for (const tact::tools::make_tracking::Sight& s : tact::tools::make_tracking::look()) {
    const Pose pose = tact::tools::make_tracking::body_pose(*s.body, s.time_s);
    out += fmt::format(R"({{"time_s":{:.4f},"body":"{}","position_m":{},"rotation_wxyz":{}}})"
                       "\n",
                       s.time_s, s.body->name, text_of(pose.position_m),
                       text_of(tact::host::pose::canonical(pose.rotation)));
  }
  return out;
}

bool write(const fs::path& path, const std::string& text) {
  if (const auto error = tact::model::io::write_file(path.string(), text)) {
    fmt::print(stderr, "tact-make-tracking: {}\n", error->sentence);
    return false;
  }
  fmt::print("{}: {} bytes\n", path.string(), text.size());
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  tact::model::io::watch_standard_output("tact-make-tracking");
  tact::model::io::tell_uncaught("tact-make-tracking");
  CLI::App app{
      "Write the tracked operator of the scene maintenance: NAME.tracking.toml and "
      "NAME.observations.jsonl (pixels of two cameras, 30 s), the same bytes on every run."};
  std::string directory;
  bool with_truth = false;
  app.add_option("--out", directory, "directory to write to")->required();
  app.add_flag("--truth", with_truth,
               "also NAME.truth.jsonl: for each line of the observations the body's true pose in "
               "the device's frame, m");
  app.footer("Exit status: 0 written, 2 bad usage or the directory cannot be written.");
  if (const auto status =
          tact::model::io::parse_command_line(app, "tact-make-tracking", argc, argv))
    return *status;
  const fs::path folder(directory);
  const std::string name(kName);
  const bool good = write(folder / (name + ".tracking.toml"), description()) &&
                    write(folder / (name + ".observations.jsonl"), observations()) &&
                    (!with_truth || write(folder / (name + ".truth.jsonl"), truth()));
  return good ? 0 : 2;
}
