#include "estimation/fit.hpp"

#include <ceres/ceres.h>

#include <cmath>
#include <stdexcept>

namespace sms {
namespace estimation {
namespace {

std::vector<int> indices(const std::vector<FreeParam>& free) {
  std::vector<int> out;
  for (const FreeParam& f : free) {
    out.push_back(f.index);
  }
  return out;
}

Params<double> with_values(Params<double> params, const std::vector<FreeParam>& free, const double* value) {
  for (std::size_t k = 0; k < free.size(); ++k) {
    param(params, free[k].index) = value[k];
  }
  return params;
}

// The whole problem as one block of residuals, the pulls last.
class Residuals : public ceres::CostFunction {
 public:
  Residuals(const Problem& problem, const Params<double>& start, const std::vector<FreeParam>& free,
            const Eigen::VectorXd& weight)
      : problem_(problem), start_(start), free_(free), indices_(indices(free)), weight_(weight) {
    set_num_residuals(problem.rows() + static_cast<int>(free.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(free.size()));
  }

  bool Evaluate(double const* const* values, double* residuals, double** jacobians) const override {
    const bool want = jacobians != nullptr && jacobians[0] != nullptr;
    Eigen::VectorXd residual;
    RowMatrix jacobian;
    problem_.evaluate(with_values(start_, free_, values[0]), indices_, &residual, want ? &jacobian : nullptr);
    Eigen::Map<Eigen::VectorXd>(residuals, residual.size()) = weight_.cwiseProduct(residual);
    for (std::size_t k = 0; k < free_.size(); ++k) {
      residuals[problem_.rows() + static_cast<int>(k)] = free_[k].pull * (values[0][k] - param(start_, free_[k].index));
    }
    if (want) {
      Eigen::Map<RowMatrix> all(jacobians[0], num_residuals(), jacobian.cols());
      all.topRows(jacobian.rows()) = weight_.asDiagonal() * jacobian;
      all.bottomRows(jacobian.cols()).setZero();
      for (std::size_t k = 0; k < free_.size(); ++k) {
        all(problem_.rows() + static_cast<int>(k), static_cast<int>(k)) = free_[k].pull;
      }
    }
    return residual.allFinite();
  }

 private:
  const Problem& problem_;
  const Params<double>& start_;
  const std::vector<FreeParam>& free_;
  std::vector<int> indices_;
  const Eigen::VectorXd& weight_;
};

void check_start(const Params<double>& start, const std::vector<FreeParam>& free) {
  for (const FreeParam& f : free) {
    const double value = param(start, f.index);
    if (!(value >= f.lower && value <= f.upper)) {
      throw std::invalid_argument(std::string("fit: ") + sms_param_describe(f.index)->name + " starts at " +
                                  std::to_string(value) + ", outside its bounds " + std::to_string(f.lower) + " to " +
                                  std::to_string(f.upper));
    }
  }
}

ceres::Solver::Options solver_options(const FitOptions& options) {
  ceres::Solver::Options out;
  out.linear_solver_type = ceres::DENSE_QR;
  out.max_num_iterations = options.max_iterations;
  out.function_tolerance = options.tolerance;
  out.parameter_tolerance = options.tolerance;
  out.gradient_tolerance = 1e-14;
  out.logging_type = ceres::SILENT;
  return out;
}

}  // namespace

Fit fit(const Problem& problem, const Params<double>& start, const std::vector<FreeParam>& free,
        const Eigen::VectorXd& weight, const FitOptions& options) {
  check_start(start, free);
  if (weight.size() != 0 && weight.size() != problem.rows()) {
    throw std::invalid_argument("fit: " + std::to_string(weight.size()) + " weights for " +
                                std::to_string(problem.rows()) + " residuals");
  }
  const Eigen::VectorXd w = weight.size() != 0 ? weight : Eigen::VectorXd(Eigen::VectorXd::Ones(problem.rows()));

  Fit out;
  out.params = start;
  out.converged = true;
  if (!free.empty()) {
    std::vector<double> value;
    ceres::Problem ceres_problem;
    for (const FreeParam& f : free) {
      value.push_back(param(start, f.index));
    }
    ceres_problem.AddResidualBlock(new Residuals(problem, start, free, w), nullptr, value.data());
    for (std::size_t k = 0; k < free.size(); ++k) {
      ceres_problem.SetParameterLowerBound(value.data(), static_cast<int>(k), free[k].lower);
      ceres_problem.SetParameterUpperBound(value.data(), static_cast<int>(k), free[k].upper);
    }
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(options), &ceres_problem, &summary);
    if (summary.termination_type == ceres::FAILURE) {
      throw std::invalid_argument("fit: " + summary.message);
    }
    out.params = with_values(start, free, value.data());
    out.iterations = static_cast<int>(summary.iterations.size()) - 1;
    out.converged = summary.termination_type == ceres::CONVERGENCE;
    out.message = summary.message;
  }
  problem.evaluate(out.params, indices(free), &out.residual, &out.jacobian);
  out.cost = w.cwiseProduct(out.residual).squaredNorm();
  for (const FreeParam& f : free) {
    const double value = param(out.params, f.index);
    const double margin = 1e-9 * (f.upper - f.lower);
    out.at_bound.push_back(value <= f.lower + margin || value >= f.upper - margin);
  }
  return out;
}

}  // namespace estimation
}  // namespace sms
