// A plant held against records by multiple shooting: the record is cut into windows, each simulated from a state of its
// own.
//
// A free simulation of an actuator drifts away from the record, because position is the integral of everything that is
// slightly wrong; and its initial state is not known. Over a window of a second neither matters: the state z at its
// beginning is whatever fits the window best. With the readings predicted by the simulation, whitened by the declared
// noise, a window leaves
//
//   r(theta) = min over z of  | e(theta, z) |,        e = (predicted - measured) / noise
//
// The minimum is found by Levenberg-Marquardt from a guess, and the derivatives are projected off the directions
// de/dz = Q R (variable projection; Golub and Pereyra 1973, in the simplification of Kaufman 1975):
//
//   dr/dtheta = (I - Q Q') de/dtheta
//
// r itself is e at the best z found, not its projection: where friction has a kink the search may end at a point from
// which the linearised model promises more than there is.
//
// A search begins where the best state of the last Jacobian has moved to with the parameters since, to first order:
//
//   z = z* - R^-1 Q' (de/dtheta) (theta - theta*)
//
// With a Jacobian, a window that is left badly off is searched from its guess as well.
//
// So a residual and its Jacobian are those of the parameters alone, windows are independent of each other, and a window
// is the natural block of whatever is resampled.
//
// A plant is a class with
//   template <S> using Machine                          its parameters: Params<S>, or more than that (leg_params.hpp)
//   template <S> void simulate(const Machine<S>&, const Window&, const S* start, S* residual) const
//   int channels(record), start_scale(k)
//   int kStart, kFelt; bool feels_all(params, Window)   of the kStart numbers of the initial state the first kFelt leave a
//                                                       trace in any machine, the others only in one that feels all
#pragma once

#include <ceres/jet.h>

#include <Eigen/QR>
#include <algorithm>
#include <atomic>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "estimation/problem.hpp"

namespace sms {
namespace estimation {

struct Window {
  int record;
  int first;              // sample of the record
  int samples;            // including the first
  int row;                // where its residuals begin
  int rows;               // samples times channels
  Eigen::VectorXd start;  // the best initial state of the last Jacobian; at first a guess
};

struct WindowOptions {
  double length = 1.0;  // s, about: a record is cut evenly
  double run_up = 0.1;  // s at the beginning of a record, only to run up what follows the command
  int threads = 1;
  // The search for an initial state ends when a step would gain less than this of chi-square, which is one per row, or
  // this share of it.
  double least_gain = 0.1;
  double least_share = 1e-3;
};

template <typename Plant>
class ShootingProblem : public ProblemOf<typename Plant::template Machine<double>> {
 public:
  template <typename S>
  using Machine = typename Plant::template Machine<S>;

  ShootingProblem(Plant plant, const WindowOptions& options) : plant_(std::move(plant)), options_(options) {
    for (int record = 0; record < plant_.records(); ++record) {
      const int skipped = std::min(plant_.samples(record) / 2, static_cast<int>(options.run_up / plant_.step(record)));
      const int samples = plant_.samples(record) - skipped;
      const int parts = std::max(1, static_cast<int>(samples * plant_.step(record) / options.length + 0.5));
      for (int part = 0; part < parts; ++part) {
        const int first = skipped + static_cast<int>(static_cast<long>(samples) * part / parts);
        const int end = skipped + static_cast<int>(static_cast<long>(samples) * (part + 1) / parts);
        Window w{
            record, first, end - first, rows_, (end - first) * plant_.channels(record), plant_.guess(record, first)};
        rows_ += w.rows;
        windows_.push_back(w);
      }
    }
    follow_.resize(windows_.size());
    found_.resize(windows_.size());
  }

  int rows() const override { return rows_; }
  bool repeats() const override { return false; }
  const std::vector<Window>& windows() const { return windows_; }
  const Plant& plant() const { return plant_; }
  // The initial state of a window that was found last.
  const Eigen::VectorXd& found(std::size_t window) const {
    return found_[window].size() > 0 ? found_[window] : windows_[window].start;
  }

