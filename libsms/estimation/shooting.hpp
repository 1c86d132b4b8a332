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
// That may have been a Jacobian of a few parameters; for the others this product is that of the last that had them.
//
// The slopes de/dz that were found there hold nearby too, and a residual alone is then one simulation or two in plain
// numbers (the chord method). They are worked out again where they promise more than they keep, or a window is badly off.
//
// With a Jacobian, a window that is left badly off is searched from its guess as well, and from the state with which any
// parameters have fitted it best so far.
//
// So a residual and its Jacobian are those of the parameters alone, windows are independent of each other, and a window
// is the natural block of whatever is resampled.
//
// A plant is a class with
//   template <S> using Machine                          its parameters: Params<S>, or more than that (leg_params.hpp)
//   template <S> void simulate(const Machine<S>&, const Window&, const S* start, S* residual, const Hidden<S>&) const
//   int channels(record), start_scale(k)
//   int kHidden, kCommands                              inputs of its equations; valves that are driven by a record
//   int kStart, kFelt; bool feels_all(params, Window)   of the kStart numbers of the initial state the first kFelt leave a
//                                                       trace in any machine, the others only in one that feels all
//
// A plant's problem is compiled once, in the plant's own file (shooting_search.hpp).
#pragma once

#include <functional>
#include <vector>

#include "estimation/hidden_inputs.hpp"
#include "estimation/jet.hpp"
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
  double enough(double chi_square) const { return least_gain + least_share * chi_square; }
};

// A window at an initial state.
struct Shot {
  Eigen::VectorXd start;
  Eigen::VectorXd residual;
  Eigen::MatrixXd slopes;   // de/dz
  bool has_slopes = false;  // of this state, and not of one the search has left
};

// One window at given parameters, as a search for its initial state asks for it; the search is compiled once for all
// plants.
class WindowSimulation {
 public:
  virtual ~WindowSimulation() = default;
  virtual void find_residual(const Eigen::VectorXd& start, Eigen::VectorXd* residual) const = 0;
  // Residual and slopes at the shot's state.
  virtual void find_slopes(Shot* shot) const = 0;
};

// Samples of a window at least: one of fewer has nothing left to compare once its initial state is fitted.
constexpr int kLeastOfWindow = 8;

// Derivatives against parameters, eight at a time: sixteen take no less time in all, and emit twice the code.
using ParameterJet = Jet<8>;

template <typename Plant>
class ShootingProblem : public ProblemOf<typename Plant::template Machine<double>> {
 public:
  template <typename S>
  using Machine = typename Plant::template Machine<S>;

  ShootingProblem(Plant plant, const WindowOptions& options);

  int rows() const override { return rows_; }
  bool repeats() const override { return false; }
  const std::vector<Window>& windows() const { return windows_; }
  const Plant& plant() const { return plant_; }
  // The initial state of a window that was found last.
  const Eigen::VectorXd& found(std::size_t window) const {
    return found_[window].size() > 0 ? found_[window] : windows_[window].start;
  }

  void evaluate(const Machine<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                RowMatrix* jacobian) const override;

  // Residuals before the projection, at the best initial states: predicted less measured, over the noise.
  Eigen::VectorXd errors(const Machine<double>& params) const;

  // The best initial states at `params` become where later searches begin.
  void settle(const Machine<double>& params);

  // Derivatives of the projected residuals against inputs that are hidden in the plant's equations: each of
  // Plant::kHidden inputs has `knots` values per window, linear in between. Row block by row block:
  // (rows x kHidden * knots), a window's rows belonging to its own knots.
  RowMatrix hidden(const Machine<double>& params, int knots) const;

  // Against the time, s, by which the kJumps largest jumps of each command come further ahead of the sample that shows them
  // (command_jumps.hpp): (rows x Plant::kCommands * kJumps), in order of time; zeros where a window has fewer.
  RowMatrix jumps(const Machine<double>& params) const;

  // The samples of the record that show them: (windows x Plant::kCommands * kJumps), -1 where there are fewer.
  Eigen::MatrixXi jump_samples() const;

  // From now on the jumps of a command are known to have come so far ahead of the samples that show them, s, a value a
  // sample of the record.
  void set_ahead(int record, int command, const Eigen::VectorXd& ahead);

 private:
  static constexpr int kStart = Plant::kStart;
  static constexpr int kWidth = ParameterJet::DIMENSION;
  class Simulated;  // a window of this plant

  static Eigen::VectorXd start_scales();

  // Where searches go on from: the state that was found, or the guess where the simulation ran away from it.
  Eigen::VectorXd place_of(const Shot& shot, const Window& w) const;

  // Window k with where its search begins.
  Window begun(const Machine<double>& params, std::size_t k) const;

  // From where window k begins, w, to its best initial state, by the slopes of the last Jacobian as far as they lead.
  // exact: by those at the state itself in the end.
  Shot shoot(const Machine<double>& params, const Window& w, std::size_t k, bool exact = false) const;

  // The best of three searches. One that begins where parameters far away have left it may end in a valley of its own,
  // a piston that sticks where it should slide; a window that keeps more than twice its noise begins at the guess too, and
  // where it was once left with half as much.
  Shot search(const Machine<double>& params, const Window& w, std::size_t k) const;

  // Window k is begun from here on where this search has ended.
  void anchor(const Shot& shot, std::size_t k) const;

  // What a search has found for window k, w.
  void note(const Shot& shot, const Window& w, std::size_t k) const;

  // Returns how the best initial state moves with each parameter (kStart x free).
  Eigen::MatrixXd differentiate(const Machine<double>& params, const std::vector<int>& free, const Window& w,
                                const Shot& shot, RowMatrix* jacobian) const;
  // Against `count` values that are hidden in each window, as a simulation takes them.
  using HiddenOf = std::function<Hidden<ParameterJet>(const ParameterJet* values)>;
  RowMatrix against_hidden(const Machine<double>& params, int count, const HiddenOf& as_hidden) const;
  void differentiate_hidden(const Machine<double>& params, int count, const HiddenOf& as_hidden, const Window& w,
                            const Shot& shot, RowMatrix* out) const;

  Plant plant_;
  WindowOptions options_;
  int rows_ = 0;
  // Where searches begin, which is not what they find.
  mutable std::vector<Window> windows_;
  mutable Machine<double> anchor_{}, last_{};    // parameters of the last Jacobian, of the last evaluation
  mutable std::vector<int> followed_;            // parameters of all Jacobians
  mutable std::vector<Eigen::MatrixXd> follow_;  // how each window's start moves with them, by the last that had them
  mutable std::vector<Eigen::MatrixXd> slopes_;  // de/dz of each window where it is begun; empty before the first
  mutable std::vector<Eigen::VectorXd> found_;   // by the last evaluation
  mutable std::vector<Eigen::VectorXd> best_;    // of all evaluations
  mutable std::vector<double> least_;            // chi-square with that
};

}  // namespace estimation
}  // namespace sms

// Of a plant and a scalar: what stands in the plant's header as `extern SMS_PLANT_SIMULATES(...)` and in its file without.
#define SMS_PLANT_SIMULATES(Plant, S) \
  template void Plant::simulate<S>(const Plant::Machine<S>&, const Window&, const S*, S*, const Hidden<S>&) const
