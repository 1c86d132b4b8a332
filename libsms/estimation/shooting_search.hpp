// How a ShootingProblem finds the initial states of its windows, and its derivatives: included where a plant's problem is
// compiled, `template class ShootingProblem<ThatPlant>`, and nowhere else.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstring>
#include <thread>
#include <utility>

#include "estimation/shooting.hpp"
#include "estimation/start_projection.hpp"

namespace sms {
namespace estimation {

template <typename Plant>
struct ShootingProblem<Plant>::Shot {
  Eigen::VectorXd start;
  Eigen::VectorXd residual;
  Eigen::MatrixXd slopes;   // de/dz
  bool has_slopes = false;  // of this state, and not of one the search has left
};

// ---- all windows --------------------------------------------------------------------------------------------------

template <typename Plant>
ShootingProblem<Plant>::ShootingProblem(Plant plant, const WindowOptions& options)
    : plant_(std::move(plant)), options_(options) {
  for (int record = 0; record < plant_.records(); ++record) {
    const int skipped = std::min(plant_.samples(record) / 2, static_cast<int>(options.run_up / plant_.step(record)));
    const int samples = plant_.samples(record) - skipped;
    const int parts = std::max(1, static_cast<int>(samples * plant_.step(record) / options.length + 0.5));
    for (int part = 0; part < parts; ++part) {
      const int first = skipped + static_cast<int>(static_cast<long>(samples) * part / parts);
      const int end = skipped + static_cast<int>(static_cast<long>(samples) * (part + 1) / parts);
      Window w{record, first, end - first, rows_, (end - first) * plant_.channels(record), plant_.guess(record, first)};
      rows_ += w.rows;
      windows_.push_back(w);
    }
  }
  follow_.resize(windows_.size());
  found_.resize(windows_.size());
}

template <typename Plant>
template <typename Work>
void ShootingProblem<Plant>::in_parallel(const Work& work) const {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t k = next++; k < windows_.size(); k = next++) {
      work(k);
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < options_.threads; ++i) {
    others.emplace_back(run);
  }
  run();
  for (std::thread& thread : others) {
    thread.join();
  }
}

template <typename Plant>
void ShootingProblem<Plant>::evaluate(const Machine<double>& params, const std::vector<int>& free,
                                      Eigen::VectorXd* residual, RowMatrix* jacobian) const {
  residual->resize(rows_);
  if (jacobian != nullptr) {
    jacobian->resize(rows_, static_cast<Eigen::Index>(free.size()));
  }
  in_parallel([&](std::size_t k) {
    const Window w = begun(params, k);
    Shot shot = jacobian != nullptr ? search(params, w) : shoot(params, w);
    residual->segment(w.row, w.rows) = shot.residual;
    found_[k] = place_of(shot, w);
    if (jacobian != nullptr) {
      find_slopes(params, w, &shot);
      follow_[k] = differentiate(params, free, w, shot, jacobian);
      windows_[k].start = found_[k];
    }
  });
  last_ = params;
  if (jacobian != nullptr) {
    anchor_ = params;
    followed_ = free;
  }
}

template <typename Plant>
Eigen::VectorXd ShootingProblem<Plant>::errors(const Machine<double>& params) const {
  Eigen::VectorXd out(rows_);
  in_parallel([&](std::size_t k) {
    out.segment(windows_[k].row, windows_[k].rows) = shoot(params, begun(params, k)).residual;
  });
  return out;
}

template <typename Plant>
void ShootingProblem<Plant>::settle(const Machine<double>& params) {
  followed_.clear();
  in_parallel([&](std::size_t k) {
    const Window& w = windows_[k];
    windows_[k].start = found_[k] = place_of(search(params, w), w);
  });
  last_ = params;
}

template <typename Plant>
RowMatrix ShootingProblem<Plant>::hidden(const Machine<double>& params, int knots) const {
  RowMatrix out(rows_, Plant::kHidden * knots);
  in_parallel([&](std::size_t k) {
    Shot shot = shoot(params, begun(params, k));
    find_slopes(params, windows_[k], &shot);
    differentiate_hidden(params, knots, windows_[k], shot, &out);
  });
  return out;
}

// ---- one window ---------------------------------------------------------------------------------------------------

template <typename Plant>
Eigen::VectorXd ShootingProblem<Plant>::start_scales() {
  Eigen::VectorXd scale(kStart);
  for (int k = 0; k < kStart; ++k) {
    scale[k] = Plant::start_scale(k);
  }
  return scale;
}

template <typename Plant>
Eigen::VectorXd ShootingProblem<Plant>::place_of(const Shot& shot, const Window& w) const {
  return shot.start.allFinite() && shot.residual.allFinite() ? shot.start : plant_.guess(w.record, w.first);
}

template <typename Plant>
Window ShootingProblem<Plant>::begun(const Machine<double>& params, std::size_t k) const {
  Window w = windows_[k];
  if (found_[k].size() > 0 && std::memcmp(&params, &last_, sizeof(params)) == 0) {
    w.start = found_[k];
    return w;
  }
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    const double change = param(params, followed_[i]) - param(anchor_, followed_[i]);
    w.start += change * follow_[k].col(static_cast<Eigen::Index>(i));
  }
  // Far away the straight line says nothing.
  for (int i = 0; i < kStart; ++i) {
    const double most = Plant::start_scale(i), here = windows_[k].start[i];
    w.start[i] = std::min(std::max(w.start[i], here - most), here + most);
  }
  if (!w.start.allFinite()) {
    w.start = plant_.guess(w.record, w.first);
  }
  return w;
}

