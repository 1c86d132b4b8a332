// A parallel mechanism given by data: legs between a base and one platform.
//
// Leg i joins B_i on the base to P_i on the platform, l_i = d + R p_i - b_i. What it does to the platform is one or two
// scalar equations, and six of them determine the pose:
//
//   length   |l_i| = L_i     actuated (L_i is the input) or fixed (a rod, L_i is given)
//   plane    n_i . l_i = 0   a revolute joint at the base, axis n_i, keeps the leg in a plane (the R of a 3-RPS)
//
// A leg whose length is `free` slides passively and counts by its plane alone. Six actuated legs are a Gough-Stewart
// platform; three and three rods the machine of geometry.hpp; three with planes a 3-RPS. The number of actuated legs is
// the number of freedoms. Spherical joints are points; legs do not collide here.
//
// Axes are the file's own (z may point up). R = Rz(yaw) Ry(pitch) Rx(roll) as everywhere. Rates are a twist of the
// platform's origin: its velocity, and the angular velocity, both in base axes. Equation k changes by
//
//   e_k . v + (r_i x e_k) . omega,    r_i = R p_i, e = l_i / |l_i| or n_i
//
// so that the six rows (e, r x e) are the Jacobian, and their transpose takes forces along the legs and across the
// planes to a wrench on the platform (J.-P. Merlet, Parallel Robots, 2nd ed., 2006, ch. 5 and 7).
#pragma once

#include <cmath>

#include "sms/eigen_symmetric.hpp"
#include "sms/rotation.hpp"
#include "sms/small_system.hpp"
#include "sms/sms.h"

