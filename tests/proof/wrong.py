# SPDX-License-Identifier: Apache-2.0
"""Wrong variants of the gate: file, the text there, its replacement, the proof that must
fail, and the property that it must lose."""

GATE, LIMITER, TANK = (f"firmware/gate/{name}" for name in ("gate.cc", "limiter.h", "energy_tank.cc"))
THERMAL = "firmware/gate/thermal_limit.h"
WRONG = [
    (GATE, "if (is_finite(input.wanted)) return;", "return;", "limit",
     "finite: what is not finite latches and gives zero"),
    (GATE, "if (missed_ >= kLostAfter)", "if (missed_ > kLostAfter)", "limit",
     "fresh: the 20th missed sample latches"),
    (GATE, "missed_ + 1 + input.skipped_periods", "missed_ + 1", "limit", "fresh: each missed period is counted"),
    (GATE, "if (armed && !latches(limited.fault)) return true;", "if (!latches(limited.fault)) return true;", "limit",
     "armed: zero unless armed"),
    (GATE, "is_inside(limits_, tool.position_m), period_s_", "!is_inside(limits_, tool.position_m), period_s_", "limit",
     "workspace: it fades outside"),
    (GATE, "armed && tank_.is_overdrawn()", "false", "limit", "passivity: an overdrawn tank latches"),
    (TANK, "return !(level_J_ >= -kRounding_J);", "return level_J_ < -kRounding_J;", "tank",
     "passivity: a tank that is no number is overdrawn"),
    (GATE, "Magnitude all{.force_N = std::fmin(thermal_N, passive_N),", "Magnitude all{.force_N = 1e9,", "limit",
     "magnitude: |F| <= force limit"),
    (LIMITER, "if (!is_finite(v)) v = {};", "", "limiter", "magnitude: a limited vector is finite"),
    (LIMITER, "1.0 - 1e-15", "1.0 - 4e-16", "gappa", "magnitude: rounding leaves no vector above its limit"),
    (THERMAL, "return squared < peak_ * peak_ ? std::sqrt(squared) : peak_;",
     "return squared < 2.0 * peak_ * peak_ ? std::sqrt(squared) : peak_;", "thermal",
     "magnitude: what the thermal limit allows is no more than the peak"),
    (LIMITER, "std::fmax(radius, length - shrink)", "std::fmax(radius, length + shrink)", "approach",
     "slew: an approach is no longer than its radius, or than the force before"),
    (GATE, "if (step_towards(limited.wrench, periods, most))", "if (periods > 1e9)", "limit",
     "slew: |dF| before the ramp <= its step"),
    (GATE, "note(Stage::kPower, Fault::kPowerExceeded, limited);", "limited.fault = Fault::kPowerExceeded;", "limit",
     "power: the counter is right"),
    (GATE, "  ramp_.set(0.0);\n  written_ = {};", "  written_ = {};", "limit",
     "armed: after a fault all starts from zero"),
    (GATE, "limited.wrench = ramp * limited.wrench;", "", "limit", "ramp: no force before it opens"),
]
