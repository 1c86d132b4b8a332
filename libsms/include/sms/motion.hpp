// Motion of the mechanism: rates and accelerations of everything that moves, from those of q = (roll, pitch, height).
//
// The Panhard rods leave three freedoms, so every velocity is linear in q', and every acceleration is that same map of
// q'' plus a bias quadratic in q':
//
//   omega = W q',   v = V q',   extension' = J q',   extension'' = J q'' + bias
//
// for the platform's angular velocity, its reference point and the actuators. The bias is what the accelerations are at
// q'' = 0. For a link l with platform joint P, l . v_P = |l| |l|' and, differentiated once more,
//
//   l . a_P + |v_P|^2 = |l| |l|'' + |l|'^2
//
// which for a rod (|l|' = |l|'' = 0) gives the parasitic accelerations, and for an actuator that of its extension.
// All of it is exact; nothing is differenced or stabilised.
#pragma once

#include "sms/links.hpp"

namespace sms {

template <typename S>
struct Motion {
  // of the pose: place()
  Attitude<S> attitude;
  Links<S> links;
  S length[6];             // |l_i|, m
  S reciprocal_length[6];  // 1 / |l_i|, 1/m
  Vec3<S> direction[6];    // l_i / |l_i|
  Elimination<S> eliminated;
  Mat3<S> angular;          // W, world axes: column k is omega per q'_k
  Mat3<S> linear;           // V, world axes
  Mat3<S> extension_slope;  // J = d extension / dq