  void evaluate(const Machine<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override {
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
        shot.factor();
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

  // Residuals before the projection, at the best initial states: predicted less measured, over the noise.
  Eigen::VectorXd errors(const Machine<double>& params) const {
    Eigen::VectorXd out(rows_);
    in_parallel([&](std::size_t k) {
      out.segment(windows_[k].row, windows_[k].rows) = shoot(params, begun(params, k)).residual;
    });
    return out;
  }

  // The best initial states at `params` become where later searches begin.
  void settle(const Machine<double>& params) {
    followed_.clear();
    in_parallel([&](std::size_t k) {
      const Window& w = windows_[k];
      windows_[k].start = found_[k] = place_of(search(params, w), w);
    });
    last_ = params;
  }

  // Derivatives of the projected residuals against inputs that are hidden in the plant's equations: each of
  // Plant::kHidden inputs has `knots` values per window, linear in between. Row block by row block:
  // (rows x kHidden * knots), a window's rows belonging to its own knots.
  RowMatrix hidden(const Machine<double>& params, int knots) const {
    RowMatrix out(rows_, Plant::kHidden * knots);
    in_parallel([&](std::size_t k) {
      Shot shot = shoot(params, begun(params, k));
      find_slopes(params, windows_[k], &shot);
      shot.factor();
      differentiate_hidden(params, knots, windows_[k], shot, &out);
    });
    return out;
  }

 private:
  static constexpr int kStart = Plant::kStart;
  static constexpr int kWidth = 4;
  using Jet = ceres::Jet<double, kWidth>;
  using StartMatrix = Eigen::Matrix<double, Eigen::Dynamic, kStart>;

  // A window at its best initial state.
  struct Shot {
    Eigen::VectorXd start;
    Eigen::VectorXd residual;
    StartMatrix slopes;                                  // de/dz
    bool has_slopes = false;                             // of this state, and not of one the search has left
    Eigen::MatrixXd basis;                               // Q; basis and scaled by factor()
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> scaled;  // of de/dz in units of start_scale

    void factor() {
      Eigen::MatrixXd columns = slopes;
      for (int k = 0; k < kStart; ++k) {
        columns.col(k) *= Plant::start_scale(k);
      }
      scaled.setThreshold(1e-9);
      scaled.compute(columns);
      basis = scaled.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), scaled.rank());
    }

    template <typename Columns>
    Columns off(const Columns& columns) const {
      return columns - basis * (basis.transpose() * columns);
    }

    // How the best state moves, when the errors change by `columns` at the state that was.
    Eigen::MatrixXd move(const Eigen::MatrixXd& columns) const {
      const Eigen::Index rank = basis.cols();
      Eigen::MatrixXd z = Eigen::MatrixXd::Zero(kStart, columns.cols());
      z.topRows(rank) = -scaled.matrixR()
                             .topLeftCorner(rank, rank)
                             .template triangularView<Eigen::Upper>()
                             .solve(basis.transpose() * columns);
      z = scaled.colsPermutation() * z;
      for (int k = 0; k < kStart; ++k) {
        z.row(k) *= Plant::start_scale(k);
      }
      return z;
    }
  };

