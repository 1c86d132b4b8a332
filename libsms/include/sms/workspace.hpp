// What the machine can reach, and with what to spare: stroke, joint angles, distance from singularity, force.
//
// Roll, pitch and height share three strokes. At one height each axis alone reaches furthest; both together reach less,
// and whether a rectangle of roll and pitch fits is a matter of its margin: the least stroke left over on its edges.
// (Inside it there is more: an extension is nearly linear in q, so its extremes lie on the boundary.)
#pragma once

#include "sms/dynamics.hpp"
#include "sms/eigen_symmetric.hpp"
#include "sms/piston.hpp"

namespace sms {

// Stroke left over by the actuator nearest to one of its ends, m; negative outside.
template <typename S>
S stroke_margin(const Geometry<S>& g, const Vec3<S>& extension) {
  const S retracted = extension.minCoeff(), extended = g.stroke - extension.maxCoeff();
  return retracted < extended ? retracted : extended;
}

// The same for a pose given by q; untouched on any status but SMS_OK.
template <typename S>
sms_status stroke_margin_at(const Geometry<S>& g, const Vec3<S>& q, S& margin) {
  Pose<S> pose;
  Vec3<S> extension;
  const sms_status status = inverse_kinematics(g, q, rest_pose(g), pose, extension);
  if (status == SMS_OK) {
    margin = stroke_margin(g, extension);
  }
  return status;
}

// Least stroke margin on the edges of the rectangle |roll| <= roll_limit, |pitch| <= pitch_limit at a height.
template <typename S>
sms_status rectangle_margin(const Geometry<S>& g, const S& height, const S& roll_limit, const S& pitch_limit,
                            S& margin) {
  constexpr int kPerEdge = 16;
  S least = g.stroke;
  for (int i = 0; i <= kPerEdge; ++i) {
    const S along = S(2 * i - kPerEdge) / S(kPerEdge);
    const S roll[4] = {along * roll_limit, along * roll_limit, roll_limit, -roll_limit};
    const S pitch[4] = {pitch_limit, -pitch_limit, along * pitch_limit, along * pitch_limit};
    for (int edge = 0; edge < 4; ++edge) {
      S here = S(0);
      const sms_status status = stroke_margin_at(g, Vec3<S>(roll[edge], pitch[edge], height), here);
      if (status != SMS_OK) {
        return status;
      }
      least = here < least ? here : least;
    }
  }
  margin = least;
  return SMS_OK;
}

// The largest tilt that the stroke allows in one direction of the roll-pitch plane: roll = angle * direction_roll,
// pitch = angle * direction_pitch, a unit vector; rad. SMS_OUT_OF_WORKSPACE when not even level fits at that height.
template <typename S>
sms_status reach(const Geometry<S>& g, const S& height, const S& direction_roll, const S& direction_pitch, S& angle) {
  constexpr int kHalvings = 40;
  S margin = S(0);
  const sms_status status = stroke_margin_at(g, Vec3<S>(S(0), S(0), height), margin);
  if (status != SMS_OK) {
    return status;
  }
  if (margin < S(0)) {
    return SMS_OUT_OF_WORKSPACE;
  }
  S inside = S(0), outside = largest_angle<S>();
  for (int i = 0; i < kHalvings; ++i) {
    const S middle = S(0.5) * (inside + outside);
    const Vec3<S> q(middle * direction_roll, middle * direction_pitch, height);
    const bool fits = stroke_margin_at(g, q, margin) == SMS_OK && margin >= S(0);
    (fits ? inside : outside) = middle;
  }
  angle = inside;
  return SMS_OK;
}

// How far each joint has turned from the rest pose, rad: what its rod eye has to allow.
template <typename S>
struct JointAngles {
  S base[6];      // the link against the ground
  S platform[6];  // the link against the platform
};

template <typename S>
S angle_between(const Vec3<S>& a, const Vec3<S>& b) {
  using std::atan2;
  using std::sqrt;
  return atan2(S(sqrt(cross(a, b).squaredNorm())), a.dot(b));
}

// After place().
template <typename S>
JointAngles<S> joint_angles(const Geometry<S>& g, const Motion<S>& m) {
  JointAngles<S> angles;
  for (int i = 0; i < 6; ++i) {
    const Vec3<S> rest = g.platform[i] + g.reference - g.base[i];
    angles.base[i] = angle_between(rest, m.direction[i]);
    angles.platform[i] = angle_between(rest, Vec3<S>(m.attitude.rotation.transpose() * m.direction[i]));
  }
  return angles;
}

// Distance from singularity, 1 is best: condition numbers of the derivatives of the Panhard rods' lengths by
// (yaw, x, y), and of all six lengths by (roll, pitch, height, yaw, x, y), in metres and radians (the joints are about
// 1 m from the middle) and for the reference point of `height`. Over the stroke 1.03 to 1.11 and 1.53 to 1.75. Another
// choice gives other numbers: with the angular velocity in place of the angles' rates the second is 1.53 to 1.61.
// After place().
template <typename S>
struct Conditioning {
  S panhard;
  S links;
};

template <typename S>
Conditioning<S> conditioning(const Motion<S>& m) {
  Mat3<S> panhard;
  Eigen::Matrix<S, 6, 6> links;
  for (int i = 0; i < 6; ++i) {
    const PointSlope<S> slope = point_slope(m.attitude, m.links.arm[i], m.direction[i]);
    links.row(i) << slope.driven.transpose(), slope.parasitic.transpose();
    if (i >= 3) {
      panhard.row(i - 3) = slope.parasitic;
    }
  }
  return {condition_number<S, 3>(panhard), condition_number<S, 6>(links)};
}

// What a cylinder can push and pull with at a supply pressure (absolute, Pa), its other chamber vented; N.
template <typename S>
struct ForceRange {
  S push;
  S pull;
};

template <typename S>
ForceRange<S> force_range(const Params<S>& p, const S& supply_pressure) {
  const PistonAreas<S> area = piston_areas(p);
  const S gauge = supply_pressure - p.ambient_pressure;
  return {gauge * area.lower, gauge * area.upper};
}

// Largest share of its force that an actuator needs, 1 at the limit: for the weight alone, or with acceleration.
template <typename S>
S force_share(const ForceRange<S>& range, const Vec3<S>& force) {
  const S push = force.maxCoeff() / range.push, pull = -force.minCoeff() / range.pull;
  return push > pull ? push : pull;
}

}  // namespace sms
