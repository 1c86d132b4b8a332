#include "estimation/start_projection.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "estimation/reflections.hpp"

namespace sms {
namespace estimation {
namespace {

// Size: how many numbers a state has, where they are so few that sums over them are written out.
template <int Size>
StartStep step_of(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& residual,
                  const Eigen::LDLT<Eigen::MatrixXd>& normal) {
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Size>> columns(slopes.data(), slopes.rows(),
                                                                              slopes.cols());
  const Eigen::Matrix<double, Size, 1> gradient = columns.transpose() * residual;
  const Eigen::Matrix<double, Size, 1> descent = normal.solve(gradient);
  return {-descent, gradient.dot(descent)};
}

}  // namespace

StartProjection::StartProjection(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& scale) : scale_(scale) {
  Eigen::MatrixXd columns = slopes;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    columns.col(k) *= scale[k];
  }
  scaled_.setThreshold(1e-9);
  scaled_.compute(columns);
  basis_.setIdentity(columns.rows(), scaled_.rank());
  detail::apply_q(scaled_, std::min(columns.rows(), columns.cols()), &basis_);
}

void StartProjection::off(const Eigen::MatrixXd& columns, Eigen::Index width, Eigen::Index row, Eigen::Index column,
                          RowMatrix* out) const {
  const Eigen::MatrixXd here = columns.leftCols(width);
  const Eigen::MatrixXd kept = here - basis_ * (basis_.transpose() * here);
  out->block(row, column, here.rows(), width) = kept;
}

void StartProjection::move(const Eigen::MatrixXd& columns, Eigen::Index width, Eigen::Index column,
                           Eigen::MatrixXd* out) const {
  const Eigen::MatrixXd here = columns.leftCols(width);
  const Eigen::Index rank = basis_.cols();
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(scale_.size(), width);
  z.topRows(rank) = -scaled_.matrixR()
                         .topLeftCorner(rank, rank)
                         .template triangularView<Eigen::Upper>()
                         .solve(basis_.transpose() * here);
  z = scaled_.colsPermutation() * z;
  for (Eigen::Index k = 0; k < z.rows(); ++k) {
    z.row(k) *= scale_[k];
  }
  out->middleCols(column, width) = z;
}

StartStep start_step(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& residual, const Eigen::VectorXd& scale,
                     double damping) {
  Eigen::MatrixXd normal = slopes.transpose() * slopes;
  for (Eigen::Index k = 0; k < normal.rows(); ++k) {
    normal(k, k) += damping * normal(k, k) + 1e-3 / (scale[k] * scale[k]);
  }
  const Eigen::LDLT<Eigen::MatrixXd> factors(normal);
  switch (slopes.cols()) {
    case 4:
      return step_of<4>(slopes, residual, factors);
    case 8:
      return step_of<8>(slopes, residual, factors);
    default:
      return step_of<Eigen::Dynamic>(slopes, residual, factors);
  }
}

}  // namespace estimation
}  // namespace sms