  template <typename Work>
  void in_parallel(const Work& work) const {
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

  // Where searches go on from: the state that was found, or the guess where the simulation ran away from it.
  Eigen::VectorXd place_of(const Shot& shot, const Window& w) const {
    return shot.start.allFinite() && shot.residual.allFinite() ? shot.start : plant_.guess(w.record, w.first);
  }

  // Window k with where its search begins.
  Window begun(const Machine<double>& params, std::size_t k) const {
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

  // Simulates with derivatives against the first kFelt numbers of the initial state; the others leave no trace.
  template <int kFelt>
  void find_slopes_of(const Machine<double>& params, const Window& w, Shot* shot) const {
    using StartJet = ceres::Jet<double, (kFelt + 3) / 4 * 4>;  // whole AVX registers
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
      shot->slopes.row(row).template head<kFelt>() = jet.v.template head<kFelt>().transpose();
    }
  }

  void find_slopes(const Machine<double>& params, const Window& w, Shot* shot) const {
    if (shot->has_slopes) {
      return;
    }
    if (plant_.feels_all(params, w)) {
      find_slopes_of<kStart>(params, w, shot);
    } else {
      find_slopes_of<Plant::kFelt>(params, w, shot);
    }
    shot->has_slopes = true;
  }

  // A step from a state, and how much of chi-square it promises to take. The damping is relative to the size of each
  // number, so that one without a trace stays where it is.
  struct Step {
    Eigen::Matrix<double, kStart, 1> move;
    double promised;

    Step(const StartMatrix& slopes, const Eigen::VectorXd& residual, double damping) {
      Eigen::Matrix<double, kStart, kStart> normal = slopes.transpose() * slopes;
      const Eigen::Matrix<double, kStart, 1> gradient = slopes.transpose() * residual;
      for (int k = 0; k < kStart; ++k) {
        normal(k, k) += damping * normal(k, k) + 1e-3 / (Plant::start_scale(k) * Plant::start_scale(k));
      }
      move = -normal.ldlt().solve(gradient);
      promised = -gradient.dot(move);
    }
  };

  double enough(double cost) const { return options_.least_gain + options_.least_share * cost; }

  // Levenberg-Marquardt over the initial state, until a step gains next to nothing (WindowOptions). A state is tried in
  // plain numbers, which are ten times cheaper; slopes are worked out where the search goes on from.
  Shot shoot(const Machine<double>& params, const Window& w, int most_steps = 12) const {
    Shot shot;
    shot.start = w.start;
    Eigen::VectorXd tried_residual(w.rows);
    double damping = 1e-6;
    for (int k = 0; k < most_steps; ++k) {
      find_slopes(params, w, &shot);
      const Step step(shot.slopes, shot.residual, damping);
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

  // The better of two searches. One that begins where parameters far away have left it may end in a valley of its own,
  // a piston that sticks where it should slide; a window that keeps more than twice its noise begins at the guess too.
  Shot search(const Machine<double>& params, const Window& w) const {
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

  // Returns how the best initial state moves with each parameter (kStart x free).
  Eigen::MatrixXd differentiate(const Machine<double>& params, const std::vector<int>& free, const Window& w,
                                const Shot& shot, RowMatrix* jacobian) const {
    std::vector<Jet> jets(static_cast<std::size_t>(w.rows));
    Eigen::MatrixXd columns(w.rows, kWidth);
    Jet start[kStart];
    for (int k = 0; k < kStart; ++k) {
      start[k] = Jet(shot.start[k]);
    }
    const int all = static_cast<int>(free.size());
    Eigen::MatrixXd moves(kStart, all);
    for (int first = 0; first < all; first += kWidth) {
      const int width = std::min(kWidth, all - first);
      Machine<Jet> seeded = cast<Jet>(params);
      for (int k = 0; k < width; ++k) {
        param(seeded, free[static_cast<std::size_t>(first + k)]).v[k] = 1.0;
      }
      plant_.simulate(seeded, w, start, jets.data());
      for (int row = 0; row < w.rows; ++row) {
        columns.row(row) = jets[static_cast<std::size_t>(row)].v.transpose();
      }
      const Eigen::MatrixXd here = columns.leftCols(width);
      jacobian->block(w.row, first, w.rows, width) = shot.off(here);
      moves.middleCols(first, width) = shot.move(here);
    }
    return moves;
  }

  void differentiate_hidden(const Machine<double>& params, int knots, const Window& w, const Shot& shot,
                            RowMatrix* out) const {
    std::vector<Jet> jets(static_cast<std::size_t>(w.rows));
    Eigen::MatrixXd columns(w.rows, kWidth);
    const Machine<Jet> plain = cast<Jet>(params);
    Jet start[kStart];
    for (int k = 0; k < kStart; ++k) {
      start[k] = Jet(shot.start[k]);
    }
    const int all = Plant::kHidden * knots;
    std::vector<Jet> push(static_cast<std::size_t>(all));
    for (int first = 0; first < all; first += kWidth) {
      const int width = std::min(kWidth, all - first);
      std::fill(push.begin(), push.end(), Jet(0.0));
      for (int k = 0; k < width; ++k) {
        push[static_cast<std::size_t>(first + k)].v[k] = 1.0;
      }
      plant_.simulate(plain, w, start, jets.data(), push.data(), knots);
      for (int row = 0; row < w.rows; ++row) {
        columns.row(row) = jets[static_cast<std::size_t>(row)].v.transpose();
      }
      out->block(w.row, first, w.rows, width) = shot.off(Eigen::MatrixXd(columns.leftCols(width)));
    }
  }

  Plant plant_;
  WindowOptions options_;
  int rows_ = 0;
  // Where searches begin, which is not what they find.
  mutable std::vector<Window> windows_;
  mutable Machine<double> anchor_{}, last_{};    // parameters of the last Jacobian, of the last evaluation
  mutable std::vector<int> followed_;            // parameters of the last Jacobian
  mutable std::vector<Eigen::MatrixXd> follow_;  // how each window's start moves with them
  mutable std::vector<Eigen::VectorXd> found_;   // by the last evaluation
};

}  // namespace estimation
}  // namespace sms
