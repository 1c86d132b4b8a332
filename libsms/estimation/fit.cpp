#include "estimation/fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sms {
namespace estimation {
namespace {

using SquareSvd = Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner>;

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

  Eigen::VectorXd value_at(const Eigen::VectorXd& x) const { return x.cwiseQuotient(scale); }
};

// The problem's answer, not weighted, at the solver's x.
struct Answer {
  Eigen::VectorXd x;
  Eigen::VectorXd residual;
  RowMatrix jacobian;
};

// The whole problem as one block of residuals, the pulls last. The last answer with derivatives is kept: the solver asks
// for that of the start, which its scaling needed before it, and the fit for that of the end.
class Residuals : public ceres::CostFunction {
 public:
  Residuals(const Aim& aim, Answer start) : aim_(aim), indices_(indices(aim.free)), last_(std::move(start)) {
    set_num_residuals(aim.problem.rows() + static_cast<int>(aim.free.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(aim.free.size()));
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> at(x[0], aim_.scale.size());
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      Eigen::VectorXd residual;
      aim_.problem.evaluate(params_at(at), indices_, &residual, nullptr);
      return weighted(at, residual, nullptr, residuals, nullptr);
    }
    const Answer& answer = answer_at(at);
    return weighted(at, answer.residual, &answer.jacobian, residuals, jacobians[0]);
  }

  const Answer& answer_at(const Eigen::VectorXd& x) const {
    if (!aim_.problem.repeats() || x != last_.x) {
      last_.x = x;
      aim_.problem.evaluate(params_at(x), indices_, &last_.residual, &last_.jacobian);
    }
    return last_;
  }

 private:
  Params<double> params_at(const Eigen::VectorXd& x) const {
    return with_values(aim_.start, aim_.free, aim_.value_at(x));
  }

  // Writes what the solver squares, and the derivatives if `jacobian` is there; whether all of it is finite.
  bool weighted(const Eigen::VectorXd& x, const Eigen::VectorXd& residual, const RowMatrix* jacobian, double* residuals,
                double* jacobians) const {
    const Eigen::Index rows = residual.size(), columns = x.size();
    const Eigen::RowVectorXd per_x = aim_.scale.cwiseInverse().transpose();
    Eigen::Map<RowMatrix> all(jacobians, jacobian != nullptr ? num_residuals() : 0, columns);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Softened soft = soften(aim_.weight[i] * residual[i], aim_.huber);
      residuals[i] = soft.value;
      if (jacobian != nullptr) {
        all.row(i) = (aim_.weight[i] * soft.slope * jacobian->row(i)).cwiseProduct(per_x);
      }
    }
    const Eigen::VectorXd from_start = aim_.value_at(x) - values_of(aim_.start, aim_.free);
    for (Eigen::Index k = 0; k < columns; ++k) {
      const double pull = aim_.free[static_cast<std::size_t>(k)].pull;
      residuals[rows + k] = pull * from_start[k];
      if (jacobian != nullptr) {
        all.row(rows + k).setZero();
        all(rows + k, k) = pull / aim_.scale[k];
      }
    }
    return residual.allFinite();
  }

  const Aim& aim_;
  std::vector<int> indices_;
  mutable Answer last_;
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
Eigen::VectorXd scales(const Aim& aim, const Answer& at_start) {
  if (!at_start.residual.allFinite()) {
    throw std::invalid_argument("fit: the residual at the start is not finite");
  }
  Eigen::VectorXd scale = (aim.weight.asDiagonal() * at_start.jacobian).colwise().norm();
  for (std::size_t k = 0; k < aim.free.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (scale[i] > 0.0 && std::isfinite(scale[i])) {
      continue;
    }
    if (!(aim.free[k].pull > 0.0)) {
      throw std::invalid_argument(std::string("fit: these records are insensitive to ") +
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
  const Eigen::VectorXd singular = SquareSvd(columns.transpose() * columns).singularValues();
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
ceres::Solver::Summary solve(Residuals* residuals, const Box& box, const FitOptions& options,
                             const std::vector<int>& held, Eigen::VectorXd* x) {
  const int n = static_cast<int>(x->size());
  ceres::Problem::Options ours;
  ours.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ours);
  problem.AddResidualBlock(residuals, nullptr, x->data());
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
// press on their bounds before and after. Returns the answer there.
Answer minimise(const Aim& aim, Answer at_start, const FitOptions& options, Fit* fit) {
  const Box box = box_of(aim);
  Eigen::VectorXd x = values_of(aim.start, aim.free).cwiseProduct(aim.scale).cwiseMax(box.lower).cwiseMin(box.upper);
  at_start.x = x;
  Residuals residuals(aim, std::move(at_start));
  std::vector<int> held;
  for (int round = 0; round < 8; ++round) {
    const ceres::Solver::Summary summary = solve(&residuals, box, options, held, &x);
    fit->iterations += static_cast<int>(summary.iterations.size()) - 1;
    fit->converged = summary.termination_type == ceres::CONVERGENCE;
    fit->message = summary.message;
    const std::vector<int> now = pressed(residuals, box, x);
    if (now == held) {
      break;
    }
    held = now;
  }
  fit->params = with_values(aim.start, aim.free, aim.value_at(x));
  return residuals.answer_at(x);
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
  Answer answer;
  problem.evaluate(start, indices(free), &answer.residual, &answer.jacobian);
  if (!free.empty()) {
    aim.scale = scales(aim, answer);
    answer = minimise(aim, std::move(answer), options, &out);
  }
  out.residual = std::move(answer.residual);
  out.jacobian = std::move(answer.jacobian);
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