  // of the velocity: move()
  Vec3<S> angular_velocity;   // omega, rad/s, world axes
  Vec3<S> joint_velocity[6];  // v_P, m/s
  Vec3<S> extension_rate;     // m/s
  Vec3<S> angular_bias;       // omega' at q'' = 0, rad/s^2
  Vec3<S> linear_bias;        // v' at q'' = 0, m/s^2
  Mat3<S> arm_bias;           // what a point r from the reference point accelerates more than that: arm_bias r
  Vec3<S> joint_bias[6];      // v_P' at q'' = 0, m/s^2
  Vec3<S> extension_bias;     // extension'' at q'' = 0, m/s^2
  Vec3<S> parasitic_rate;     // (yaw, x, y)'
  Vec3<S> parasitic_bias;     // (yaw, x, y)'' at q'' = 0
};

// The maps W, V, J in a pose that fits the rods: from inverse_kinematics or forward_kinematics.
template <typename S>
void place(const Geometry<S>& g, const Pose<S>& pose, Motion<S>& m) {
  using std::sqrt;
  m.attitude = attitude(pose.roll, pose.pitch, pose.yaw);
  locate_links(g, m.attitude.rotation, pose, m.links);
  eliminate_parasitic(link_slopes(m.links, m.attitude), m.eliminated);
  const Mat3<S>& parasitic = m.eliminated.parasitic;
  m.angular.row(0) << m.attitude.roll_axis(0), m.attitude.pitch_axis(0), S(0);
  m.angular.row(1) << m.attitude.roll_axis(1), m.attitude.pitch_axis(1), S(0);
  m.angular.row(2) << m.attitude.roll_axis(2), S(0), S(0);
  m.angular.row(2) += parasitic.row(0);
  m.linear.row(0) = parasitic.row(1);
  m.linear.row(1) = parasitic.row(2);
  m.linear.row(2) << S(0), S(0), S(-1);
  for (int i = 0; i < 6; ++i) {
    m.length[i] = sqrt(m.links.link[i].squaredNorm());
    m.reciprocal_length[i] = S(1) / m.length[i];
    m.direction[i] = m.reciprocal_length[i] * m.links.link[i];
  }
  for (int i = 0; i < 3; ++i) {
    m.extension_slope.row(i) = m.reciprocal_length[i] * m.eliminated.actuator.row(i);
  }
}

// Generalised force of a force on the joint P_i, world axes; after place().
template <typename S>
Vec3<S> joint_load(const Motion<S>& m, int i, const Vec3<S>& force) {
  return constrained(point_slope(m.attitude, m.links.arm[i], force), m.eliminated.parasitic);
}

// The map from a point's arm r to its acceleration about the reference point: alpha x r + omega x (omega x r).
template <typename S>
inline Mat3<S> turning_and_circling(const Vec3<S>& alpha, const Vec3<S>& omega) {
  const S xx = omega(0) * omega(0), yy = omega(1) * omega(1), zz = omega(2) * omega(2);
  const S xy = omega(0) * omega(1), xz = omega(0) * omega(2), yz = omega(1) * omega(2);
  Mat3<S> m;
  m << -yy - zz, xy - alpha(2), xz + alpha(1), xy + alpha(2), -xx - zz, yz - alpha(0), xz - alpha(1), yz + alpha(0),
      -xx - yy;
  return m;
}

// Velocities and biases for q'; after place().
template <typename S>
void move(const Vec3<S>& rate, Motion<S>& m) {
  m.angular_velocity = m.angular * rate;
  m.parasitic_rate = m.eliminated.parasitic * rate;
  const Vec3<S> velocity(m.parasitic_rate(1), m.parasitic_rate(2), -rate(2));
  m.extension_rate = m.extension_slope * rate;
  // The axes of roll and pitch are themselves carried along: by yaw, and that of roll by pitch too.
  const Vec3<S> e_z(S(0), S(0), S(1));
  const Vec3<S> carries_pitch = m.parasitic_rate(0) * e_z;
  const Vec3<S> carries_roll = carries_pitch + rate(1) * m.attitude.pitch_axis;
  const Vec3<S> turning =
      rate(0) * cross(carries_roll, m.attitude.roll_axis) + rate(1) * cross(carries_pitch, m.attitude.pitch_axis);

  const Mat3<S> swing = turning_and_circling(turning, m.angular_velocity);  // with q'', yaw'', x'', y'' all zero
  for (int i = 0; i < 6; ++i) {
    m.joint_velocity[i] = velocity + cross(m.angular_velocity, m.links.arm[i]);
  }
  Vec3<S> missing;
  for (int i = 3; i < 6; ++i) {
    const Vec3<S> swung = swing * m.links.arm[i];
    missing(i - 3) = m.links.link[i].dot(swung) + m.joint_velocity[i].squaredNorm();
  }
  m.parasitic_bias = -m.eliminated.panhard_inverse * missing;
  m.angular_bias = turning + m.parasitic_bias(0) * e_z;
  m.linear_bias << m.parasitic_bias(1), m.parasitic_bias(2), S(0);
  m.arm_bias = turning_and_circling(m.angular_bias, m.angular_velocity);
  for (int i = 0; i < 6; ++i) {
    m.joint_bias[i] = m.arm_bias * m.links.arm[i] + m.linear_bias;
  }
  for (int i = 0; i < 3; ++i) {
    m.extension_bias(i) = (m.links.link[i].dot(m.joint_bias[i]) + m.joint_velocity[i].squaredNorm() -
                           m.extension_rate(i) * m.extension_rate(i)) *
                          m.reciprocal_length[i];
  }
}

// Accelerations of the extensions and of (yaw, x, y) for q''; after move().
template <typename S>
Vec3<S> extension_acceleration(const Motion<S>& m, const Vec3<S>& acceleration) {
  return m.extension_slope * acceleration + m.extension_bias;
}

template <typename S>
Vec3<S> parasitic_acceleration(const Motion<S>& m, const Vec3<S>& acceleration) {
  return m.eliminated.parasitic * acceleration + m.parasitic_bias;
}

// The other way: q' of given extension rates, after place(); q'' of given extension accelerations, after move().
template <typename S>
Vec3<S> rate_of_extension(const Motion<S>& m, const Vec3<S>& extension_rate) {
  return inverse(m.extension_slope) * extension_rate;
}

template <typename S>
Vec3<S> acceleration_of_extension(const Motion<S>& m, const Vec3<S>& extension_acceleration) {
  return inverse(m.extension_slope) * (extension_acceleration - m.extension_bias);
}

// d extension / d(roll, pitch, height, yaw, x, y) with all six coordinates free, row i of actuator i; after place().
template <typename S>
Eigen::Matrix<S, 3, 6> extension_slope_by_pose(const Motion<S>& m) {
  const LinkSlopes<S> slopes = link_slopes(m.links, m.attitude);
  Eigen::Matrix<S, 3, 6> slope;
  for (int i = 0; i < 3; ++i) {
    slope.row(i) << slopes.actuator_driven.row(i), slopes.actuator_parasitic.row(i);
    slope.row(i) /= m.length[i];
  }
  return slope;
}

}  // namespace sms
