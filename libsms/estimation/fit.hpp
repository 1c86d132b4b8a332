// Least squares: the parameters with which a model comes closest to its records.
//
//   minimise  sum_i (w_i r_i(theta))^2 + sum_k (pull_k (theta_k - start_k))^2   subject to  lower <= theta <= upper
//
// solved by Ceres (Levenberg-Marquardt, projected on the bounds) with the problem's exact derivatives. A parameter that
// is known within a declared uncertainty is given that box, and a pull as weak as one sample: where the data has
// nothing to say between two parameters, the one that is known stays where it is. One that is unknown gets the bounds
// of params.def and no pull; if the residual is insensitive to it, the fit is refused.
//
// Inside, each parameter is measured by how far it moves the residual (the norm of its column at the start), so that a
// conductance of 1e-8 and a pressure of 5e5 converge alike.
#pragma once

#include <string>

#include "estimation/problem.hpp"

namespace sms {
namespace estimation {

struct FreeParam {
  int index;  // ParamIndex
  double lower;
  double upper;
  double pull = 0.0;  // towards the start, per unit of the parameter, in the unit of the weighted residual
};

struct FitOptions {
  int max_iterations = 100;
  double tolerance = 1e-12;  // relative, on cost and on parameters
  double huber = 0.0;        // weighted residuals beyond this count with their size, not its square; 0: all squared
};

struct Fit {
  Params<double> params;
  Eigen::VectorXd residual;  // at params, not weighted
  RowMatrix jacobian;        // at params, rows x free, not weighted
  std::vector<bool> at_bound;
  double cost = 0.0;       // sum of (w r)^2, without the pull; beyond huber of huber (2 |w r| - huber)
  double condition = 1.0;  // of the weighted jacobian with columns of length one; large: some parameters are one
  int iterations = 0;
  bool converged = false;
  std::string message;
};

// weight (rows), or empty: all one. std::invalid_argument for a start outside the bounds, a wrong length of weight, a
// residual that is not finite at the start, or a parameter without pull to which the residual is insensitive there.
Fit fit(const Problem& problem, const Params<double>& start, const std::vector<FreeParam>& free,
        const Eigen::VectorXd& weight, const FitOptions& options = FitOptions());

}  // namespace estimation
}  // namespace sms
