// A plant through time, in steps that find their own size.
//
// The pair of Runge-Kutta methods of J. R. Dormand and P. J. Prince (J. Comp. Appl. Math. 6, 1980): fifth order, an
// embedded fourth one whose difference estimates the error of the step, and the last stage of a step is the first of the
// next. A step is accepted when no component errs by more than
//
//   tolerance max(|x_i|, scale_i)
//
// and the next one is chosen after K. Gustafsson's PI law, h (0.9 / err^0.14 err_before^0.08), between a fifth and five
// times. Within an accepted step the solution is known everywhere: E. Hairer's fourth-order interpolation.
//
// Kinks. Where the equations change their branch (the ends of the stroke, a reversal, the dead zone of the valve) no
// smooth method keeps its order. A plant names functions of its state that change sign there (`switches`). A step over
// such a place is shortened, by regula falsi on the step itself, until it ends there to within a thousandth of it; what
// follows is a new step with new stages. A command that jumps is no kink: a step never passes the time it is told, and
// renew_command() gives the first stage of the next from the last of this one.
//
// The plant is wrapped in a System:
//
//   sms_status operator()(const State&, State& rate)    the derivative, autonomous: input held
//   void switches(const State&, S (&)[kSwitches])       called after the derivative at that state
#pragma once

#include <cmath>
#include <limits>

#include "sms/integrate.hpp"

