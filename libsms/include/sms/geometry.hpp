// The joints of the mechanism (dissertation, section 3.2, Table 3.2).
//
// Six links join the ground to the platform, link i from B_i to P_i: three actuators (i = 0..2) that change their
// length, and three Panhard rods (i = 3..5) that do not. World frame: right-handed, z down, x the roll axis. The rest
// pose has all actuators retracted and the platform's axes parallel to the world's; every length follows from it,
// unless an offset in the parameters says otherwise.
//
// Each link stands on a universal joint. Its first axis is fixed to the ground, horizontal and across the link at rest;
// so a link turns with two freedoms and does not spin about itself at will, as in the source's multibody model. (No link
// may stand vertical at rest: that axis would be undetermined.)
#pragma once

#include <cmath>

#include "sms/params.hpp"
#include "sms/scalar.hpp"

namespace sms {

template <typename S>
struct Geometry {
  Vec3<S> base[6];          // B_i, m, world axes
  Vec3<S> platform[6];      // P_i, m, from the reference point, platform axes
  Vec3<S> reference;        // the platform's reference point at rest, m: height, x and y of a pose are this point's
  Vec3<S> joint_axis[6];    // ground-fixed axis of the universal joint at B_i, unit vector
  Vec3<S> actuator_length;  // at zero extension, m
  Vec3<S> panhard_length;   // m
  S stroke;                 // m
};

// Where the reference point is in a pose, world axes, m.
template <typename S>
struct Pose {
  S roll;    // rad
  S pitch;   // rad
  S height;  // of the reference point above ground, m: its z is -height
  S yaw;     // rad; yaw, x and y follow from the other three by the Panhard rods
  S x;       // m
  S y;       // m
};

template <typename S>
Geometry<S> make_geometry(const Params<S>& p) {
  Geometry<S> g;
#define SMS_VEC3(name) Vec3<S>(p.name##_x, p.name##_y, p.name##_z)
  g.reference = SMS_VEC3(reference_point);
  g.base[0] = SMS_VEC3(base_joint_1);
  g.base[1] = SMS_VEC3(base_joint_2);
  g.base[2] = SMS_VEC3(base_joint_3);
  g.base[3] = SMS_VEC3(base_joint_4);
  g.base[4] = SMS_VEC3(base_joint_5);
  g.base[5] = SMS_VEC3(base_joint_6);
  g.platform[0] = SMS_VEC3(platform_joint_1);
  g.platform[1] = SMS_VEC3(platform_joint_2);
  g.platform[2] = SMS_VEC3(platform_joint_3);
  g.platform[3] = SMS_VEC3(platform_joint_4);
  g.platform[4] = SMS_VEC3(platform_joint_5);
  g.platform[5] = SMS_VEC3(platform_joint_6);
#undef SMS_VEC3
  using std::sqrt;
  S length[6];
  for (int i = 0; i < 6; ++i) {
    const Vec3<S> link = g.platform[i] - g.base[i];
    length[i] = sqrt(link.squaredNorm());
    const S across = sqrt(link(0) * link(0) + link(1) * link(1));
    g.joint_axis[i] = Vec3<S>(-link(1), link(0), S(0)) / across;  // e_z x link
    g.platform[i] -= g.reference;
  }
  g.actuator_length << length[0] + p.actuator_length_offset_1, length[1] + p.actuator_length_offset_2,
      length[2] + p.actuator_length_offset_3;
  g.panhard_length << length[3] + p.panhard_length_offset_1, length[4] + p.panhard_length_offset_2,
      length[5] + p.panhard_length_offset_3;
  g.stroke = p.stroke;
  return g;
}

template <typename S>
Pose<S> rest_pose(const Geometry<S>& g) {
  return {S(0), S(0), -g.reference(2), S(0), g.reference(0), g.reference(1)};
}

// The plain numbers of a geometry: itself, unless S carries derivatives.
template <typename S>
typename std::enable_if<std::is_same<S, ValueOf<S>>::value, const Geometry<S>&>::type value_of(const Geometry<S>& g) {
  return g;
}

template <typename S>
typename std::enable_if<!std::is_same<S, ValueOf<S>>::value, Geometry<ValueOf<S>>>::type value_of(
    const Geometry<S>& g) {
  Geometry<ValueOf<S>> value;
  for (int i = 0; i < 6; ++i) {
    value.base[i] = value_of(g.base[i]);
    value.platform[i] = value_of(g.platform[i]);
    value.joint_axis[i] = value_of(g.joint_axis[i]);
  }
  value.reference = value_of(g.reference);
  value.actuator_length = value_of(g.actuator_length);
  value.panhard_length = value_of(g.panhard_length);
  value.stroke = value_of(g.stroke);
  return value;
}

template <typename S>
Pose<ValueOf<S>> value_of(const Pose<S>& p) {
  return {value_of(p.roll), value_of(p.pitch), value_of(p.height), value_of(p.yaw), value_of(p.x), value_of(p.y)};
}

template <typename T, typename S>
Pose<T> cast(const Pose<S>& p) {
  return {T(p.roll), T(p.pitch), T(p.height), T(p.yaw), T(p.x), T(p.y)};
}

template <typename S>
bool is_finite(const Pose<S>& p) {
  return is_finite(p.roll) && is_finite(p.pitch) && is_finite(p.height) && is_finite(p.yaw) && is_finite(p.x) &&
         is_finite(p.y);
}

}  // namespace sms
