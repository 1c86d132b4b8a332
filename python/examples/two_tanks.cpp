// The two tanks of two_tanks.py, their derivative in C++:
//
//   c++ -O2 -std=c++17 -shared -fPIC two_tanks.cpp -o two_tanks.so
//
//   from sms.diagnosis import own
//   derivative = own.from_library("two_tanks.so", "derivative", PARAMETERS, rows=2)
//
// where PARAMETERS are the names of the fields of Parameters, in their order.
#include <algorithm>
#include <cmath>

namespace {

constexpr double kGravity = 9.81;          // m/s^2
constexpr double kCrossSection = 15.5e-4;  // m^2, of either tank

struct Parameters {
  double pump_gain;                                           // m^3/(s V)
  double pump_dead_band;                                      // V
  double outlet_upper, outlet_lower, leak_upper, leak_lower;  // m^2
};

struct Levels {
  double upper, lower;  // m
};

// Torricelli: the speed of what leaves a tank at its bottom.
double speed(double level) { return std::sqrt(2.0 * kGravity * std::max(level, 1e-6)); }

// Rates of both levels, m/s: what comes in less what goes out, over the cross-section.
Levels rates(const Parameters& p, const Levels& level, double pump_voltage) {
  const double pumped = p.pump_gain * std::max(pump_voltage - p.pump_dead_band, 0.0);
  const double passed = p.outlet_upper * speed(level.upper);
  return {(pumped - passed - p.leak_upper * speed(level.upper)) / kCrossSection,
          (passed - (p.outlet_lower + p.leak_lower) * speed(level.lower)) / kCrossSection};
}

}  // namespace

extern "C" void derivative(int n, const double* parameters, const double* state, const double* input, double* out) {
  const auto parameter = [&](int k, int i) { return parameters[k * n + i]; };
  for (int i = 0; i < n; ++i) {
    const Parameters p{parameter(0, i), parameter(1, i), parameter(2, i),
                       parameter(3, i), parameter(4, i), parameter(5, i)};
    const Levels rate = rates(p, {state[i], state[n + i]}, input[i]);
    out[i] = rate.upper;
    out[n + i] = rate.lower;
  }
}
