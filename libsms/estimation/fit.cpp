#include "estimation/fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/SVD>
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

Params<double> with_values(Params<double> params, const std::vector<FreeParam>& free, const Eigen::VectorXd& value) {
  for (std::size_t k = 0; k < free.size(); ++k) {
    param(params, free[k].index) = value[static_cast<Eigen::Index>(k)];
  }
  return params;
}

Eigen::VectorXd values_of(Params<double> params, const std::vector<FreeParam>& free) {
  Eigen::VectorXd value(static_cast<Eigen::Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) {
    value[static_cast<Eigen::Index>(k)] = param(params, free[k].index);
  }
  return value;
}

// Huber's loss as a residual: its square is that of r up to `limit`, and grows with |r| from there on.
struct Softened {
  double value;
  double slope;  // against r
};

Softened soften(double r, double limit) {
  if (!(limit > 0.0) || std::abs(r) <= limit) {
    return {r, 1.0};
  }
  const double size = std::sqrt(limit * (2.0 * std::abs(r) - limit));
  return {std::copysign(size, r), limit / size};
}

// What is minimised, with what it is made of.
struct Aim {
  const Problem& problem;
  const Params<double>& start;
  const std::vector<FreeParam>& free;
  const Eigen::VectorXd& weight;
  double huber;
  Eigen::VectorXd scale;  // the solver's x_k is scale_k times the parameter
};

// The whole problem as one block of residuals, the pulls last.
class Residuals : public ceres::CostFunction {
 public:
  explicit Residuals(const Aim& aim) : aim_(aim), indices_(indices(aim.free)) {
    set_num_residuals(aim.problem.rows() + static_cast<int>(aim.free.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(aim.free.size()));
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const bool want = jacobians != nullptr && jacobians[0] != nullptr;
    const Eigen::Index rows = aim_.problem.rows(), columns = aim_.scale.size();
    const Eigen::VectorXd value = Eigen::Map<const Eigen::VectorXd>(x[0], columns).cwiseQuotient(aim_.scale);
    Eigen::VectorXd residual;
    RowMatrix jacobian;
    aim_.problem.evaluate(with_values(aim_.start, aim_.free, value), indices_, &residual, want ? &jacobian : nullptr);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Softened soft = soften(aim_.weight[i] * residual[i], aim_.huber);
      residuals[i] = soft.value;
      if (want) {
        jacobian.row(i) *= aim_.weight[i] * soft.slope;
      }
    }
    const Eigen::VectorXd from_start = value - values_of(aim_.start, aim_.free);
    for (std::size_t k = 0; k < aim_.free.size(); ++k) {
      residuals[rows + static_cast<Eigen::Index>(k)] = aim_.free[k].pull * from_start[static_cast<Eigen::Index>(k)];
    }
    if (want) {
      Eigen::Map<RowMatrix> all(jacobians[0], num_residuals(), columns);
      all.topRows(rows) = jacobian * aim_.scale.cwiseInverse().asDiagonal();
      all.bottomRows(columns).setZero();
      for (std::size_t k = 0; k < aim_.free.size(); ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        all(rows + i, i) = aim_.free[k].pull / aim_.scale[i];
      }
    }
    return residual.allFinite();
  }

