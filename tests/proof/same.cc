// SPDX-License-Identifier: Apache-2.0
// same.cc - is the translation what runs? The gate as g++ compiles it and the translated C get the
// same random inputs, sane and absurd; every number that comes out must be the same, bit for bit.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>

#define private public
#include "firmware/gate/gate.h"
#undef private

namespace {

double nondet_double() { return 0.0; }
std::uint64_t nondet_uint64_t() { return 0; }
std::uint32_t nondet_uint32_t() { return 0; }
std::uint16_t nondet_uint16_t() { return 0; }
std::uint8_t nondet_uint8_t() { return 0; }
#define ANY(type) nondet_##type()
#define ADD(a, b) ((a) + (b))
#define SUB(a, b) ((a) - (b))
#define MUL(a, b) ((a) * (b))
#define SQUARE(a) ((a) * (a))
#define DIV(a, b) ((a) / (b))
#define SQRT(a) std::sqrt(a)
#define FABS(a) std::fabs(a)
#define FMAX(a, b) std::fmax(a, b)
#define FMIN(a, b) std::fmin(a, b)
double BITS(std::uint64_t bits) {
  double number;
  std::memcpy(&number, &bits, sizeof number);
  return number;
}
/// The same bits, or both are NaN.
bool is_same(const void* a, const char* b, std::size_t size) {
  if (std::memcmp(a, b, size) == 0) return true;
  double x = 0.0, y = 0.0;
  if (size != sizeof x) return false;
  std::memcpy(&x, a, size);
  std::memcpy(&y, b, size);
  return std::isnan(x) && std::isnan(y);
}
#define TACT_COPIES
using std::memcpy;
#include MADE

std::mt19937_64 random_bits(15);
double draw(double size) {
  static const double kOdd[] = {0.0, -0.0, INFINITY, -INFINITY, NAN, 1e308, -5e-324, 1e-160};
  if (random_bits() % 4000 == 0) return kOdd[random_bits() % 8];
  return size * (static_cast<double>(random_bits() >> 11) * 0x1p-52 - 1.0);
}
void draw(tact::model::Vec3& v, double size) { v = {draw(size), draw(size), draw(size)}; }

template <typename T>
const char* bytes_of(const T& object) {
  return reinterpret_cast<const char*>(&object);
}

}  // namespace

int main() {
  using namespace tact::firmware::gate;
  long forces = 0;
  for (int run = 0; run < 1000; ++run) {
    Gate gate({.force_N = 1.0 + run % 9,
               .torque_Nm = 0.1 * (run % 3),
               .slew_N_per_s = 2000.0,
               .ramp_s = 0.2,
               .workspace_radius_m = 0.1,
               .workspace_half_length_m = 0.1,
               .speed_mps = 1.0,
               .turn_radps = 10.0,
               .energy_J = 0.05 + 0.01 * (run % 7),
               .recovery_W = 1e-3,
               .continuous_force_N = 1.0 + run % 2,
               .thermal_time_s = 1.0,
               .power_W = 2.0},
              1e-3, 1.0);
    GateInput in;
    const double hand = 0.001 + 0.02 * (run % 6), pull = run % 5 == 0 ? 0.5 : 12.0;
    for (int tick = 0; tick < 1000; ++tick) {
      draw(in.wanted.force_N, pull);
      draw(in.wanted.torque_Nm, 0.02 * pull);
      draw(in.tool.position_m, hand);
      draw(in.tool.velocity_mps, 10.0 * hand);
      draw(in.tool.angular_velocity_radps, 20.0 * hand);
      in.tool.orientation.x = draw(0.01);
      in.fresh = random_bits() % 10 != 0;
      in.armed = random_bits() % 500 != 0;
      in.skipped_periods = random_bits() % 20 == 0 ? random_bits() % 30 : 0;
      load_gate(bytes_of(gate));
      load_input(bytes_of(in));
      limit();
      const LimitedForce limited = gate.limit(in);
      forces += norm(limited.wrench.force_N) > 0.0;
      if (is_same_out(bytes_of(limited)) && is_same_gate(bytes_of(gate))) continue;
      std::printf("not the same in run %d, tick %d\n", run, tick);
      return 1;
    }
  }
  std::printf("1000000 ticks the same, %ld with a force\n", forces);
  return forces > 100000 ? 0 : 1;
}
