// Attitude of the platform: R = Rz(yaw) Ry(pitch) Rx(roll), z down, x the roll axis (dissertation, eq. 3.2 to 3.5).
//
// R turns platform axes into world axes. The angular velocity, in world axes, is
//
//   omega = roll' a_roll + pitch' a_pitch + yaw' e_z
//
// with a_roll = Rz Ry e_x and a_pitch = Rz e_y: each angle turns about the axis that the angles after it have moved.
#pragma once

#include <cmath>

#include "sms/scalar.hpp"

namespace sms {

// The largest roll, pitch and yaw that are accepted, rad (34 deg). The machine tilts by 13 and yaws by 7 deg; its other
// assembly modes, which it could only reach by being taken apart, lie beyond 40 deg of tilt and near -161 deg of yaw.
template <typename V>
constexpr V largest_angle() {
  return V(0.6);
}

template <typename S>
struct SineCosine {
  S sine;
  S cosine;
};

template <typename S>
inline SineCosine<S> sine_cosine(const S& angle) {
  using std::cos;
  using std::sin;
  return {sin(angle), cos(angle)};
}

// For plain numbers the power series, which within +-largest_angle() is exact to rounding: 9e-19 of the sine is left
// out in double, 3e-10 in float. It needs no C library, so desk and controller compute the same bits. The terms are
// paired (Estrin) to keep the chain of dependent operations short.
template <typename D>
inline SineCosine<D> double_series(const D& angle) {
  const D t = angle * angle, t2 = t * t, t4 = t2 * t2;
  const D sine =
      ((1.0 - t * (1.0 / 6.0)) + t2 * (1.0 / 120.0 - t * (1.0 / 5040.0))) +
      t4 * ((1.0 / 362880.0 - t * (1.0 / 39916800.0)) + t2 * (1.0 / 6227020800.0 - t * (1.0 / 1307674368000.0)));
  const D cosine =
      ((1.0 - t * 0.5) + t2 * (1.0 / 24.0 - t * (1.0 / 720.0))) +
      t4 * ((1.0 / 40320.0 - t * (1.0 / 3628800.0)) + t2 * (1.0 / 479001600.0 - t * (1.0 / 87178291200.0)));
  return {angle * sine, cosine};
}

inline SineCosine<double> sine_cosine(double angle) { return double_series(angle); }

inline SineCosine<float> sine_cosine(float angle) {
  const float t = angle * angle, t2 = t * t;
  const float sine =
      (1.0f - t * (1.0f / 6.0f)) + t2 * ((1.0f / 120.0f - t * (1.0f / 5040.0f)) + t2 * (1.0f / 362880.0f));
  const float cosine = (1.0f - t * 0.5f) + t2 * ((1.0f / 24.0f - t * (1.0f / 720.0f)) + t2 * (1.0f / 40320.0f));
  return {angle * sine, cosine};
}

// Ry Rx p: what roll and pitch do to a point of the platform; yaw is still to come.
template <typename S>
inline Vec3<S> tilted(const SineCosine<S>& roll, const SineCosine<S>& pitch, const Vec3<S>& p) {
  const S across = roll.sine * p(1) + roll.cosine * p(2);
  return {pitch.cosine * p(0) + pitch.sine * across, roll.cosine * p(1) - roll.sine * p(2),
          pitch.cosine * across - pitch.sine * p(0)};
}

template <typename S>
struct Attitude {
  Mat3<S> rotation;    // R, platform axes to world axes
  Vec3<S> roll_axis;   // a_roll, world axes
  Vec3<S> pitch_axis;  // a_pitch, world axes
};

template <typename S>
inline Attitude<S> attitude(const S& roll, const S& pitch, const S& yaw) {
  const SineCosine<S> r = sine_cosine(roll), p = sine_cosine(pitch), y = sine_cosine(yaw);
  Attitude<S> a;
  a.roll_axis << p.cosine * y.cosine, p.cosine * y.sine, -p.sine;
  a.pitch_axis << -y.sine, y.cosine, S(0);
  const Vec3<S> down(p.sine * y.cosine, p.sine * y.sine, p.cosine);  // Rz Ry e_z
  a.rotation.col(0) = a.roll_axis;
  a.rotation.col(1) = r.cosine * a.pitch_axis + r.sine * down;
  a.rotation.col(2) = r.cosine * down - r.sine * a.pitch_axis;
  return a;
}

}  // namespace sms
