// SPDX-License-Identifier: Apache-2.0
// tact_sim - a scene for Python: from poses of the tool to forces, without device and clock.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <stdexcept>

#include "firmware/embed/haptics.h"

namespace py = pybind11;
using tact::Haptics;
using tact::model::Vec3;

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Forces of many ticks, as arrays: one row a tick.
struct Steps {
  explicit Steps(py::ssize_t ticks, py::ssize_t spheres)
      : law_force_N({ticks, py::ssize_t{3}}),
        force_N({ticks, py::ssize_t{3}}),
        torque_Nm({ticks, py::ssize_t{3}}),
        depth_m({ticks, spheres}) {}

  py::array_t<double> law_force_N, force_N, torque_Nm, depth_m;
};

class Sim {
 public:
  Sim(const std::string& scene_path, const std::vector<std::string>& set) {
    // All of the force: no hand is on a simulation.
    auto made = Haptics::make(scene_path, {.set = set, .device = {}, .hard_real_time = true});
    if (!made) throw std::runtime_error(made.error().message);
    haptics_ = std::move(*made);
  }

  void set(const std::vector<std::string>& numbers) {
    if (const auto error = haptics_->set(numbers)) throw std::runtime_error(error->message);
  }

  /// One period for each row. `orientation` and `grip_ratio` are empty, or have a row for each.
  Steps steps(const Array& position_m, const Array& orientation, const Array& grip_ratio) {
    const py::ssize_t n = position_m.ndim() == 2 ? position_m.shape(0) : -1;
    if (n < 0 || position_m.shape(1) != 3)
      throw std::invalid_argument("position_m: give an array of shape (n, 3), m");
    const bool turns = orientation.size() > 0, grips = grip_ratio.size() > 0;
    if (turns &&
        (orientation.ndim() != 2 || orientation.shape(0) != n || orientation.shape(1) != 4))
      throw std::invalid_argument("orientation: give an array of shape (n, 4): w, x, y, z");
    if (grips && (grip_ratio.ndim() != 1 || grip_ratio.shape(0) != n))
      throw std::invalid_argument("grip_ratio: give an array of shape (n,), 0 open, 1 closed");
    Steps out(n, static_cast<py::ssize_t>(haptics_->contacts().size()));
    for (py::ssize_t i = 0; i < n; ++i) {
      const double* p = position_m.data(i, 0);
      const double* q = turns ? orientation.data(i, 0) : nullptr;
      step({p[0], p[1], p[2]}, q, grips ? *grip_ratio.data(i) : 0.0);
      put(out, i);
    }
    return out;
  }

  py::array_t<double> one_step(const Vec3& position_m, double grip_ratio) {
    step(position_m, nullptr, grip_ratio);
    const Vec3& force_N = out_.wanted.force_N;
    return py::array_t<double>(3, &force_N.x);
  }

  double rate_Hz() const { return haptics_->scene().rate_Hz; }
  bool is_set() const { return haptics_->is_set(); }
  std::string state() const { return tact::firmware::loop::name_of(out_.state); }
  std::string fault() const { return tact::model::describe(out_.fault).name; }
  std::tuple<Vec3, Vec3> site() const {
    return {haptics_->scene().hand_site_m, haptics_->scene().hand_inward};
  }

 private:
  void step(const Vec3& position_m, const double* wxyz, double grip_ratio) {
    tact::hal::Sample& s = sample_;
    s.tool.velocity_mps = s.sequence > 0 ? rate_Hz() * (position_m - s.tool.position_m) : Vec3{};
    s.tool.position_m = position_m;
    if (wxyz != nullptr) s.tool.orientation = {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
    s.tool.grip_ratio = grip_ratio;
    s.stamp_ns = static_cast<std::int64_t>(1e9 * static_cast<double>(s.sequence) / rate_Hz());
    ++s.sequence;
    s.fresh = true;
    // No person is at the device: it arms itself.
    if (out_.state == tact::firmware::loop::State::kReady) haptics_->arm();
    out_ = haptics_->tick(s);
  }
  void put(Steps& out, py::ssize_t i) const {
    const auto row = [i](py::array_t<double>& array, const Vec3& v) {
      double* at = array.mutable_data(i, 0);
      at[0] = v.x, at[1] = v.y, at[2] = v.z;
    };
    row(out.law_force_N, out_.wanted.force_N);
    row(out.force_N, out_.written.force_N);
    row(out.torque_Nm, out_.written.torque_Nm);
    double* depth_m = out.depth_m.mutable_data(i, 0);
    for (const auto& contact : haptics_->contacts()) *depth_m++ = contact.depth_m;
  }

  std::unique_ptr<Haptics> haptics_;
  tact::hal::Sample sample_;
  tact::firmware::loop::TickOutput out_;
};

}  // namespace

PYBIND11_MODULE(tact_sim, m) {
  m.doc() = "A scene of tact: from poses of the tool to forces, without device and clock.";
  py::class_<Steps>(m, "Steps", "One row for each tick; frame W.")
      .def_readonly("law_force_N", &Steps::law_force_N, "(n, 3): of the law, before the gate, N")
      .def_readonly("force_N", &Steps::force_N, "(n, 3): after the gate, as a device gets it, N")
      .def_readonly("torque_Nm", &Steps::torque_Nm, "(n, 3): after the gate, N m")
      .def_readonly("depth_m", &Steps::depth_m, "(n, spheres): penetration depth, m");
  py::class_<Sim>(m, "Sim")
      .def(py::init<const std::string&, const std::vector<std::string>&>(), py::arg("scene"),
           py::arg("set") = std::vector<std::string>{},
           "scene: path of a TOML file; set: KEY=VALUE, as tactd --set takes them. RuntimeError: "
           "what is wrong in the file, with its line.")
      .def("steps", &Sim::steps, py::arg("position_m"), py::arg("orientation") = Array(),
           py::arg("grip_ratio") = Array(),
           "One period for each row of position_m, (n, 3), m, in frame W. orientation: (n, 4), w x "
           "y z. grip_ratio: (n,). Returns Steps.")
      .def(
          "step",
          [](Sim& sim, const std::array<double, 3>& p_m, double grip_ratio) {
            return sim.one_step({p_m[0], p_m[1], p_m[2]}, grip_ratio);
          },
          py::arg("position_m"), py::arg("grip_ratio") = 0.0,
          "One period. Returns the force of the law on the tool, (3,), N, before the gate.")
      .def("set", &Sim::set, py::arg("numbers"),
           "Other numbers of the law, each KEY=VALUE; used in the first period in which the tool "
           "touches nothing. RuntimeError: a key that may not change, or its range.")
      .def_property_readonly("is_set", &Sim::is_set, "the numbers of set() are in use")
      .def_property_readonly("rate_Hz", &Sim::rate_Hz)
      .def_property_readonly("state", &Sim::state, "Off, Ready, Armed or Stopped")
      .def_property_readonly("fault", &Sim::fault, "latched; \"none\" without")
      .def_property_readonly(
          "site",
          [](const Sim& sim) {
            const auto [site_m, inward] = sim.site();
            return std::make_tuple(py::array_t<double>(3, &site_m.x),
                                   py::array_t<double>(3, &inward.x));
          },
          "hand.site_m and the unit direction into the tissue there");
}
