#include "estimation/poses.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "estimation/jets.hpp"
#include "sms/forward_kinematics.hpp"
#include "sms/sensor.hpp"

namespace sms {
namespace estimation {
namespace {

template <typename S>
using Readings = Eigen::Matrix<S, Eigen::Dynamic, 1>;

template <typename S>
S distance_of(const MarkedDistance& marks, const Geometry<S>& g, const Pose<S>& pose) {
  using std::sqrt;
  const Vec3<S> arm = marks.platform.cast<S>() - g.reference;
  const Vec3<S> place(pose.x, pose.y, -pose.height);
  const Vec3<S> between = attitude(pose.roll, pose.pitch, pose.yaw).rotation * arm + place - marks.ground.cast<S>();
  return sqrt(between.squaredNorm());
}

// What the pose sensors should read where the position sensors read `extension`.
template <typename S>
bool predicted(const LegParams<S>& params, const std::vector<MarkedDistance>& distances, const Vec3<S>& extension,
               Readings<S>& reading) {
  const Geometry<S> g = make_geometry<S>(params);
  Vec3<S> truth;
  for (int i = 0; i < 3; ++i) {
    const Params<S>& leg = params.shift[i];
    truth(i) = sensor_truth(extension(i), S(params.sensor_gain_extension + leg.sensor_gain_extension),
                            S(params.sensor_offset_extension + leg.sensor_offset_extension));
  }
  Pose<S> pose;
  if (forward_kinematics(g, truth, rest_pose(value_of(g)), pose) != SMS_OK) {
    return false;
  }
  reading.resize(pose_coordinates + static_cast<Eigen::Index>(distances.size()));
  reading.template head<pose_coordinates>()
      << sensor_reading(pose.roll, params.sensor_gain_roll, params.sensor_offset_roll),
      sensor_reading(pose.pitch, params.sensor_gain_pitch, params.sensor_offset_pitch), pose.height, pose.yaw, pose.x,
      pose.y;
  for (std::size_t d = 0; d < distances.size(); ++d) {
    reading(pose_coordinates + static_cast<Eigen::Index>(d)) = distance_of(distances[d], g, pose);
  }
  return true;
}

void check(const MeasuredPoses& m) {
  const Eigen::Index channels = pose_coordinates + static_cast<Eigen::Index>(m.distances.size());
  if (m.extension.rows() < 1 || m.extension.cols() != 3 || m.pose.cols() != channels ||
      m.pose.rows() != m.extension.rows() || m.extension_noise.size() != 3 || m.pose_noise.size() != channels) {
    throw std::invalid_argument(
        "poses: extension is (n, 3), pose (n, 6 + distances), extension_noise (3), pose_noise (6 + distances)");
  }
  for (const MarkedDistance& d : m.distances) {
    if (!d.ground.allFinite() || !d.platform.allFinite()) {
      throw std::invalid_argument("poses: a mark of a distance is no point");
    }
  }
  if (!(m.extension_noise.minCoeff() > 0.0) || !(m.pose_noise.minCoeff() > 0.0)) {
    throw std::invalid_argument("poses: every noise is above zero");
  }
}

}  // namespace

PoseProblem::PoseProblem(MeasuredPoses measured, const LegParams<double>& start)
    : measured_(std::move(measured)), first_row_{0} {
  check(measured_);
  const LegParams<Jet<4>> params = cast<Jet<4>>(start);
  for (int pose = 0; pose < poses(); ++pose) {
    std::vector<int> read;
    for (int c = 0; c < channels(); ++c) {
      if (std::isfinite(measured_.pose(pose, c))) {
        read.push_back(c);
      }
    }
    Vec3<Jet<4>> extension;
    for (int i = 0; i < 3; ++i) {
      extension(i) = Jet<4>(measured_.extension(pose, i), i);
    }
    Readings<Jet<4>> reading;
    if (read.empty() || !predicted(params, measured_.distances, extension, reading)) {
      throw std::invalid_argument("poses: pose " + std::to_string(pose + 1) +
                                  (read.empty() ? " has no reading" : " is out of reach of the start's geometry"));
    }
    const auto n = static_cast<Eigen::Index>(read.size());
    Eigen::MatrixXd slope(n, 3), covariance = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index r = 0; r < n; ++r) {
      const int c = read[static_cast<std::size_t>(r)];
      for (int i = 0; i < 3; ++i) {
        slope(r, i) = reading(c).v[i] * measured_.extension_noise(i);
      }
      covariance(r, r) = measured_.pose_noise(c) * measured_.pose_noise(c);
    }
    covariance += slope * slope.transpose();
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    whitening_.push_back(factor.matrixL().solve(Eigen::MatrixXd::Identity(n, n)));
    first_row_.push_back(first_row_.back() + static_cast<int>(n));
    read_.push_back(std::move(read));
  }
}

RowMatrix PoseProblem::predict(const LegParams<double>& params) const {
  RowMatrix readings = RowMatrix::Constant(poses(), channels(), std::numeric_limits<double>::quiet_NaN());
  for (int pose = 0; pose < poses(); ++pose) {
    Readings<double> reading;
    if (predicted(params, measured_.distances, Vec3<double>(measured_.extension.row(pose).transpose()), reading)) {
      readings.row(pose) = reading.transpose();
    }
  }
  return readings;
}

void PoseProblem::evaluate_pose(int pose, const LegParams<double>& params, const std::vector<int>& free,
                                Eigen::VectorXd* residual, RowMatrix* jacobian) const {
  const std::vector<int>& read = read_[static_cast<std::size_t>(pose)];
  const auto model = [&](const auto& machine, auto* out) {
    using S = typename std::remove_reference<decltype(out[0])>::type;
    const Vec3<S> extension = measured_.extension.row(pose).transpose().template cast<S>();
    Readings<S> reading;
    const bool found = predicted(machine, measured_.distances, extension, reading);
    for (std::size_t r = 0; r < read.size(); ++r) {
      out[r] =
          found ? S(reading(read[r]) - S(measured_.pose(pose, read[r]))) : S(std::numeric_limits<double>::quiet_NaN());
    }
  };
  evaluate_with_jets<12>(model, static_cast<int>(read.size()), params, free, residual, jacobian);
  const Eigen::MatrixXd& whitening = whitening_[static_cast<std::size_t>(pose)];
  *residual = (whitening * *residual).eval();
  if (jacobian != nullptr) {
    *jacobian = (whitening * *jacobian).eval();
  }
}

void PoseProblem::evaluate(const LegParams<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                           RowMatrix* jacobian) const {
  residual->resize(rows());
  if (jacobian != nullptr) {
    jacobian->resize(rows(), static_cast<Eigen::Index>(free.size()));
  }
  Eigen::VectorXd part;
  RowMatrix slopes;
  for (int pose = 0; pose < poses(); ++pose) {
    evaluate_pose(pose, params, free, &part, jacobian != nullptr ? &slopes : nullptr);
    residual->segment(first_row_[static_cast<std::size_t>(pose)], part.size()) = part;
    if (jacobian != nullptr) {
      jacobian->middleRows(first_row_[static_cast<std::size_t>(pose)], part.size()) = slopes;
    }
  }
}

namespace {

// What is being looked for: x_k = (theta_k - start_k) / tolerance_k.
struct Search {
  const PoseProblem& problem;
  const LegParams<double>& start;
  const std::vector<int>& free;
  const Eigen::VectorXd& tolerance;