template <typename Plant>
template <int kFelt>
void ShootingProblem<Plant>::find_slopes_of(const Machine<double>& params, const Window& w, Shot* shot) const {
  using StartJet = Jet<(kFelt + 3) / 4 * 4>;  // whole AVX registers
  std::vector<StartJet> jets(static_cast<std::size_t>(w.rows));
  StartJet z[kStart];
  for (int k = 0; k < kStart; ++k) {
    z[k] = k < kFelt ? StartJet(shot->start[k], k) : StartJet(shot->start[k]);
  }
  plant_.simulate(cast<StartJet>(params), w, z, jets.data());
  shot->residual.resize(w.rows);
  shot->slopes.setZero(w.rows, kStart);
  for (int row = 0; row < w.rows; ++row) {
    const StartJet& jet = jets[static_cast<std::size_t>(row)];
    shot->residual[row] = jet.a;
    shot->slopes.row(row).template head<kFelt>() = Eigen::Map<const Eigen::Matrix<double, 1, kFelt>>(jet.v);
  }
}

template <typename Plant>
void ShootingProblem<Plant>::find_slopes(const Machine<double>& params, const Window& w, Shot* shot) const {
  if (shot->has_slopes) {
    return;
  }
  if (plant_.feels_all(params, w)) {
    this->template find_slopes_of<kStart>(params, w, shot);
  } else {
    this->template find_slopes_of<Plant::kFelt>(params, w, shot);
  }
  shot->has_slopes = true;
}

