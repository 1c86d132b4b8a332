// A model held against measured records.
//
// A fit and a diagnosis ask the same two questions of any model: how far is it off, sample by sample, and how does that
// change with each parameter? A Problem answers both; everything else (Ceres, covariances, screening) is written once
// on top of it. A rig is one class derived from it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sms/params.hpp"

namespace sms {
namespace estimation {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Machine: the parameters of what is simulated, Params<double> or more than that (leg_params.hpp).
template <typename Machine>
class ProblemOf {
 public:
  virtual ~ProblemOf() = default;

  // Number of residuals, over all records.
  virtual int rows() const = 0;

  // residual (rows): predicted reading minus measured reading, in the unit of the measured signal.
  // jacobian (rows x free.size()), or nullptr: its exact derivatives against the parameters free[k] (ParamIndex).
  virtual void evaluate(const Machine& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                        RowMatrix* jacobian) const = 0;

  // Whether the same parameters give the same answer again, bit for bit; not where a search goes on from the last one.
  virtual bool repeats() const { return true; }
};

using Problem = ProblemOf<Params<double>>;

}  // namespace estimation
}  // namespace sms