  LegParams<double> params_at(const double* x) const {
    LegParams<double> params = start;
    for (std::size_t k = 0; k < free.size(); ++k) {
      param(params, free[k]) += tolerance(static_cast<Eigen::Index>(k)) * x[k];
    }
    return params;
  }
};

class OnePose : public ceres::CostFunction {
 public:
  OnePose(const Search& search, int pose) : search_(search), pose_(pose) {
    const auto first = search.problem.first_row().begin() + pose;
    set_num_residuals(first[1] - first[0]);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(search.free.size()));
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const bool slopes = jacobians != nullptr && jacobians[0] != nullptr;
    Eigen::VectorXd residual;
    RowMatrix jacobian;
    search_.problem.evaluate_pose(pose_, search_.params_at(x[0]), search_.free, &residual,
                                  slopes ? &jacobian : nullptr);
    Eigen::Map<Eigen::VectorXd>(residuals, residual.size()) = residual;
    if (slopes) {
      Eigen::Map<RowMatrix>(jacobians[0], jacobian.rows(), jacobian.cols()) = jacobian * search_.tolerance.asDiagonal();
    }
    return residual.allFinite();
  }

 private:
  const Search& search_;
  int pose_;
};

class Tolerances : public ceres::CostFunction {
 public:
  explicit Tolerances(int n) {
    set_num_residuals(n);
    mutable_parameter_block_sizes()->push_back(n);
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const int n = num_residuals();
    std::copy_n(x[0], n, residuals);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMatrix>(jacobians[0], n, n).setIdentity();
    }
    return true;
  }
};

}  // namespace

Calibration calibrate(const PoseProblem& problem, const LegParams<double>& start, const std::vector<int>& free,
                      const Eigen::VectorXd& tolerance, double huber, int max_iterations) {
  const int n = static_cast<int>(free.size());
  if (n < 1 || tolerance.size() != n || !(tolerance.minCoeff() > 0.0)) {
    throw std::invalid_argument("calibrate: every parameter needs a tolerance above zero");
  }
  const Search search{problem, start, free, tolerance};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n), left;
  RowMatrix slopes;
  problem.evaluate(start, free, &left, &slopes);
  if (!left.allFinite() || !slopes.allFinite()) {
    throw std::invalid_argument("calibrate: with the parameters as they are declared a pose is out of all range");
  }
  ceres::Problem least_squares;
  for (int pose = 0; pose < problem.poses(); ++pose) {
    least_squares.AddResidualBlock(new OnePose(search, pose), huber > 0.0 ? new ceres::HuberLoss(huber) : nullptr,
                                   x.data());
  }
  least_squares.AddResidualBlock(new Tolerances(n), nullptr, x.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &least_squares, &summary);
  if (summary.termination_type == ceres::FAILURE) {
    throw std::invalid_argument("calibrate: " + summary.message);
  }
  Calibration found;
  found.params = search.params_at(x.data());
  problem.evaluate(found.params, free, &found.residual, &found.jacobian);
  found.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  found.converged = summary.termination_type == ceres::CONVERGENCE;
  found.message = summary.message;
  return found;
}

}  // namespace estimation
}  // namespace sms