namespace sms {

// What is asked of a run.
template <typename State>
struct StepControl {
  using S = typename State::Scalar;
  S tolerance;  // relative error of one step
  State scale;  // magnitudes below which it counts as absolute
  S largest;    // s
  S smallest;   // s; a step that would have to be smaller ends the run
};

template <typename State>
StepControl<State> step_control(const State& scale, const typename State::Scalar& tolerance) {
  using S = typename State::Scalar;
  return {tolerance, scale, S(0.1), S(1e-10)};
}

// Where a run is.
template <typename State>
struct Run {
  using S = typename State::Scalar;
  using Vector = typename StateVector<State>::Vector;
  S time;
  State state;
  State rate;    // at that state
  S next;        // size of the step to try, s
  S last_error;  // of the last accepted step over its tolerance
  S began;       // of the last accepted step: from `began` to `time`
  Vector curve[5];
  unsigned long evaluations;
  unsigned long steps;
  unsigned long rejected;
};

// A run that begins at a state; its first step is cautious.
template <typename State, typename System>
sms_status begin_run(System& f, const typename State::Scalar& time, const State& state, Run<State>& run) {
  using S = typename State::Scalar;
  run.time = time;
  run.began = time;
  run.state = state;
  run.next = S(1e-4);
  run.last_error = S(1);
  run.evaluations = 1;
  run.steps = 0;
  run.rejected = 0;
  return f(run.state, run.rate);
}

// One attempt: where a step of size h leads, and by how much its tolerance is missed.
template <typename State>
struct Attempt {
  State k[7];  // the last is the rate at `end`
  State end;
  typename State::Scalar error;
};

template <typename State, typename System>
sms_status attempt_step(System& f, const StepControl<State>& control, const Run<State>& run,
                        const typename State::Scalar& h, Attempt<State>& a) {
  using S = typename State::Scalar;
  using std::abs;
  static const S weight[6][6] = {
      {S(1.0 / 5)},
      {S(3.0 / 40), S(9.0 / 40)},
      {S(44.0 / 45), S(-56.0 / 15), S(32.0 / 9)},
      {S(19372.0 / 6561), S(-25360.0 / 2187), S(64448.0 / 6561), S(-212.0 / 729)},
      {S(9017.0 / 3168), S(-355.0 / 33), S(46732.0 / 5247), S(49.0 / 176), S(-5103.0 / 18656)},
      {S(35.0 / 384), S(0), S(500.0 / 1113), S(125.0 / 192), S(-2187.0 / 6784), S(11.0 / 84)}};
  static const S off[7] = {S(71.0 / 57600),      S(0),          S(-71.0 / 16695), S(71.0 / 1920),
                           S(-17253.0 / 339200), S(22.0 / 525), S(-1.0 / 40)};
  const auto x = vector_of(run.state);
  auto end = vector_of(a.end);
  a.k[0] = run.rate;
  for (int stage = 0; stage < 6; ++stage) {
    typename StateVector<State>::Vector moved = weight[stage][0] * vector_of(a.k[0]);
    for (int i = 1; i <= stage; ++i) {
      moved += weight[stage][i] * vector_of(a.k[i]);
    }
    end = x + h * moved;
    const sms_status status = f(const_cast<const State&>(a.end), a.k[stage + 1]);
    if (status != SMS_OK) {
      return status;
    }
  }
  typename StateVector<State>::Vector missed = off[0] * vector_of(a.k[0]);
  for (int i = 2; i < 7; ++i) {
    missed += off[i] * vector_of(a.k[i]);
  }
  a.error = S(0);
  const auto scale = vector_of(control.scale);
  for (int i = 0; i < StateVector<State>::size; ++i) {
    const S size = abs(end(i)) > scale(i) ? abs(end(i)) : scale(i);
    const S error = abs(h * missed(i)) / (control.tolerance * size);
    if (!(error <= a.error)) {  // also a NaN
      a.error = error;
    }
  }
  return SMS_OK;
}

// The polynomial of an accepted step, for state_at().
template <typename State>
void keep_curve(const Attempt<State>& a, const typename State::Scalar& h, Run<State>& run) {
  using S = typename State::Scalar;
  static const S bend[7] = {S(-12715105075.0 / 11282082432.0),  S(0),
                            S(87487479700.0 / 32700410799.0),   S(-10690763975.0 / 1880347072.0),
                            S(701980252875.0 / 199316789632.0), S(-1453857185.0 / 822651844.0),
                            S(69997945.0 / 29380423.0)};
  const auto from = vector_of(run.state), to = vector_of(a.end);
  run.curve[0] = from;
  run.curve[1] = to - from;
  run.curve[2] = h * vector_of(a.k[0]) - run.curve[1];
  run.curve[3] = run.curve[1] - h * vector_of(a.k[6]) - run.curve[2];
  run.curve[4] = bend[0] * vector_of(a.k[0]);
  for (int i = 2; i < 7; ++i) {
    run.curve[4] += bend[i] * vector_of(a.k[i]);
  }
  run.curve[4] *= h;
}

// The state at a time within the last step.
template <typename State>
State state_at(const Run<State>& run, const typename State::Scalar& time) {
  using S = typename State::Scalar;
  const S part = (time - run.began) / (run.time - run.began);
  const S rest = S(1) - part;
  State state;
  vector_of(state) =
      run.curve[0] + part * (run.curve[1] + rest * (run.curve[2] + part * (run.curve[3] + rest * run.curve[4])));
  return state;
}

// Which of the switches changed its sign, and at what part of the step by the straight line between both ends; 1 when
// none did.
template <typename S, int n>
S first_switch(const S (&before)[n], const S (&after)[n]) {
  S first = S(1);
  for (int i = 0; i < n; ++i) {
    if ((before[i] < S(0)) != (after[i] < S(0))) {
      const S part = before[i] / (before[i] - after[i]);
      first = part < first ? part : first;
    }
  }
  return first;
}

template <typename State, typename System>
void accept_step(const Attempt<State>& a, const typename State::Scalar& h, const typename State::Scalar& end,
                 Run<State>& run) {
  keep_curve<State>(a, h, run);
  run.began = run.time;
  run.time = end;
  run.state = a.end;
  run.rate = a.k[6];
  ++run.steps;
}

// One accepted step that does not pass `end`. SMS_NOT_CONVERGED: it would have to be smaller than control.smallest; the
// run stands where it was.
template <typename State, typename System>
sms_status adaptive_step(System& f, const StepControl<State>& control, const typename State::Scalar& end,
                         Run<State>& run) {
  using S = typename State::Scalar;
  using std::pow;
  constexpr int kSwitches = System::switch_count;
  S before[kSwitches], after[kSwitches];
  f.switches(run.state, before);
  Attempt<State> a;
  S h = run.next < control.largest ? run.next : control.largest;
  bool shortened = false;  // by a switch: the size says nothing about the next
  for (;;) {
    const bool whole = run.time + h * (S(1) + S(1e-6)) >= end;
    h = whole ? end - run.time : h;
    const sms_status status = attempt_step(f, control, run, h, a);
    run.evaluations += 6;
    if (status == SMS_OK && a.error <= S(1)) {
      f.switches(a.end, after);
      const S part = first_switch(before, after);
      if (part < S(0.999) && part * h > S(1e-3) * h && part * h > control.smallest && !shortened) {
        h *= part;
        shortened = true;
        ++run.rejected;
        continue;
      }
      const S error = a.error > S(1e-4) ? a.error : S(1e-4);
      if (!shortened) {
        const S grow = S(0.9) * pow(error, S(-0.14)) * pow(run.last_error, S(0.08));
        const S wanted = h * (grow < S(0.2) ? S(0.2) : (grow > S(5) ? S(5) : grow));
        run.next = whole && wanted < run.next ? run.next : wanted;
        run.last_error = error;
      }
      accept_step<State, System>(a, h, whole ? end : run.time + h, run);
      return SMS_OK;
    }
    ++run.rejected;
    const S shrink = status == SMS_OK && a.error < S(1e6) ? S(0.9) * pow(a.error, S(-0.2)) : S(0.1);
    h *= shrink > S(0.1) ? shrink : S(0.1);
    run.next = h;
    if (h < control.smallest) {
      return status == SMS_OK ? SMS_NOT_CONVERGED : status;
    }
  }
}

}  // namespace sms
