#include "estimation/measured_path.hpp"

#include "sms/compiled_mechanism.hpp"
#include "sms/forward_kinematics.hpp"

namespace sms {
namespace estimation {
namespace {

// `near` comes in as a pose nearby and leaves as the one found. A path that leaves the workspace stays where it left it.
PathPoint<double> point_at(const Mechanism<double>& mechanism, const Vec3<double>& extension, const Vec3<double>& rate,
                           Pose<double>* near) {
  forward_kinematics(mechanism.geometry, extension, *near, *near);
  const Pose<double>& pose = *near;
  DynamicsTerms<double> t;
  place(mechanism.geometry, pose, t.motion);
  PathPoint<double> point;
  point.extension = extension;
  point.q << pose.roll, pose.pitch, pose.height;
  point.to_pose = inverse(t.motion.extension_slope);
  evaluate_dynamics(mechanism, pose, Vec3<double>(point.to_pose * rate), t);
  const Mat3<double> transposed = point.to_pose.transpose();
  point.mass = symmetric_product<double>(point.to_pose, t.mass_matrix * point.to_pose);
  point.load = point.mass * t.motion.extension_bias - transposed * (t.inertial + t.weight);
  point.drag.setZero();
  for (int rod = 3; rod < 6; ++rod) {
    const double per_speed = t.motion.reciprocal_length[rod] * t.motion.reciprocal_length[rod];
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3<double> along = transposed * joint_load(t.motion, rod, Vec3<double>(Vec3<double>::Unit(axis)));
      point.drag += per_speed * along * along.transpose();
    }
  }
  return point;
}

// By differences of a millimetre either way.
Mat3<double> leaning_at(const Mechanism<double>& mechanism, const Vec3<double>& extension) {
  constexpr double kStep = 1e-3;
  const Vec3<double> still = Vec3<double>::Zero();
  Pose<double> near = rest_pose(mechanism.geometry);
  Mat3<double> slope;
  for (int i = 0; i < 3; ++i) {
    const Vec3<double> aside = kStep * Vec3<double>::Unit(i);
    const Vec3<double> more = point_at(mechanism, extension + aside, still, &near).load;
    const Vec3<double> less = point_at(mechanism, extension - aside, still, &near).load;
    slope.col(i) = (more - less) / (2.0 * kStep);
  }
  return slope;
}

}  // namespace

MeasuredPath<double> measured_path(const Params<double>& p, MassModel masses, const MeasuredMotion& motion) {
  const Mechanism<double> mechanism = make_mechanism(p, masses);
  MeasuredPath<double> path;
  path.points.reserve(motion.extension.size());
  Pose<double> near = rest_pose(mechanism.geometry);
  for (std::size_t k = 0; k < motion.extension.size(); ++k) {
    path.points.push_back(point_at(mechanism, motion.extension[k], motion.rate[k], &near));
  }
  path.leaning = leaning_at(mechanism, motion.extension[motion.extension.size() / 2]);
  return path;
}

std::shared_ptr<const MeasuredPath<double>> KnownPaths::of(int window, const Params<double>& p, MassModel masses,
                                                           const MeasuredMotion& motion) {
  std::vector<double> made_of = {static_cast<double>(masses)};
  for (int k = 0; k < param_count; ++k) {
    if (is_of_mechanism(k)) {
      made_of.push_back(param(p, k));
    }
  }
  for (std::size_t i = 0; i < motion.extension.size(); ++i) {
    const Vec3<double>&extension = motion.extension[i], &rate = motion.rate[i];
    made_of.insert(made_of.end(), extension.data(), extension.data() + 3);
    made_of.insert(made_of.end(), rate.data(), rate.data() + 3);
  }
  {
    const std::lock_guard<std::mutex> alone(mutex_);
    const auto found = known_.find(window);
    if (found != known_.end() && found->second.made_of == made_of) {
      return found->second.path;
    }
  }
  const auto path = std::make_shared<const MeasuredPath<double>>(measured_path(p, masses, motion));
  const std::lock_guard<std::mutex> alone(mutex_);
  known_[window] = {std::move(made_of), path};
  return path;
}

}  // namespace estimation
}  // namespace sms
