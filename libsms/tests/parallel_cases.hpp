// Mechanisms given by data, for the tests: the built-in platform, Dietmaier's hexapod, a 3-RPS.
#pragma once

#include "mechanism_cases.hpp"
#include "sms/parallel_dynamics.hpp"
#include "sms/parallel_path.hpp"

namespace sms_test {

using Parallel = sms::ParallelMechanism<double>;
using V6 = sms::Vec6<double>;

// z down as the built-in platform has it; the pose's z is -height.
inline Parallel built_in(const sms::Geometry<double>& g) {
  Parallel m = {};
  m.legs = 6;
  for (int i = 0; i < 6; ++i) {
    m.leg[i] = {g.base[i],
                g.platform[i],
                i < 3 ? sms::LegLength::actuated : sms::LegLength::fixed,
                i < 3 ? 0.0 : g.panhard_length(i - 3),
                false,
                Vec::Zero()};
  }
  const int driven[6] = {3, 4, 2, 0, 0, 0};
  std::copy_n(driven, 6, m.driven);
  m.characteristic_length = sms::mean_platform_radius(m);
  return m;
}

inline V6 coordinates_in_parallel(const sms::Pose<double>& p) {
  V6 c;
  c << p.x, p.y, -p.height, p.roll, p.pitch, p.yaw;
  return c;
}

// P. Dietmaier, The Stewart-Gough platform of general geometry can have 40 real postures, in: Advances in Robot
// Kinematics: Analysis and Control, 1998, pp. 7-16. Lengths in the paper's unit.
inline Parallel dietmaier(double length[6]) {
  const double base[6][3] = {{0.0, 0.0, 0.0},
                             {1.107915, 0.0, 0.0},
                             {0.549094, 0.756063, 0.0},
                             {0.735077, -0.223935, 0.525991},
                             {0.514188, -0.526063, -0.368418},
                             {0.590473, 0.094733, -0.205018}};
  const double platform[6][3] = {{0.0, 0.0, 0.0},
                                 {0.542805, 0.0, 0.0},
                                 {0.956919, -0.528915, 0.0},
                                 {0.665885, -0.353482, 1.402538},
                                 {0.478359, 1.158742, 0.107672},
                                 {-0.137087, -0.235121, 0.353913}};
  const double lengths[6] = {1.0, 0.645275, 1.086284, 1.503439, 1.281933, 0.771071};
  Parallel m = {};
  m.legs = 6;
  for (int i = 0; i < 6; ++i) {
    m.leg[i] = {Vec(base[i]), Vec(platform[i]), sms::LegLength::actuated, 0.0, false, Vec::Zero()};
    length[i] = lengths[i];
  }
  m.characteristic_length = sms::mean_platform_radius(m);
  return m;
}

// Revolute joints on a circle of 0.5 m, their axes along its tangents; platform of 0.3 m; z up. Chosen: z, roll, pitch.
inline Parallel three_rps() {
  Parallel m = {};
  m.legs = 3;
  for (int i = 0; i < 3; ++i) {
    const double a = 2.0 * 3.14159265358979323846 / 3.0 * i;
    const Vec radial(std::cos(a), std::sin(a), 0.0);
    m.leg[i] = {0.5 * radial, 0.3 * radial, sms::LegLength::actuated, 0.0, true, Vec(-std::sin(a), std::cos(a), 0.0)};
  }
  const int driven[6] = {2, 3, 4, 0, 0, 0};
  std::copy_n(driven, 6, m.driven);
  m.characteristic_length = sms::mean_platform_radius(m);
  return m;
}

// A 6-6 hexapod with joints in pairs, z up, its platform about 1 m above the base.
inline Parallel hexapod() {
  Parallel m = {};
  m.legs = 6;
  for (int i = 0; i < 6; ++i) {
    const double third = 2.0 * 3.14159265358979323846 / 3.0, side = i % 2 == 0 ? -1.0 : 1.0;
    const double at = third * (i / 2) + side * 0.2, above = third * ((i + (i % 2)) / 2) - third / 2 - side * 0.25;
    m.leg[i] = {Vec(std::cos(at), std::sin(at), 0.0),
                0.6 * Vec(std::cos(above), std::sin(above), 0.0),
                sms::LegLength::actuated,
                0.0,
                false,
                Vec::Zero()};
  }
  m.characteristic_length = sms::mean_platform_radius(m);
  return m;
}

}  // namespace sms_test
