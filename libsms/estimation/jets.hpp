// Exact derivatives of a model that is written over the scalar: it runs in Jet (jet.hpp), a few parameters at a time.
#pragma once

#include <algorithm>

#include "estimation/jet.hpp"
#include "estimation/problem.hpp"

namespace sms {
namespace estimation {

// model(params, residual) writes `rows` residuals for Params<double>, and for Params<Jet> alike, or for LegParams of
// either. kWidth parameters share one run of the model: 4, one AVX register of derivatives, where it costs little; more
// where it solves an equation.
template <int kWidth = 4, typename Model, template <typename> class Machine>
void evaluate_with_jets(const Model& model, int rows, const Machine<double>& params, const std::vector<int>& free,
                        Eigen::VectorXd* residual, RowMatrix* jacobian) {
  residual->resize(rows);
  if (jacobian == nullptr) {
    model(params, residual->data());
    return;
  }
  const int columns = static_cast<int>(free.size());
  jacobian->resize(rows, columns);
  std::vector<Jet<kWidth>> jets(static_cast<std::size_t>(rows));
  for (int first = 0; first < std::max(columns, 1); first += kWidth) {
    const int width = std::min(kWidth, columns - first);
    Machine<Jet<kWidth>> seeded = cast<Jet<kWidth>>(params);
    for (int k = 0; k < width; ++k) {
      const int column = first + k;
      param(seeded, free[static_cast<std::size_t>(column)]).v[k] = 1.0;
    }
    model(seeded, jets.data());
    for (int row = 0; row < rows; ++row) {
      const Jet<kWidth>& jet = jets[static_cast<std::size_t>(row)];
      (*residual)(row) = jet.a;
      for (int k = 0; k < width; ++k) {
        (*jacobian)(row, first + k) = jet.v[k];
      }
    }
  }
}

}  // namespace estimation
}  // namespace sms
