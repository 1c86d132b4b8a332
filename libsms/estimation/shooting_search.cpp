#include "estimation/shooting_search.hpp"

#include <algorithm>
#include <atomic>
#include <future>

namespace sms {
namespace estimation {

void in_parallel(int threads, std::size_t windows, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t k = next++; k < windows; k = next++) {
      work(k);
    }
  };
  std::vector<std::future<void>> others;  // each hands on what its windows threw, and is waited for in any case
  for (std::size_t i = 1; i < std::min(static_cast<std::size_t>(threads), windows); ++i) {
    others.push_back(std::async(std::launch::async, run));
  }
  run();
  for (std::future<void>& other : others) {
    other.get();
  }
}

void columns_of(const std::vector<ParameterJet>& jets, Eigen::MatrixXd* columns) {
  for (std::size_t row = 0; row < jets.size(); ++row) {
    for (int k = 0; k < ParameterJet::DIMENSION; ++k) {
      (*columns)(static_cast<Eigen::Index>(row), k) = jets[row].v[k];
    }
  }
}

bool is_finite(const Shot& shot) { return shot.start.allFinite() && shot.residual.allFinite(); }

bool follow(const WindowSimulation& window, const Eigen::MatrixXd& slopes, const Eigen::VectorXd& scale,
            const WindowOptions& options, Shot* shot) {
  constexpr int kMostSteps = 4;
  constexpr double kDamping = 1e-6, kAsPromised = 0.5;
  Eigen::VectorXd tried_residual(slopes.rows());
  for (int k = 0; k < kMostSteps && shot->residual.allFinite(); ++k) {
    const StartStep step = start_step(slopes, shot->residual, scale, kDamping);
    const double cost = shot->residual.squaredNorm();
    if (!(step.promised > options.enough(cost))) {
      return cost < kBadlyOff * static_cast<double>(slopes.rows());
    }
    const Eigen::VectorXd tried = shot->start + step.move;
    window.find_residual(tried, &tried_residual);
    const double gain = cost - tried_residual.squaredNorm();
    if (gain > 0.0) {
      shot->start = tried;
      shot->residual.swap(tried_residual);
      shot->has_slopes = false;
    }
    if (!(gain > kAsPromised * step.promised)) {
      return false;
    }
  }
  return false;
}

// A state is tried in plain numbers, which are ten times cheaper; slopes are worked out where the search goes on from.
Shot shoot(const WindowSimulation& window, const Eigen::VectorXd& from, const Eigen::VectorXd& scale,
           const WindowOptions& options, int most_steps, double to_beat) {
  Shot shot;
  shot.start = from;
  Eigen::VectorXd tried_residual;
  constexpr double kUndamped = 1e-6, kHeldBack = 1.01;  // even then a step is held near where it begins (start_step)
  double damping = kUndamped;
  for (int k = 0; k < most_steps; ++k) {
    window.find_slopes(&shot);
    const StartStep step = start_step(shot.slopes, shot.residual, scale, damping);
    const double cost = shot.residual.squaredNorm();
    const double enough = options.enough(cost);
    const bool in_vain = damping <= kUndamped && !(cost - kHeldBack * step.promised < to_beat);
    if (!(step.promised > enough) || in_vain) {
      break;
    }
    const Eigen::VectorXd tried = shot.start + step.move;
    tried_residual.resize(shot.residual.size());
    window.find_residual(tried, &tried_residual);
    const double gain = cost - tried_residual.squaredNorm();
    if (gain > 0.0) {
      shot.start = tried;
      shot.residual.swap(tried_residual);
      shot.has_slopes = false;
      damping = std::max(0.1 * damping, 1e-9);
      if (gain < enough) {
        break;
      }
    } else if (damping > 1e3) {
      break;
    } else {
      damping = std::max(100.0 * damping, 1e-2);
    }
  }
  return shot;
}

}  // namespace estimation
}  // namespace sms
