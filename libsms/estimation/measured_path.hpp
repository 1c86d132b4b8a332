// The mechanism along the path that its pistons were measured on.
//
// Masses and weights depend on the pose, and the pose is measured: extensions to a tenth of a millimetre. So a
// simulation that is held against a record need not carry the mechanism through every step: it is evaluated once a
// sample, in the coordinates of the pistons (platform.hpp),
//
//   m(e) e'' + F_f(e', e'') = F + w(e, e'),      m = J^-T M J^-1,   w = J^-T (Q - h - g) + m J' q'
//
// on the measured path, and what the simulated pistons deviate from it enters to first order: a weight that leans, by the
// slope of w, and an attitude, by J^-1. Of the mass nothing does: a millimetre changes it by a thousandth.
//
// Where the position sensors are wrong the path is what they would have read were they right, by the parameters of the
// moment.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "estimation/measured_motion.hpp"
#include "sms/dynamics.hpp"
#include "sms/integrate.hpp"

namespace sms {
namespace estimation {

template <typename S>
struct PathPoint {
  using Scalar = S;
  Vec3<S> extension;  // m
  Vec3<S> q;          // roll, pitch, height
  Mat3<S> to_pose;    // J^-1
  Mat3<S> mass;       // m, kg
  Vec3<S> load;       // w without the rods' friction, N
  Mat3<S> drag;       // of the Panhard rods' joints: force per piston speed, for panhard_friction = 1
};

template <typename S>
struct MeasuredPath {
  std::vector<PathPoint<S>> points;  // one a sample
  Mat3<S> leaning;                   // d w / d e at rest in the middle, N/m
};

MeasuredPath<double> measured_path(const Params<double>& p, MassModel masses, const MeasuredMotion& motion);

// The last path of each window, a number of its own: while what it is made of stays, so does the path. Any thread.
class KnownPaths {
 public:
  std::shared_ptr<const MeasuredPath<double>> of(int window, const Params<double>& p, MassModel masses,
                                                 const MeasuredMotion& motion);

 private:
  struct Known {
    std::vector<double> made_of;
    std::shared_ptr<const MeasuredPath<double>> path;
  };
  std::mutex mutex_;
  std::map<int, Known> known_;
};

// ---- with derivatives ----
//
// Only gravity, joints and bodies move the path. Against them it is differenced, both ways: a few runs of the mechanism in
// plain numbers are cheaper than one that carries derivatives.

constexpr bool is_of_mechanism(int index) {
  return index == index_of_gravity || (index >= index_of_base_joint_1_x && index <= index_of_panhard_inertia_axial);
}

template <typename S>
Params<ValueOf<S>> plain_params(const Params<S>& p) {
  Params<ValueOf<S>> value;
  for (int k = 0; k < param_count; ++k) {
    param(value, k) = value_of(param(p, k));
  }
  return value;
}

// here: the path in plain numbers.
inline const MeasuredPath<double>& path_with_slopes(const MeasuredPath<double>& here, const Params<double>&, MassModel,
                                                    const MeasuredMotion&) {
  return here;
}

template <typename Jet>
MeasuredPath<Jet> path_with_slopes(const MeasuredPath<double>& here, const Params<Jet>& p, MassModel masses,
                                   const MeasuredMotion& motion) {
  const Params<double> plain = plain_params(p);
  MeasuredPath<Jet> path{std::vector<PathPoint<Jet>>(here.points.size()), here.leaning.cast<Jet>()};
  for (std::size_t i = 0; i < here.points.size(); ++i) {
    vector_of(path.points[i]) = vector_of(here.points[i]).template cast<Jet>();
  }
  for (int direction = 0; direction < Jet::DIMENSION; ++direction) {
    Params<double> less = plain, more = plain;
    double step = 0.0;
    for (int k = 0; k < param_count; ++k) {
      const double slope = param(p, k).v[direction];
      if (is_of_mechanism(k) && std::abs(slope) > 0.0) {
        step = step > 0.0 ? step : 1e-5 * std::max(1.0, std::abs(param(plain, k))) / std::abs(slope);
        param(less, k) -= step * slope;
        param(more, k) += step * slope;
      }
    }
    if (step > 0.0) {
      const MeasuredPath<double> low = measured_path(less, masses, motion), high = measured_path(more, masses, motion);
      for (std::size_t i = 0; i < here.points.size(); ++i) {
        const auto slope = ((vector_of(high.points[i]) - vector_of(low.points[i])) / (2.0 * step)).eval();
        auto point = vector_of(path.points[i]);
        for (Eigen::Index k = 0; k < slope.size(); ++k) {
          point(k).v[direction] = slope(k);
        }
      }
    }
  }
  return path;
}

}  // namespace estimation
}  // namespace sms
