// The six links between ground and platform in a given pose: where they are, and how their lengths change with it.
//
//   r_i = R p_i,   l_i = r_i + d - b_i,   |l_i| the link's length           (dissertation, eq. 3.1 and 3.6)
//
// with d = (x, y, -height). A change of pose turns the platform by omega and moves its reference point by v, and
// l_i . l_i' = l_i . v + (r_i x l_i) . omega, which gives the slopes of |l_i|^2 / 2 below. The coordinates are kept in
// two groups of three: the driven ones (roll, pitch, height), which are free, and the parasitic ones (yaw, x, y), which
// the Panhard rods tie to them.
#pragma once

#include "sms/geometry.hpp"
#include "sms/rotation.hpp"

namespace sms {

template <typename S>
struct Links {
  Vec3<S> arm[6];   // r_i, m, world axes, from the reference point
  Vec3<S> link[6];  // l_i, m, from B_i to P_i
};

template <typename S>
void locate_links(const Geometry<S>& g, const Mat3<S>& rotation, const Pose<S>& pose, Links<S>& links) {
  const Vec3<S> position(pose.x, pose.y, -pose.height);
  for (int i = 0; i < 6; ++i) {
    links.arm[i] = rotation * g.platform[i];
    links.link[i] = links.arm[i] + position - g.base[i];
  }
}

// Where a point of the platform is in a pose, m, world axes; `at_rest` is where it is in the rest pose.
template <typename S>
Vec3<S> carried_point(const Geometry<S>& g, const Pose<S>& pose, const Vec3<S>& at_rest) {
  const Vec3<S> position(pose.x, pose.y, -pose.height);
  return attitude(pose.roll, pose.pitch, pose.yaw).rotation * (at_rest - g.reference) + position;
}

// Lengths of all six links in a pose whose six coordinates are free: the inverse kinematics of a Gough-Stewart
// platform, eq. 3.6.
template <typename S>
void six_leg_inverse(const Geometry<S>& g, const Pose<S>& pose, S length[6]) {
  using std::sqrt;
  Links<S> links;
  locate_links(g, attitude(pose.roll, pose.pitch, pose.yaw).rotation, pose, links);
  for (int i = 0; i < 6; ++i) {
    length[i] = sqrt(links.link[i].squaredNorm());
  }
}

// How fast a point of the platform moves along a direction, per rate of the driven and of the parasitic coordinates.
// By the principle of virtual power also what a force on that point does to them.
template <typename S>
struct PointSlope {
  Vec3<S> driven;
  Vec3<S> parasitic;
};

template <typename S>
inline PointSlope<S> point_slope(const Attitude<S>& a, const Vec3<S>& arm, const Vec3<S>& direction) {
  const Vec3<S> moment = cross(arm, direction);
  return {{moment.dot(a.roll_axis), moment.dot(a.pitch_axis), -direction(2)}, {moment(2), direction(0), direction(1)}};
}

// Derivatives of |l_i|^2 / 2, row i, by the driven and by the parasitic coordinates; m^2 per rad or m.
template <typename S>
struct LinkSlopes {
  Mat3<S> actuator_driven;
  Mat3<S> actuator_parasitic;
  Mat3<S> panhard_driven;
  Mat3<S> panhard_parasitic;
};

template <typename S>
LinkSlopes<S> link_slopes(const Links<S>& links, const Attitude<S>& a) {
  LinkSlopes<S> slopes;
  for (int i = 0; i < 6; ++i) {
    const PointSlope<S> slope = point_slope(a, links.arm[i], links.link[i]);
    (i < 3 ? slopes.actuator_driven : slopes.panhard_driven).row(i % 3) = slope.driven;
    (i < 3 ? slopes.actuator_parasitic : slopes.panhard_parasitic).row(i % 3) = slope.parasitic;
  }
  return slopes;
}

// The parasitic coordinates eliminated: what holds for all motions that keep the Panhard rods' lengths.
template <typename S>
struct Elimination {
  Mat3<S> panhard_inverse;  // inverse of panhard_parasitic
  Mat3<S> parasitic;        // d(yaw, x, y) / d(roll, pitch, height)
  Mat3<S> actuator;         // d(|l|^2 / 2) / d(roll, pitch, height) of the actuators
};

template <typename S>
void eliminate_parasitic(const LinkSlopes<S>& slopes, Elimination<S>& e) {
  e.panhard_inverse = inverse(slopes.panhard_parasitic);
  e.parasitic = -product(e.panhard_inverse, slopes.panhard_driven);
  e.actuator = slopes.actuator_driven + product(slopes.actuator_parasitic, e.parasitic);
}

// The same per rate of the driven ones alone, when the parasitic ones follow.
template <typename S>
inline Vec3<S> constrained(const PointSlope<S>& slope, const Mat3<S>& parasitic) {
  return slope.driven + parasitic.transpose() * slope.parasitic;
}

}  // namespace sms