 private:
  const Aim& aim_;
  std::vector<int> indices_;
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

// How far each parameter moves the weighted residual; one where only a pull holds it.
Eigen::VectorXd scales(const Aim& aim) {
  Eigen::VectorXd residual;
  RowMatrix jacobian;
  aim.problem.evaluate(aim.start, indices(aim.free), &residual, &jacobian);
  if (!residual.allFinite()) {
    throw std::invalid_argument("fit: the residual at the start is not finite");
  }
  Eigen::VectorXd scale = (aim.weight.asDiagonal() * jacobian).colwise().norm();
  for (std::size_t k = 0; k < aim.free.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (scale[i] > 0.0 && std::isfinite(scale[i])) {
      continue;
    }
    if (!(aim.free[k].pull > 0.0)) {
      throw std::invalid_argument(std::string("fit: these records do not feel ") +
                                  sms_param_describe(aim.free[k].index)->name + " at its start; leave it fixed");
    }
    scale[i] = aim.free[k].pull;
  }
  return scale;
}

double condition_number(const RowMatrix& jacobian, const Eigen::VectorXd& weight) {
  Eigen::MatrixXd columns = weight.asDiagonal() * jacobian;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    const double length = columns.col(k).norm();
    columns.col(k) /= length > 0.0 ? length : 1.0;
  }
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(columns.transpose() * columns).singularValues();
  return std::sqrt(singular[0] / singular[singular.size() - 1]);
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

// Bounds of the solver's x.
struct Box {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

Box box_of(const Aim& aim) {
  Box box = {aim.scale, aim.scale};
  for (std::size_t k = 0; k < aim.free.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    box.lower[i] *= aim.free[k].lower;
    box.upper[i] *= aim.free[k].upper;
  }
  return box;
}

// The parameters that stand at a bound with the minimum beyond it: the gradient points inwards.
std::vector<int> pressed(const Residuals& residuals, const Box& box, const Eigen::VectorXd& x) {
  const Eigen::ArrayXd margin = 1e-9 * (box.upper - box.lower).array();
  if ((x.array() > box.lower.array() + margin && x.array() < box.upper.array() - margin).all()) {
    return {};  // an evaluation with derivatives is what a fit costs
  }
  Eigen::VectorXd r(residuals.num_residuals());
  RowMatrix jacobian(residuals.num_residuals(), x.size());
  const double* at = x.data();
  double* to = jacobian.data();
  residuals.Evaluate(&at, r.data(), &to);
  const Eigen::VectorXd slope = jacobian.transpose() * r;
  std::vector<int> out;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if ((x[i] <= box.lower[i] + margin[i] && slope[i] > 0.0) || (x[i] >= box.upper[i] - margin[i] && slope[i] < 0.0)) {
      out.push_back(static_cast<int>(i));
    }
  }
  return out;
}

// One run of the solver with the parameters `held` as they are.
ceres::Solver::Summary solve(const Aim& aim, const Box& box, const FitOptions& options, const std::vector<int>& held,
                             Eigen::VectorXd* x) {
  const int n = static_cast<int>(x->size());
  ceres::Problem problem;
  problem.AddResidualBlock(new Residuals(aim), nullptr, x->data());
  if (static_cast<int>(held.size()) == n) {
    problem.SetParameterBlockConstant(x->data());
  } else if (!held.empty()) {
    problem.SetManifold(x->data(), new ceres::SubsetManifold(n, held));
  }
  for (int i = 0; i < n; ++i) {
    problem.SetParameterLowerBound(x->data(), i, box.lower[i]);
    problem.SetParameterUpperBound(x->data(), i, box.upper[i]);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options), &problem, &summary);
  if (summary.termination_type == ceres::FAILURE) {
    throw std::invalid_argument("fit: " + summary.message);
  }
  return summary;
}

// Moves fit.params from the start to the minimum. The solver cuts its steps at the bounds, and with a parameter at one it
// stops long before the others are where they belong; so it runs again with that parameter held, until the same ones
// press on their bounds before and after.
void minimise(const Aim& aim, const FitOptions& options, Fit* fit) {
  const Box box = box_of(aim);
  const Residuals residuals(aim);
  Eigen::VectorXd x = values_of(aim.start, aim.free).cwiseProduct(aim.scale).cwiseMax(box.lower).cwiseMin(box.upper);
  std::vector<int> held;
  for (int round = 0; round < 8; ++round) {
    const ceres::Solver::Summary summary = solve(aim, box, options, held, &x);
    fit->iterations += static_cast<int>(summary.iterations.size()) - 1;
    fit->converged = summary.termination_type == ceres::CONVERGENCE;
    fit->message = summary.message;
    const std::vector<int> now = pressed(residuals, box, x);
    if (now == held) {
      break;
    }
    held = now;
  }
  fit->params = with_values(aim.start, aim.free, x.cwiseQuotient(aim.scale));
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
  Aim aim = {problem, start, free, w, options.huber, {}};
  if (!free.empty()) {
    aim.scale = scales(aim);
    minimise(aim, options, &out);
  }
  problem.evaluate(out.params, indices(free), &out.residual, &out.jacobian);
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const double r = soften(w[i] * out.residual[i], options.huber).value;
    out.cost += r * r;
  }
  if (!free.empty()) {
    out.condition = condition_number(out.jacobian, w);
  }
  for (const FreeParam& f : free) {
    const double value = param(out.params, f.index);
    const double margin = 1e-9 * (f.upper - f.lower);
    out.at_bound.push_back(value <= f.lower + margin || value >= f.upper - margin);
  }
  return out;
}

}  // namespace estimation
}  // namespace sms
