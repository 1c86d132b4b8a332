// One link, seen from its platform joint P: an actuator (cylinder and piston) or a Panhard rod.
//
// A link has no freedom of its own: where P goes, it follows. In the link's axes (x, y, z along B to P, see bodies.hpp)
// with v the velocity of P, l the length, s' = v_z the rate of the extension,
//
//   omega_x = -v_y / l,   omega_y = v_x / l,   omega_z = tau omega_x
//
// where tau = e_z / e_x is the slope of the universal joint's ground-fixed axis e in these axes (e_y = 0): the joint
// lets the link turn about e and about y only, which fixes the spin. Differentiated, with tau' = omega_y (1 + tau^2),
// the same relations give the angular acceleration alpha from that of P.
//
// So all its inertia can be moved to P. With I the inertia of both bodies about B, m the mass of the piston and rho its
// centre of gravity from B, the kinetic energy is that of an apparent mass A at P,
//
//   T = 1/2 omega . I omega + m s' e_z . (omega x rho) + 1/2 m s'^2 = 1/2 v . A v
//
// and the moment about B and the force along the link that keep it moving,
//
//   N = I alpha + omega x I omega + m rho x b,   F_z = m (alpha x rho + omega x (omega x rho) + b)_z
//   b = 2 s' omega x e_z + s'' e_z
//
// come to P by the same map as the velocities: f_x = N_y / l, f_y = -(N_x + tau N_z) / l, f_z = F_z. A rod swings and
// does not slide (s' = 0, m = 0): x and y, across the link, are all it has.
#pragma once

#include "sms/bodies.hpp"

namespace sms {

template <typename S>
using Across = Eigen::Matrix<S, 2, 1>;  // x and y of a link's axes

// A link in a pose, in its own axes.
template <typename S>
struct LinkState {
  S reciprocal_length;     // 1 / l, 1/m
  S axis_slope;            // tau
  Across<S> velocity;      // of P, m/s
  Across<S> acceleration;  // of P at q'' = 0, m/s^2
  S slide_rate;            // s', m/s
  S slide_acceleration;    // s'' at q'' = 0, m/s^2
  Vec3<S> gravity;         // acceleration of free fall, m/s^2
};

template <typename S>
struct LinkMotion {
  Vec3<S> omega;  // rad/s
  Vec3<S> alpha;  // at q'' = 0, rad/s^2
};

// v_x' = a_x - (omega x v)_x, and alike for y, because the axes turn; with omega = (-v_y, v_x, ...) / l.
template <typename S>
inline LinkMotion<S> link_motion(const LinkState<S>& s) {
  LinkMotion<S> m;
  const S tau = s.axis_slope, coriolis = S(2) * s.slide_rate;
  m.omega(0) = -s.velocity(1) * s.reciprocal_length;
  m.omega(1) = s.velocity(0) * s.reciprocal_length;
  m.omega(2) = tau * m.omega(0);
  m.alpha(0) = m.omega(1) * m.omega(2) - (s.acceleration(1) + coriolis * m.omega(0)) * s.reciprocal_length;
  m.alpha(1) = (s.acceleration(0) - coriolis * m.omega(1)) * s.reciprocal_length - m.omega(0) * m.omega(2);
  m.alpha(2) = tau * m.alpha(0) + m.omega(0) * m.omega(1) * (S(1) + tau * tau);
  return m;
}

// Inertia and first moment about B, of one body or the sum of two.
template <typename S>
struct BaseLoad {
  S mass;                // kg
  Mat3<S> inertia;       // I
  Vec3<S> first_moment;  // sum of mass times centre of gravity, kg m
  S sliding_mass;        // m
  Vec3<S> sliding_cog;   // rho
};

// A link of this length: the piston is carried out with P, its inertia by Steiner's theorem.
template <typename S>
inline BaseLoad<S> base_load(const Body<S>& hung, const Body<S>& sliding, const S& length) {
  const S lever = sliding.mass * length;
  const Vec3<S> cog(sliding.cog(0), sliding.cog(1), sliding.cog(2) + length);
  const S across = lever * (sliding.cog(2) + cog(2));
  const Mat3<S> carried = symmetric(across, across, S(0), S(0), S(-lever * cog(0)), S(-lever * cog(1)));
  return {hung.mass + sliding.mass, hung.inertia + sliding.inertia + carried, hung.mass * hung.cog + sliding.mass * cog,
          sliding.mass, cog};
}

// What a link brings to P, in its own axes.
template <typename S>
struct LinkLoad {
  Mat3<S> apparent_mass;  // A, kg
  Vec3<S> inertial;       // force that keeps it moving at q'' = 0, N
  Vec3<S> weight;         // force that carries it, N
};

template <typename S>
inline LinkLoad<S> link_load(const BaseLoad<S>& b, const LinkState<S>& s, const LinkMotion<S>& m) {
  const S tau = s.axis_slope, scale = s.reciprocal_length, mass = b.sliding_mass, coriolis = S(2) * s.slide_rate;
  const Mat3<S>& i = b.inertia;
  const Vec3<S>& rho = b.sliding_cog;
  const Vec3<S> spinning = i * m.omega;
  const Vec3<S> sliding(mass * coriolis * m.omega(1), -mass * coriolis * m.omega(0), mass * s.slide_acceleration);
  const Vec3<S> moment = i * m.alpha + cross(m.omega, spinning) + cross(rho, sliding);
  const Vec3<S> circling = cross(m.omega, rho);
  const S along = m.alpha(0) * rho(1) - m.alpha(1) * rho(0) + m.omega(0) * circling(1) - m.omega(1) * circling(0);
  const Vec3<S> hanging = cross(s.gravity, b.first_moment);

  LinkLoad<S> load;
  load.inertial << moment(1) * scale, -(moment(0) + tau * moment(2)) * scale, mass * along + sliding(2);
  load.weight << hanging(1) * scale, -(hanging(0) + tau * hanging(2)) * scale, -mass * s.gravity(2);
  const S square = scale * scale, side = -mass * scale;
  load.apparent_mass = symmetric(S(square * i(1, 1)), S(square * (i(0, 0) + tau * (S(2) * i(0, 2) + tau * i(2, 2)))),
                                 mass, S(-square * (i(0, 1) + tau * i(1, 2))), S(side * rho(0)), S(side * rho(1)));
  return load;
}

}  // namespace sms
