// Inverse kinematics: (roll, pitch, height) to the three extensions (dissertation, section 3.2.2 and figure 3.4).
//
// Roll, pitch and height are chosen; yaw, x and y are what the three Panhard rods leave of freedom: none. With roll and
// pitch known every rod's platform joint s_i = Ry Rx p_i keeps its height while the platform yaws, so that the rod's
// length constrains only the distance in plan,
//
//   | Rz(yaw) s_i + (x, y) - b_i |^2 = L_i^2 - (s_iz + z - b_iz)^2,     i = 4..6, in the plane
//
// three circles: a planar mechanism with three equations for (x, y, yaw), solved by Newton's method with its exact 3x3
// Jacobian. The actuators' lengths then are distances between known points (eq. 3.6).
//
// Valid for angles within largest_angle(). There is a second solution at a yaw of about -161 deg, which is another
// machine; it is never returned. The stroke is not a limit here: see workspace.hpp.
#pragma once

#include "sms/geometry.hpp"
#include "sms/newton.hpp"
#include "sms/rotation.hpp"
#include "sms/sms.h"

namespace sms {

// The rods, seen from above with roll, pitch and height given.
template <typename S>
struct PlanRods {
  S joint_x[3], joint_y[3];  // s_i, m, before yaw
  S base_x[3], base_y[3];    // b_i, m
  S reach_squared[3];        // squared length of the rod in plan, m^2
};

template <typename S>
PlanRods<S> plan_rods(const Geometry<S>& g, const SineCosine<S>& roll, const SineCosine<S>& pitch, const S& height) {
  PlanRods<S> rods;
  for (int i = 0; i < 3; ++i) {
    const Vec3<S> s = tilted(roll, pitch, g.platform[3 + i]);
    const S drop = s(2) - height - g.base[3 + i](2);
    rods.joint_x[i] = s(0);
    rods.joint_y[i] = s(1);
    rods.base_x[i] = g.base[3 + i](0);
    rods.base_y[i] = g.base[3 + i](1);
    rods.reach_squared[i] = g.panhard_length(i) * g.panhard_length(i) - drop * drop;
  }
  return rods;
}

template <typename S>
PlanRods<ValueOf<S>> value_of(const PlanRods<S>& rods) {
  PlanRods<ValueOf<S>> value;
  for (int i = 0; i < 3; ++i) {
    value.joint_x[i] = value_of(rods.joint_x[i]);
    value.joint_y[i] = value_of(rods.joint_y[i]);
    value.base_x[i] = value_of(rods.base_x[i]);
    value.base_y[i] = value_of(rods.base_y[i]);
    value.reach_squared[i] = value_of(rods.reach_squared[i]);
  }
  return value;
}

// Half the excess of each rod's squared length in plan, m^2, and its derivatives by x, y and yaw.
template <typename S>
struct PlanError {
  Vec3<S> excess;
  Mat3<S> slope;
};

template <typename S>
PlanError<S> plan_error(const PlanRods<S>& rods, const Vec3<S>& x_y_yaw) {
  const SineCosine<S> yaw = sine_cosine(x_y_yaw(2));
  PlanError<S> e;
  for (int i = 0; i < 3; ++i) {
    const S arm_x = yaw.cosine * rods.joint_x[i] - yaw.sine * rods.joint_y[i];
    const S arm_y = yaw.sine * rods.joint_x[i] + yaw.cosine * rods.joint_y[i];
    const S rod_x = arm_x + x_y_yaw(0) - rods.base_x[i];
    const S rod_y = arm_y + x_y_yaw(1) - rods.base_y[i];
    e.excess(i) = S(0.5) * (rod_x * rod_x + rod_y * rod_y - rods.reach_squared[i]);
    e.slope.row(i) << rod_x, rod_y, arm_x * rod_y - arm_y * rod_x;
  }
  return e;
}

// Newton's method on the three rods, up to the last step. The slope is that of the last step taken.
template <typename V>
struct PlanSolution {
  Vec3<V> x_y_yaw;
  Mat3<V> inverse_slope;
  V last_step;  // largest component, rad or m
};

// Of poses side by side those that have arrived stand still until all have, so that none depends on its neighbours.
template <typename V>
sms_status solve_plan(const PlanRods<V>& rods, PlanSolution<V>& solution, Count<V>& iterations) {
  using std::abs;
  auto moving = V(0) < V(1);
  iterations = Count<V>(0);
  for (int n = 0; n < largest_iteration_count(); ++n) {
    const PlanError<V> error = plan_error(rods, solution.x_y_yaw);
    const Mat3<V> inverse_slope = inverse(error.slope);
    const Vec3<V> step = product(inverse_slope, error.excess);
    const V largest = largest_magnitude(step);
    const Vec3<V> stepped = solution.x_y_yaw - damping(largest) * step;
    renew(moving, solution.x_y_yaw, stepped);
    renew(moving, solution.inverse_slope, inverse_slope);
    renew(moving, solution.last_step, largest);
    iterations += select(moving, Count<V>(1), Count<V>(0));
    if (!all(abs(solution.x_y_yaw(2)) <= largest_angle<V>())) {
      return SMS_OUT_OF_WORKSPACE;
    }
    moving = moving && !(solution.last_step < close_step<V>());
    if (!any(moving)) {
      return SMS_OK;
    }
  }
  return SMS_NOT_CONVERGED;
}

template <typename V>
Vec3<V> last_step_of_plan(const PlanRods<V>& rods, const PlanRods<V>& /*the same*/, const PlanSolution<V>& solution) {
  const auto arrived = solution.last_step < negligible_step<V>();
  if (all(arrived)) {
    return solution.x_y_yaw;
  }
  const Vec3<V> stepped = solution.x_y_yaw - product(solution.inverse_slope, plan_error(rods, solution.x_y_yaw).excess);
  return select(arrived, solution.x_y_yaw, stepped);
}

// With derivatives: first in their values, then once more with the slope of the solution itself.
template <typename S, typename V>
Vec3<S> last_step_of_plan(const PlanRods<S>& rods, const PlanRods<V>& rods_value, const PlanSolution<V>& solution) {
  const Vec3<V> found = last_step_of_plan(rods_value, rods_value, solution);
  const Mat3<V> inverse_slope = inverse(plan_error(rods_value, found).slope);
  const Vec3<S> at = found.template cast<S>();
  return at - inverse_slope.template cast<S>() * plan_error(rods, at).excess;
}

// Largest error of a rod's length, m: the excess is half that of the squared length.
template <typename V>
V length_error(const Vec3<V>& excess, const Vec3<V>& panhard_length) {
  return largest_magnitude(Vec3<V>(excess.cwiseQuotient(panhard_length)));
}

// Roll and pitch of q = (roll, pitch, height).
template <typename S>
struct Tilt {
  SineCosine<S> roll;
  SineCosine<S> pitch;
};

template <typename S>
inline Tilt<S> tilt_of(const Vec3<S>& q) {
  return {sine_cosine(q(0)), sine_cosine(q(1))};
}

// The pose of q, whose tilt it is given too; the search starts at the yaw, x and y of `start`. On any status but SMS_OK
// the pose is as it was.
template <typename S>
sms_status complete_pose(const Geometry<S>& g, const Vec3<S>& q, const Tilt<S>& tilt, const Pose<ValueOf<S>>& start,
                         Pose<S>& pose, Convergence<ValueOf<S>>* convergence = nullptr) {
  using V = ValueOf<S>;
  using std::abs;
  if (convergence != nullptr) {
    *convergence = not_begun<V>();
  }
  if (!is_finite(q) || !is_finite(start)) {
    return SMS_NOT_A_NUMBER;
  }
  if (any(abs(value_of(q(0))) > largest_angle<V>()) || any(abs(value_of(q(1))) > largest_angle<V>())) {
    return SMS_OUT_OF_WORKSPACE;
  }
  const PlanRods<S> rods = plan_rods(g, tilt.roll, tilt.pitch, q(2));
  const PlanRods<V> rods_value = value_of(rods);
  for (int i = 0; i < 3; ++i) {
    if (!all(rods_value.reach_squared[i] > V(0))) {
      return SMS_OUT_OF_WORKSPACE;
    }
  }
  PlanSolution<V> solution = {Vec3<V>(start.x, start.y, start.yaw), Mat3<V>::Zero(), V(0)};
  Count<V> iterations(0);
  const sms_status status = solve_plan(rods_value, solution, iterations);
  const Vec3<S> x_y_yaw = last_step_of_plan(rods, rods_value, solution);
  if (convergence != nullptr) {
    const Vec3<V> left = plan_error(rods_value, status == SMS_OK ? value_of(x_y_yaw) : solution.x_y_yaw).excess;
    *convergence = {iterations, length_error(left, value_of(g.panhard_length))};
  }
  if (status == SMS_OK) {
    pose = {q(0), q(1), q(2), x_y_yaw(2), x_y_yaw(0), x_y_yaw(1)};
  }
  return status;
}

// Pose and extensions of q, as above.
template <typename S>
sms_status inverse_kinematics(const Geometry<S>& g, const Vec3<S>& q, const Pose<ValueOf<S>>& start, Pose<S>& pose,
                              Vec3<S>& extension, Convergence<ValueOf<S>>* convergence = nullptr) {
  using std::sqrt;
  const Tilt<S> tilt = tilt_of(q);
  const sms_status status = complete_pose(g, q, tilt, start, pose, convergence);
  if (status != SMS_OK) {
    return status;
  }
  const SineCosine<S> yaw = sine_cosine(pose.yaw);
  for (int i = 0; i < 3; ++i) {
    const Vec3<S> s = tilted(tilt.roll, tilt.pitch, g.platform[i]);
    const Vec3<S> leg(yaw.cosine * s(0) - yaw.sine * s(1) + pose.x - g.base[i](0),
                      yaw.sine * s(0) + yaw.cosine * s(1) + pose.y - g.base[i](1), s(2) - pose.height - g.base[i](2));
    extension(i) = sqrt(dot(leg, leg)) - g.actuator_length(i);
  }
  return SMS_OK;
}

}  // namespace sms