// A state is tried in plain numbers, which are ten times cheaper; slopes are worked out where the search goes on from.
template <typename Plant>
typename ShootingProblem<Plant>::Shot ShootingProblem<Plant>::shoot(const Machine<double>& params, const Window& w,
                                                                    int most_steps) const {
  Shot shot;
  shot.start = w.start;
  Eigen::VectorXd tried_residual(w.rows);
  const Eigen::VectorXd scale = start_scales();
  double damping = 1e-6;
  for (int k = 0; k < most_steps; ++k) {
    find_slopes(params, w, &shot);
    const StartStep step = start_step(shot.slopes, shot.residual, scale, damping);
    const double cost = shot.residual.squaredNorm();
    if (!(step.promised > enough(cost))) {
      break;
    }
    const Eigen::VectorXd tried = shot.start + step.move;
    plant_.simulate(params, w, tried.data(), tried_residual.data());
    const double gain = cost - tried_residual.squaredNorm();
    if (gain > 0.0) {
      shot.start = tried;
      shot.residual.swap(tried_residual);
      shot.has_slopes = false;
      damping = std::max(0.1 * damping, 1e-9);
      if (gain < enough(cost)) {
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

template <typename Plant>
typename ShootingProblem<Plant>::Shot ShootingProblem<Plant>::search(const Machine<double>& params,
                                                                     const Window& w) const {
  Shot shot = shoot(params, w);
  if (shot.residual.squaredNorm() > 4.0 * w.rows) {
    Window anew = w;
    anew.start = plant_.guess(w.record, w.first);
    constexpr int kMostSteps = 4;  // enough to see whether it leads elsewhere; the next search goes on from there
    Shot other = shoot(params, anew, kMostSteps);
    return other.residual.squaredNorm() < shot.residual.squaredNorm() ? other : shot;
  }
  return shot;
}

template <typename Plant>
Eigen::MatrixXd ShootingProblem<Plant>::differentiate(const Machine<double>& params, const std::vector<int>& free,
                                                      const Window& w, const Shot& shot, RowMatrix* jacobian) const {
  const StartProjection projection(shot.slopes, start_scales());
  std::vector<ParameterJet> jets(static_cast<std::size_t>(w.rows));
  Eigen::MatrixXd columns(w.rows, kWidth);
  ParameterJet start[kStart];
  for (int k = 0; k < kStart; ++k) {
    start[k] = ParameterJet(shot.start[k]);
  }
  const int all = static_cast<int>(free.size());
  Eigen::MatrixXd moves(kStart, all);
  for (int first = 0; first < all; first += kWidth) {
    const int width = std::min(kWidth, all - first);
    Machine<ParameterJet> seeded = cast<ParameterJet>(params);
    for (int k = 0; k < width; ++k) {
      param(seeded, free[static_cast<std::size_t>(first + k)]).v[k] = 1.0;
    }
    plant_.simulate(seeded, w, start, jets.data());
    for (int row = 0; row < w.rows; ++row) {
      columns.row(row) = Eigen::Map<const Eigen::Matrix<double, 1, kWidth>>(jets[static_cast<std::size_t>(row)].v);
    }
    const Eigen::MatrixXd here = columns.leftCols(width);
    jacobian->block(w.row, first, w.rows, width) = projection.off(here);
    moves.middleCols(first, width) = projection.move(here);
  }
  return moves;
}

template <typename Plant>
void ShootingProblem<Plant>::differentiate_hidden(const Machine<double>& params, int knots, const Window& w,
                                                  const Shot& shot, RowMatrix* out) const {
  const StartProjection projection(shot.slopes, start_scales());
  std::vector<ParameterJet> jets(static_cast<std::size_t>(w.rows));
  Eigen::MatrixXd columns(w.rows, kWidth);
  const Machine<ParameterJet> plain = cast<ParameterJet>(params);
  ParameterJet start[kStart];
  for (int k = 0; k < kStart; ++k) {
    start[k] = ParameterJet(shot.start[k]);
  }
  const int all = Plant::kHidden * knots;
  std::vector<ParameterJet> push(static_cast<std::size_t>(all));
  for (int first = 0; first < all; first += kWidth) {
    const int width = std::min(kWidth, all - first);
    std::fill(push.begin(), push.end(), ParameterJet(0.0));
    for (int k = 0; k < width; ++k) {
      push[static_cast<std::size_t>(first + k)].v[k] = 1.0;
    }
    plant_.simulate(plain, w, start, jets.data(), push.data(), knots);
    for (int row = 0; row < w.rows; ++row) {
      columns.row(row) = Eigen::Map<const Eigen::Matrix<double, 1, kWidth>>(jets[static_cast<std::size_t>(row)].v);
    }
    out->block(w.row, first, w.rows, width) = projection.off(columns.leftCols(width));
  }
}

}  // namespace estimation
}  // namespace sms
