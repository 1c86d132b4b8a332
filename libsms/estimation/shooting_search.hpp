// How a ShootingProblem finds the initial states of its windows, and its derivatives: included where a plant's problem is
// compiled, `template class ShootingProblem<ThatPlant>`, and nowhere else.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "estimation/command_jumps.hpp"
#include "estimation/shooting.hpp"
#include "estimation/start_projection.hpp"

namespace sms {
namespace estimation {

// Of the windows of a problem, by so many threads.
void in_parallel(int threads, std::size_t windows, const std::function<void(std::size_t)>& work);

// Of a window's chi-square per row: more is badly off.
constexpr double kBadlyOff = 4.0;

// From the shot's state and its residual along slopes of a place nearby, while they keep what they promise. Whether they
// led to the end: not where the window is badly off, because slopes that are turned by some percent then miss much.
bool follow(const WindowSimulation& window, const Eigen::MatrixXd& slopes, const Eigen::VectorXd& scale,
            const WindowOptions& options, Shot* shot);

// Levenberg-Marquardt over the initial state, until a step gains next to nothing (WindowOptions); or until not even the
// linearised problem promises to leave less than `to_beat` of chi-square.
Shot shoot(const WindowSimulation& window, const Eigen::VectorXd& from, const Eigen::VectorXd& scale,
           const WindowOptions& options, int most_steps = 12, double to_beat = std::numeric_limits<double>::infinity());

// Derivatives of the rows, a direction a column.
void columns_of(const std::vector<ParameterJet>& jets, Eigen::MatrixXd* columns);

// Whether the simulation came to the window's end.
bool is_finite(const Shot& shot);

// ---- all windows --------------------------------------------------------------------------------------------------

template <typename Plant>
ShootingProblem<Plant>::ShootingProblem(Plant plant, const WindowOptions& options)
    : plant_(std::move(plant)), options_(options) {
  for (int record = 0; record < plant_.records(); ++record) {
    if (!(kLeastOfWindow * plant_.step(record) <= options.length)) {
      throw std::invalid_argument("record " + std::to_string(record) + ": a step of " +
                                  std::to_string(plant_.step(record)) + " s leaves fewer than " +
                                  std::to_string(kLeastOfWindow) + " samples in a window of " +
                                  std::to_string(options.length) + " s");
    }
    const int skipped = std::min(plant_.samples(record) / 2, static_cast<int>(options.run_up / plant_.step(record)));
    const int samples = plant_.samples(record) - skipped;
    const int parts = std::max(1, static_cast<int>(std::lround(samples * plant_.step(record) / options.length)));
    for (int part = 0; part < parts; ++part) {
      const int first = skipped + static_cast<int>(static_cast<long>(samples) * part / parts);
      const int end = skipped + static_cast<int>(static_cast<long>(samples) * (part + 1) / parts);
      Window w{record, first, end - first, rows_, (end - first) * plant_.channels(record), plant_.guess(record, first)};
      rows_ += w.rows;
      windows_.push_back(w);
    }
  }
  follow_.resize(windows_.size());
  slopes_.resize(windows_.size());
  found_.resize(windows_.size());
  best_.resize(windows_.size());
  least_.resize(windows_.size(), std::numeric_limits<double>::infinity());
}

template <typename Plant>
void ShootingProblem<Plant>::evaluate(const Machine<double>& params, const std::vector<int>& free,
                                      Eigen::VectorXd* residual, RowMatrix* jacobian) const {
  residual->resize(rows_);
  std::vector<int> followed = followed_;
  std::vector<Eigen::Index> column;  // of each free parameter among those that are followed
  if (jacobian != nullptr) {
    jacobian->resize(rows_, static_cast<Eigen::Index>(free.size()));
    for (const int parameter : free) {
      const auto at = std::find(followed.begin(), followed.end(), parameter);
      column.push_back(at - followed.begin());
      if (at == followed.end()) {
        followed.push_back(parameter);
      }
    }
  }
  in_parallel(options_.threads, windows_.size(), [&](std::size_t k) {
    const Window w = begun(params, k);
    Shot shot = jacobian != nullptr ? search(params, w, k) : shoot(params, w, k);
    std::copy_n(shot.residual.data(), w.rows, residual->data() + w.row);
    note(shot, w, k);
    if (jacobian != nullptr) {
      Simulated(*this, params, w).find_slopes(&shot);
      Eigen::MatrixXd moves = differentiate(params, free, w, shot, jacobian);
      if (!moves.allFinite()) {
        moves.setZero();  // of a simulation that runs away: they would outlast it
      }
      follow_[k].conservativeResize(kStart, static_cast<Eigen::Index>(followed.size()));
      for (std::size_t i = 0; i < column.size(); ++i) {
        follow_[k].col(column[i]) = moves.col(static_cast<Eigen::Index>(i));
      }
      anchor(shot, k);
    }
  });
  last_ = params;
  if (jacobian != nullptr) {
    anchor_ = params;
    followed_ = std::move(followed);
  }
}

template <typename Plant>
Eigen::VectorXd ShootingProblem<Plant>::errors(const Machine<double>& params) const {
  Eigen::VectorXd out(rows_);
  in_parallel(options_.threads, windows_.size(), [&](std::size_t k) {
    const Shot shot = shoot(params, begun(params, k), k);
    std::copy_n(shot.residual.data(), windows_[k].rows, out.data() + windows_[k].row);
  });
  return out;
}

template <typename Plant>
void ShootingProblem<Plant>::settle(const Machine<double>& params) {
  followed_.clear();
  in_parallel(options_.threads, windows_.size(), [&](std::size_t k) {
    const Window& w = windows_[k];
    const Shot shot = search(params, w, k);
    note(shot, w, k);
    anchor(shot, k);
  });
  last_ = params;
}

template <typename Plant>
RowMatrix ShootingProblem<Plant>::hidden(const Machine<double>& params, int knots) const {
  return against_hidden(params, Plant::kHidden * knots, [&](const ParameterJet* values) {
    return Hidden<ParameterJet>{values, knots, nullptr};
  });
}

template <typename Plant>
RowMatrix ShootingProblem<Plant>::jumps(const Machine<double>& params) const {
  return against_hidden(params, Plant::kCommands * kJumps, [](const ParameterJet* values) {
    return Hidden<ParameterJet>{nullptr, 0, values};
  });
}

template <typename Plant>
Eigen::MatrixXi ShootingProblem<Plant>::jump_samples() const {
  Eigen::MatrixXi out(windows_.size(), Plant::kCommands * kJumps);
  out.setConstant(-1);
  for (std::size_t k = 0; k < windows_.size(); ++k) {
    const Window& w = windows_[k];
    for (int command = 0; command < Plant::kCommands; ++command) {
      int shown[kJumps];
      const int count = largest_jumps(plant_.command(w.record, command), w.first, w.samples, shown);
      for (int i = 0; i < count; ++i) {
        out(static_cast<Eigen::Index>(k), command * kJumps + i) = shown[i];
      }
    }
  }
  return out;
}

template <typename Plant>
void ShootingProblem<Plant>::set_ahead(int record, int command, const Eigen::VectorXd& ahead) {
  plant_.ahead(record, command) = ahead;
  std::fill(least_.begin(), least_.end(), std::numeric_limits<double>::infinity());  // of another residual
}

template <typename Plant>
RowMatrix ShootingProblem<Plant>::against_hidden(const Machine<double>& params, int count,
                                                 const HiddenOf& as_hidden) const {
  RowMatrix out(rows_, count);
  in_parallel(options_.threads, windows_.size(), [&](std::size_t k) {
    Shot shot = shoot(params, begun(params, k), k);
    Simulated(*this, params, windows_[k]).find_slopes(&shot);
    differentiate_hidden(params, count, as_hidden, windows_[k], shot, &out);
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
  return is_finite(shot) ? shot.start : plant_.guess(w.record, w.first);
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
class ShootingProblem<Plant>::Simulated : public WindowSimulation {
 public:
  Simulated(const ShootingProblem& problem, const Machine<double>& params, const Window& window)
      : plant_(problem.plant_), params_(params), window_(window) {}

  void find_residual(const Eigen::VectorXd& start, Eigen::VectorXd* residual) const override {
    plant_.simulate(params_, window_, start.data(), residual->data());
  }

  void find_slopes(Shot* shot) const override {
    if (shot->has_slopes) {
      return;
    }
    if (plant_.feels_all(params_, window_)) {  // NOLINT(bugprone-branch-clone): some plants have kFelt = kStart
      find_slopes_of<kStart>(shot);
    } else {
      find_slopes_of<Plant::kFelt>(shot);
    }
    shot->has_slopes = true;
  }

 private:
  // Simulates with derivatives against the first kFelt numbers of the initial state; the others leave no trace.
  template <int kFelt>
  void find_slopes_of(Shot* shot) const {
    using StartJet = Jet<(kFelt + 3) / 4 * 4>;  // whole AVX registers
    std::vector<StartJet> jets(static_cast<std::size_t>(window_.rows));
    StartJet z[kStart];
    for (int k = 0; k < kStart; ++k) {
      z[k] = k < kFelt ? StartJet(shot->start[k], k) : StartJet(shot->start[k]);
    }
    plant_.simulate(cast<StartJet>(params_), window_, z, jets.data());
    shot->residual.resize(window_.rows);
    shot->slopes.setZero(window_.rows, kStart);
    for (int row = 0; row < window_.rows; ++row) {
      const StartJet& jet = jets[static_cast<std::size_t>(row)];
      shot->residual[row] = jet.a;
      for (int k = 0; k < kFelt; ++k) {
        shot->slopes(row, k) = jet.v[k];
      }
    }
  }

  const Plant& plant_;
  const Machine<double>& params_;
  const Window& window_;
};

template <typename Plant>
void ShootingProblem<Plant>::note(const Shot& shot, const Window& w, std::size_t k) const {
  found_[k] = place_of(shot, w);
  const double left = shot.residual.squaredNorm();
  if (left < least_[k]) {
    least_[k] = left;
    best_[k] = found_[k];
  }
}

template <typename Plant>
void ShootingProblem<Plant>::anchor(const Shot& shot, std::size_t k) const {
  windows_[k].start = found_[k];
  if (shot.slopes.allFinite()) {
    slopes_[k] = shot.slopes;
  }
}

template <typename Plant>
Shot ShootingProblem<Plant>::shoot(const Machine<double>& params, const Window& w, std::size_t k, bool exact) const {
  const Simulated window(*this, params, w);
  Shot shot;
  shot.start = w.start;
  if (slopes_[k].size() > 0) {
    shot.residual.resize(w.rows);
    window.find_residual(shot.start, &shot.residual);
    if (follow(window, slopes_[k], start_scales(), options_, &shot) && !exact) {
      return shot;
    }
  }
  return estimation::shoot(window, shot.start, start_scales(), options_);
}

template <typename Plant>
Shot ShootingProblem<Plant>::search(const Machine<double>& params, const Window& w, std::size_t k) const {
  constexpr int kMostSteps = 4;  // enough to see whether it leads elsewhere; the next search goes on from there
  constexpr double kBetter = 0.5;
  Shot shot = shoot(params, w, k, true);
  const auto try_from = [&](const Eigen::VectorXd& from) {
    const double here = shot.residual.squaredNorm();
    Shot other = estimation::shoot(Simulated(*this, params, w), from, start_scales(), options_, kMostSteps, here);
    if (other.residual.squaredNorm() < here) {
      shot = std::move(other);
    }
  };
  if (shot.residual.squaredNorm() > kBadlyOff * w.rows) {
    try_from(plant_.guess(w.record, w.first));
  }
  if (shot.residual.squaredNorm() > std::max(kBadlyOff * w.rows, least_[k] / kBetter)) {
    try_from(best_[k]);
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
    const auto* of_these = free.data() + first;
    for (int k = 0; k < width; ++k) {
      param(seeded, of_these[k]).v[k] = 1.0;
    }
    plant_.simulate(seeded, w, start, jets.data());
    columns_of(jets, &columns);
    projection.off(columns, width, w.row, first, jacobian);
    projection.move(columns, width, first, &moves);
  }
  return moves;
}

template <typename Plant>
void ShootingProblem<Plant>::differentiate_hidden(const Machine<double>& params, int count, const HiddenOf& as_hidden,
                                                  const Window& w, const Shot& shot, RowMatrix* out) const {
  const StartProjection projection(shot.slopes, start_scales());
  std::vector<ParameterJet> jets(static_cast<std::size_t>(w.rows));
  Eigen::MatrixXd columns(w.rows, kWidth);
  const Machine<ParameterJet> plain = cast<ParameterJet>(params);
  ParameterJet start[kStart];
  for (int k = 0; k < kStart; ++k) {
    start[k] = ParameterJet(shot.start[k]);
  }
  std::vector<ParameterJet> values(static_cast<std::size_t>(count));
  for (int first = 0; first < count; first += kWidth) {
    const int width = std::min(kWidth, count - first);
    std::fill(values.begin(), values.end(), ParameterJet(0.0));
    ParameterJet* const of_these = values.data() + first;
    for (int k = 0; k < width; ++k) {
      of_these[k].v[k] = 1.0;
    }
    plant_.simulate(plain, w, start, jets.data(), as_hidden(values.data()));
    columns_of(jets, &columns);
    projection.off(columns, width, w.row, first, out);
  }
}

}  // namespace estimation
}  // namespace sms
