// Small motions about a pose at rest: stiffness, the linear model for control design, eigenfrequencies.
//
//   M dq'' + D dq' + K dq = J^T dF,     K = d(g - J^T F)/dq + J^T diag(k) J,     D = J^T diag(d) J
//
// k_i is the stiffness of actuator i at constant air mass (the force falls by k_i per metre of extension), d_i its
// viscous friction. The first term of K holds the curvatures of the potential energy U and of the three extensions
// e_i: d^2 U / dq^2 - sum F_i d^2 e_i / dq^2. It is negative here: the payload stands on top, so at constant force the
// pose is unstable, and the air springs hold it.
//
// The curvatures come out of the biases of motion.hpp without differencing: at q'' = 0 the second time derivative of a
// function f(q) is the quadratic form q' . f'' q', and six velocities determine its six coefficients.
#pragma once

#include "sms/dynamics.hpp"
#include "sms/eigen_symmetric.hpp"

namespace sms {

// U'' at q'' = 0, W: how the weights' power changes; after move().
template <typename S>
S weight_power_rate(const Mechanism<S>& mechanism, const Motion<S>& m) {
  const Body<S>& platform = mechanism.bodies.platform;
  const Vec3<S> arm = m.attitude.rotation * platform.cog;
  const Vec3<S> circling = cross(m.angular_velocity, arm);
  const Vec3<S> acceleration = m.linear_bias + cross(m.angular_bias, arm) + cross(m.angular_velocity, circling);
  S power_rate = -platform.mass * mechanism.gravity * acceleration(2);
  for (int i = 0; mechanism.bodies.moving == MovingBodies::all && i < 3; ++i) {
    using Two = Pair<S>;
    const LinkView<Two> link = link_view(mechanism, i, m);
    const LinkMotion<Two> motion = link_motion(link.state);
    const Vec3<Two>& moment = link.base.first_moment;
    const Vec3<Two> sliding(Two(0), Two(0), link.base.sliding_mass * link.state.slide_rate);
    const Vec3<Two> turning = cross(motion.omega, moment) + Two(2) * sliding;
    Vec3<Two> second = cross(motion.alpha, moment) + cross(motion.omega, turning);
    second(2) += link.base.sliding_mass * link.state.slide_acceleration;
    power_rate -= link.state.gravity.dot(second).sum();
  }
  return power_rate;
}

// Second derivatives by q of the extensions and of the potential energy.
template <typename S>
struct Curvature {
  Mat3<S> extension[3];
  Mat3<S> potential;
};

template <typename S>
Curvature<S> curvature(const Mechanism<S>& mechanism, const Pose<S>& pose) {
  Motion<S> m;
  place(mechanism.geometry, pose, m);
  Curvature<S> c;
  for (int k = 0; k < 3; ++k) {
    for (int l = k; l >= 0; --l) {  // diagonal first: the others are what a mixed velocity adds to it
      Vec3<S> rate = Vec3<S>::Unit(k);
      rate(l) = S(1);
      move(rate, m);
      const auto set = [&](Mat3<S>& form, const S& value) {
        form(k, l) = k == l ? value : S(0.5) * (value - form(k, k) - form(l, l));
        form(l, k) = form(k, l);
      };
      for (int i = 0; i < 3; ++i) {
        set(c.extension[i], m.extension_bias(i));
      }
      set(c.potential, weight_power_rate(mechanism, m));
    }
  }
  return c;
}

// Per actuator.
template <typename S>
struct ActuatorLaw {
  Vec3<S> force;      // F at the pose, N
  Vec3<S> stiffness;  // k, N/m
  Vec3<S> damping;    // d, N s/m
};

template <typename S>
struct LinearModel {
  Mat3<S> mass;       // M
  Mat3<S> damping;    // D
  Mat3<S> stiffness;  // K
  Mat3<S> input;      // J^T
};

// About a pose that fits the rods. With law.force the holding force the pose is an equilibrium.
template <typename S>
LinearModel<S> linearise(const Mechanism<S>& mechanism, const Pose<S>& pose, const ActuatorLaw<S>& law) {
  DynamicsTerms<S> t;
  evaluate_dynamics(mechanism, pose, Vec3<S>(Vec3<S>::Zero()), t);
  const Curvature<S> c = curvature(mechanism, pose);
  const Mat3<S>& slope = t.motion.extension_slope;
  LinearModel<S> model;
  model.mass = t.mass_matrix;
  model.input = slope.transpose();
  model.damping = slope.transpose() * law.damping.asDiagonal() * slope;
  model.stiffness = c.potential + slope.transpose() * law.stiffness.asDiagonal() * slope;
  for (int i = 0; i < 3; ++i) {
    model.stiffness -= law.force(i) * c.extension[i];
  }
  return model;
}

// x' = A x + B dF with x = (dq, dq').
template <typename S>
struct StateSpace {
  Eigen::Matrix<S, 6, 6> a;
  Eigen::Matrix<S, 6, 3> b;
};

template <typename S>
StateSpace<S> state_space(const LinearModel<S>& model) {
  const Mat3<S> compliance = inverse(model.mass);
  StateSpace<S> s;
  s.a << Mat3<S>::Zero(), Mat3<S>::Identity(), -compliance * model.stiffness, -compliance * model.damping;
  s.b << Mat3<S>::Zero(), compliance * model.input;
  return s;
}

// K v = lambda M v. A positive lambda is the square of an angular frequency, a negative one that of a growth rate.
template <typename S>
struct Modes {
  Vec3<S> lambda;  // 1/s^2, ascending
  Mat3<S> shape;   // columns in q, with v^T M v = 1
};

template <typename S>
Modes<S> modes(const LinearModel<S>& model) {
  const SymmetricEigen<S, 3> mass = symmetric_eigen<S, 3>(model.mass);
  const Mat3<S> root = mass.vectors * mass.values.cwiseSqrt().cwiseInverse().asDiagonal();  // root root^T = M^-1
  const Mat3<S> scaled = root.transpose() * model.stiffness * root;
  const SymmetricEigen<S, 3> e = symmetric_eigen<S, 3>(S(0.5) * (scaled + scaled.transpose()));
  return {e.values, root * e.vectors};
}

// Hz; zero for a mode that does not oscillate.
template <typename S>
S natural_frequency(const S& lambda) {
  using std::sqrt;
  return lambda > S(0) ? sqrt(lambda) / S(6.283185307179586) : S(0);
}

// 1/s; zero for a mode that does not grow.
template <typename S>
S growth_rate(const S& lambda) {
  using std::sqrt;
  return lambda < S(0) ? sqrt(-lambda) : S(0);
}

}  // namespace sms
