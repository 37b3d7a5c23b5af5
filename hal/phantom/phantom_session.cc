// SPDX-License-Identifier: Apache-2.0
#include "hal/phantom/phantom_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hal/device_lock.h"

namespace tact::hal::phantom {
namespace {

using model::Error;
using model::Result;
using model::Vec3;

constexpr double kMetresPerMm = 1e-3;

std::string text_of(const HdFunctions& hd, unsigned what) {
  const char* text = hd.get_string(what);
  return text == nullptr ? std::string() : std::string(text);
}

double number_of(const HdFunctions& hd, unsigned what) {
  double value = 0.0;
  hd.get_doubles(what, &value);
  return value;
}

int whole_of(const HdFunctions& hd, unsigned what) {
  int value = 0;
  hd.get_integers(what, &value);
  return value;
}

bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

/// What the device reports of itself; an error when tact could not hold it to its limits.
std::optional<Error> ask_limits(PhantomSession& s) {
  s.model = text_of(s.hd, kHdModel);
  s.serial_number = text_of(s.hd, kHdSerialNumber);
  s.max_force_N = number_of(s.hd, kHdMaxForce);
  const double continuous_N = number_of(s.hd, kHdContinuousForce);
  s.continuous_force_N = is_positive(continuous_N) ? continuous_N : 0.0;
  s.max_stiffness_N_per_m = number_of(s.hd, kHdMaxStiffness) / kMetresPerMm;
  s.wrist = whole_of(s.hd, kHdInputDof) >= 6;
  s.calibration_styles = whole_of(s.hd, kHdCalibrationStyle);
  double box_mm[6] = {};
  s.hd.get_doubles(kHdUsableWorkspace, box_mm);
  const Vec3 least_m = to_w(box_mm, kMetresPerMm), most_m = to_w(box_mm + 3, kMetresPerMm);
  const Vec3 half_m = 0.5 * (most_m - least_m);
  s.middle_m = 0.5 * (most_m + least_m);
  s.radius_m = std::min(half_m.y, half_m.z);
  s.half_length_m = half_m.x;
  if (const unsigned code = take_hd_errors(s.hd); code != 0)
    return Error{fmt::format("the PHANTOM does not report its limits: {}", text_of_hd_error(code))};
  // NaN in one corner is a NaN here, which std::min may pass over.
  if (!is_finite(half_m) || !is_finite(s.middle_m) || !is_positive(s.max_force_N) ||
      !is_positive(s.radius_m) || !is_positive(s.half_length_m))
    return Error{fmt::format(
        "the PHANTOM reports {:g} N and a workspace of {:g} x {:g} m, which cannot be: install the "
        "driver of this device, and configure it by the vendor's Touch_Setup",
        s.max_force_N, 2.0 * s.radius_m, 2.0 * s.half_length_m)};
  return std::nullopt;
}

}  // namespace

Result<PhantomSession> open_phantom_session(const PhantomSettings& settings, bool trust_library,
                                            const SystemRoots& roots) {
  const auto hd = load_hd(settings.library, trust_library);
  if (!hd) return hd.error();
  const std::string name = settings.name.empty() ? "Default Device" : settings.name;
  const auto refusal = refused_usb_device(kPhantomParts, roots);
  // Before the library looks at it: its forces may be another program's.
  if (auto error = lock_device(fmt::format("the PHANTOM \"{}\"", name))) return *error;
  take_hd_errors(*hd);  // of before
  PhantomSession session{.hd = *hd,
                         .id = hd->init_device(settings.name.empty() ? nullptr : name.c_str()),
                         .model = {},
                         .serial_number = {},
                         .middle_m = {}};
  const unsigned code = take_hd_errors(*hd);
  if (code != 0 || session.id == kHdNoDevice) {
    if (session.id != kHdNoDevice) {  // a library may open it and complain
      hd->make_current(session.id);
      hd->disable(kHdForceOutput);
      hd->disable_device(session.id);
    }
    return Error{fmt::format(
        "the PHANTOM \"{}\" does not open: {}; {}", name,
        code == 0 ? "there is no such device" : text_of_hd_error(code),
        refusal ? refusal->error().message
                : "device.phantom.name is the name that the vendor's Touch_Setup gave it")};
  }
  hd->make_current(session.id);
  auto error = ask_limits(session);
  // Two names may be one device.
  if (!error && !session.serial_number.empty())
    error = lock_device(fmt::format("the PHANTOM no. {}", session.serial_number));
  if (error) {
    hd->disable_device(session.id);  // and nothing else: its forces may be another program's
    return *error;
  }
  // Off first: another program may have left them on. More than it can show is cut, no error.
  hd->disable(kHdForceOutput);
  hd->enable(kHdMaxForceClamping);
  return session;
}

const char* calibration_remedy(const PhantomSession& session) {
  return (session.calibration_styles & kHdInkwell) != 0
             ? "put its stylus into the inkwell"
             : "calibrate it by the vendor's Touch_Diagnostic";
}

}  // namespace tact::hal::phantom
