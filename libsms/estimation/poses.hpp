// The mechanism as built, from measured poses.
//
// A pose is three readings of the actuators' position sensors and some of roll, pitch, height, yaw, x and y, and of
// distances between marks on the ground and on the platform. The readings of the actuators go through the library's
// forward kinematics, whose last Newton step carries the derivatives (the implicit function theorem on |l_i|^2 = L_i^2);
// what is left is the measured pose. Its covariance is that of the pose sensors and, to first order, that of the position
// sensors through the same derivative:
//
//   Sigma = R + A diag(s_e^2) A^T,    A = d pose / d extension at the start
//
// and a residual is L^-1 (predicted - measured) with Sigma = L L^T. Drawing tolerances are the prior of every parameter.
#pragma once

#include <string>
#include <vector>

#include "estimation/leg_params.hpp"
#include "estimation/problem.hpp"

namespace sms {
namespace estimation {

constexpr int pose_coordinates = 6;  // roll, pitch, height, yaw, x, y

// A tape, a wire or a laser between two marks. Both are given in world axes with the platform at rest, as joints are.
struct MarkedDistance {
  Vec3<double> ground;    // m
  Vec3<double> platform;  // m
};

struct MeasuredPoses {
  RowMatrix extension;                    // (poses, 3) as read, m
  RowMatrix pose;                         // (poses, 6 + distances) as read, rad and m; NaN: not measured
  Eigen::VectorXd extension_noise;        // (3), standard deviations, m
  Eigen::VectorXd pose_noise;             // (6 + distances), rad and m
  std::vector<MarkedDistance> distances;  // what the columns behind the six coordinates are
};

class PoseProblem : public ProblemOf<LegParams<double>> {
 public:
  // std::invalid_argument for shapes that do not match, noise that is not positive, a pose without a reading, and
  // extensions of which `start` has no pose.
  PoseProblem(MeasuredPoses measured, const LegParams<double>& start);

  int poses() const { return static_cast<int>(measured_.extension.rows()); }
  int rows() const override { return first_row_.back(); }
  const std::vector<int>& first_row() const { return first_row_; }  // (poses + 1)

  // What the pose sensors should read, (poses, 6 + distances); NaN where there is no pose.
  RowMatrix predict(const LegParams<double>& params) const;

  // NaN where the parameters have no pose of these extensions.
  void evaluate(const LegParams<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override;
  void evaluate_pose(int pose, const LegParams<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                     RowMatrix* jacobian) const;

 private:
  int channels() const { return static_cast<int>(measured_.pose.cols()); }

  MeasuredPoses measured_;
  std::vector<std::vector<int>> read_;      // channels of each pose that were measured
  std::vector<Eigen::MatrixXd> whitening_;  // L^-1 of each pose
  std::vector<int> first_row_;
};

struct Calibration {
  LegParams<double> params;
  Eigen::VectorXd residual;  // whitened, at params
  RowMatrix jacobian;        // whitened, rows x free
  int iterations = 0;
  bool converged = false;
  std::string message;
};

// minimise  sum over poses rho(|r_pose|^2) + sum_k ((theta_k - start_k) / tolerance_k)^2
//
// by Ceres; rho is Huber's loss beyond `huber` standard deviations of a pose, or the square itself for huber = 0.
// std::invalid_argument for a tolerance that is not positive.
Calibration calibrate(const PoseProblem& problem, const LegParams<double>& start, const std::vector<int>& free,
                      const Eigen::VectorXd& tolerance, double huber, int max_iterations = 100);

}  // namespace estimation
}  // namespace sms