namespace sms {

enum class LegLength : int { actuated, fixed, free };

template <typename S>
struct Leg {
  Vec3<S> base;      // B_i, m, base axes
  Vec3<S> platform;  // P_i, m, platform axes, from the platform's origin
  LegLength length_is;
  S fixed_length;  // m, of a rod
  bool in_plane;
  Vec3<S> normal;  // n_i, unit vector, base axes; the revolute joint's axis
};

constexpr int kMostLegs = 6;  // each adds at least one of six equations

template <typename S>
struct ParallelMechanism {
  int legs;
  Leg<S> leg[kMostLegs];
  int driven[6];            // of a pose's coordinates, those that are chosen where there are fewer than six freedoms
  S characteristic_length;  // m: what a radian is weighed against
};

// The order of a pose's numbers: x, y, z of the platform's origin (m, base axes), roll, pitch, yaw (rad).
template <typename S>
struct PlatformPose {
  Vec3<S> position;  // d
  Mat3<S> rotation;  // R
};

// The library's own sine and cosine: the power series of rotation.hpp ends at 0.6 rad.
template <typename S>
Mat3<S> full_rotation(const S& roll, const S& pitch, const S& yaw) {
  using std::cos;
  using std::sin;
  const S sr = sin(roll), cr = cos(roll), sp = sin(pitch), cp = cos(pitch), sy = sin(yaw), cy = cos(yaw);
  Mat3<S> r;
  r << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
      -sp, cp * sr, cp * cr;
  return r;
}

template <typename S>
PlatformPose<S> pose_of(const Vec6<S>& coordinates) {
  return {coordinates.template head<3>(), full_rotation<S>(coordinates(3), coordinates(4), coordinates(5))};
}

// Pitch within +-pi/2; where it is at an end, roll and yaw are one angle.
template <typename S>
Vec6<S> coordinates_of(const PlatformPose<S>& pose) {
  using std::atan2;
  using std::sqrt;
  const Mat3<S>& r = pose.rotation;
  Vec6<S> c;
  const S across = sqrt(r(0, 0) * r(0, 0) + r(1, 0) * r(1, 0));
  for (int k = 0; k < 3; ++k) {
    c(k) = pose.position(k);
  }
  c(3) = atan2(r(2, 1), r(2, 2));
  c(4) = atan2(-r(2, 0), across);
  c(5) = atan2(r(1, 0), r(0, 0));
  return c;
}

// omega = E (roll, pitch, yaw)'.
template <typename S>
Mat3<S> angle_rates_to_angular_velocity(const S& pitch, const S& yaw) {
  using std::cos;
  using std::sin;
  const S sp = sin(pitch), cp = cos(pitch), sy = sin(yaw), cy = cos(yaw);
  Mat3<S> e;
  e << cp * cy, -sy, S(0), cp * sy, cy, S(0), -sp, S(0), S(1);
  return e;
}

// One of the six equations: of which leg, its length or its plane.
struct LegEquation {
  int leg;
  bool is_plane;
};

template <typename S>
int actuated_count(const ParallelMechanism<S>& m) {
  int count = 0;
  for (int i = 0; i < m.legs; ++i) {
    count += m.leg[i].length_is == LegLength::actuated ? 1 : 0;
  }
  return count;
}

// The actuated lengths first, then rods, then planes, each in the order of the legs. How many there are, which is six
// for a mechanism that can be solved; never more than six are written.
template <typename S>
int equations_of(const ParallelMechanism<S>& m, LegEquation equation[6]) {
  int count = 0;
  const auto add = [&](int leg, bool is_plane) {
    if (count < 6) {
      equation[count] = {leg, is_plane};
    }
    ++count;
  };
  for (const LegLength kind : {LegLength::actuated, LegLength::fixed}) {
    for (int i = 0; i < m.legs; ++i) {
      if (m.leg[i].length_is == kind) {
        add(i, false);
      }
    }
  }
  for (int i = 0; i < m.legs; ++i) {
    if (m.leg[i].in_plane) {
      add(i, true);
    }
  }
  return count;
}

// Root mean square distance of the platform's joints from its origin, m: the default characteristic length.
template <typename S>
S mean_platform_radius(const ParallelMechanism<S>& m) {
  using std::sqrt;
  S sum = S(0);
  for (int i = 0; i < m.legs; ++i) {
    sum += m.leg[i].platform.squaredNorm();
  }
  return sqrt(sum / S(m.legs));
}

template <typename S>
struct LegVectors {
  Vec3<S> arm[kMostLegs];   // r_i, m, base axes
  Vec3<S> link[kMostLegs];  // l_i, m
};

template <typename S>
void locate_legs(const ParallelMechanism<S>& m, const PlatformPose<S>& pose, LegVectors<S>& v) {
  for (int i = 0; i < m.legs; ++i) {
    v.arm[i] = pose.rotation * m.leg[i].platform;
    v.link[i] = v.arm[i] + pose.position - m.leg[i].base;
  }
}

// The row of a force along e at the end of an arm: per velocity, per angular velocity.
template <typename S>
Eigen::Matrix<S, 1, 6> twist_row(const Vec3<S>& arm, const Vec3<S>& e) {
  Eigen::Matrix<S, 1, 6> row;
  const Vec3<S> moment = cross(arm, e);
  row << e(0), e(1), e(2), moment(0), moment(1), moment(2);
  return row;
}

// Unit rows: d(length or distance from the plane) / d(twist); m per m, m per rad.
template <typename S>
Mat6<S> parallel_jacobian(const ParallelMechanism<S>& m, const LegEquation equation[6], const LegVectors<S>& v) {
  using std::sqrt;
  Mat6<S> jacobian;
  for (int k = 0; k < 6; ++k) {
    const int i = equation[k].leg;
    const Vec3<S> e = equation[k].is_plane ? m.leg[i].normal : Vec3<S>(v.link[i] / sqrt(v.link[i].squaredNorm()));
    jacobian.row(k) = twist_row(v.arm[i], e);
  }
  return jacobian;
}

// How far a pose is from singularity: of the Jacobian with angular velocity times the characteristic length, so that
// all of it is dimensionless (J. Angeles' homogeneous Jacobian). The numbers depend on that length and on the
// platform's origin; the sign of the determinant does not, and a path that changes it passes a singular pose.
template <typename S>
struct Distance {
  S condition;    // largest over smallest singular value, 1 is best; infinite where singular to rounding
  S determinant;  // 0 is singular
};

template <typename S>
Distance<S> distance_from_singularity(const ParallelMechanism<S>& m, const LegEquation equation[6],
                                      const PlatformPose<S>& pose) {
  LegVectors<S> v;
  locate_legs(m, pose, v);
  Mat6<S> jacobian = parallel_jacobian(m, equation, v);
  jacobian.template rightCols<3>() /= m.characteristic_length;
  Factors<S> factors;
  factorize(jacobian, factors);
  using std::sqrt;
  const Vec6<S> squares = symmetric_eigen<S, 6>(jacobian.transpose() * jacobian).values;
  const S condition =
      squares(0) > S(0) ? S(sqrt(squares(5) / squares(0))) : S(std::numeric_limits<ValueOf<S>>::infinity());
  return {condition, factors.determinant};
}

template <typename T, typename S>
ParallelMechanism<T> cast(const ParallelMechanism<S>& m) {
  ParallelMechanism<T> to;
  to.legs = m.legs;
  for (int i = 0; i < m.legs; ++i) {
    const Leg<S>& leg = m.leg[i];
    to.leg[i] = {
        leg.base.template cast<T>(),  leg.platform.template cast<T>(), leg.length_is, T(leg.fixed_length), leg.in_plane,
        leg.normal.template cast<T>()};
  }
  for (int k = 0; k < 6; ++k) {
    to.driven[k] = m.driven[k];
  }
  to.characteristic_length = T(m.characteristic_length);
  return to;
}

}  // namespace sms
