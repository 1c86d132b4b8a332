// A plant through time, in steps that find their own size.
//
// The classical Runge-Kutta method of integrate.hpp with one more look: k5 = f(t + h, x(t + h)). It is the first stage
// of the next step, so it costs nothing, and
//
//   error = h/6 (k5 - k4)
//
// is what a third-order method with k5 in the place of k4 would have made otherwise; the step is taken with the fourth.
// Under a controller that samples every millisecond no step may be longer than that, and a method of fifth order (six
// evaluations) then costs half as much again for digits that nobody sees. A step is accepted when no component errs by
// more than
//
//   tolerance max(|x_i|, scale_i)
//
// and the next one is chosen after K. Gustafsson's PI law, h (0.9 / err^0.18 err_before^0.1), between a fifth and five
// times. Within an accepted step the solution is known everywhere, by the cubic that meets both ends and their rates.
//
// Kinks. Where the equations change their branch (the ends of the stroke, a reversal, the dead zone of the valve) no
// smooth method keeps its order. A plant names functions of its state that change sign there (`switches`). A step over
// such a place is taken again, shortened to where the straight line between both ends says it lies, which is so beside
// it by the square of the step; what follows is a new step with new stages. A command that jumps is no kink: a step
// never passes the time it is told, and renew_command() gives the first stage of the next from the last of this one.
//
// The plant is wrapped in a System:
//
//   using Slow                                                 its slow terms (slow_terms.hpp), or NoSlowTerms
//   sms_status operator()(const State&, Slow&, State& rate)    the derivative, autonomous: input held
//   sms_status near(const State&, const Slow&, State& rate)    the same with slow terms as they are given; where there are any
//   void switches(const State&, S (&)[kSwitches])              called after either at that state
//
// k5 has slow terms of its own and k4 those of the polynomial, so that the error sees what it misses.
#pragma once

#include <cmath>
#include <limits>

#include "sms/integrate.hpp"
#include "sms/limit.hpp"
#include "sms/slow_terms.hpp"

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
template <typename State, typename Slow = NoSlowTerms>
struct Run {
  using S = typename State::Scalar;
  S time;
  State state;
  State rate;    // at that state
  S next;        // size of the step to try, s
  S last_error;  // of the last accepted step over its tolerance
  S began;       // the last accepted step went from here to `time`
  State before;  // state and rate at that beginning
  State rate_before;
  SlowPath<Slow> slow;  // up to `time`
  unsigned long evaluations;
  unsigned long steps;
  unsigned long rejected;
};

// The rate where the run is, when the input has jumped.
template <typename State, typename System, typename Slow = typename System::Slow>
sms_status renew_rate(System& f, Run<State, Slow>& run) {
  Slow slow;
  const sms_status status = f(run.state, slow, run.rate);
  run.slow.count = 0;
  add_place(run.slow, slow, run.time);
  return status;
}

// A run that begins at a state; its first step is cautious.
template <typename State, typename System, typename Slow = typename System::Slow>
sms_status begin_run(System& f, const typename State::Scalar& time, const State& state, Run<State, Slow>& run) {
  using S = typename State::Scalar;
  run.time = time;
  run.began = time;
  run.state = state;
  run.before = state;
  run.next = S(1e-4);
  run.last_error = S(1);
  run.evaluations = 1;
  run.steps = 0;
  run.rejected = 0;
  const sms_status status = renew_rate(f, run);
  run.rate_before = run.rate;
  return status;
}

// The rate in the stages of a step until `end`, s.
template <typename System, typename Slow>
class Stages {
 public:
  template <typename S>
  Stages(System& f, const SlowPath<Slow>& path, const S& end) : f_(f), path_(path), near_(reaches(path, end)) {}
  template <typename S>
  void go_to(const S& time) {
    if (near_) {
      slow_at(path_, time, slow_);
    }
  }
  template <typename State>
  sms_status operator()(const State& state, State& rate) {
    return near_ ? f_.near(state, slow_, rate) : f_(state, slow_, rate);
  }

 private:
  System& f_;
  const SlowPath<Slow>& path_;
  const bool near_;
  Slow slow_;
};

template <typename System>
class Stages<System, NoSlowTerms> {
 public:
  template <typename S>
  Stages(System& f, const SlowPath<NoSlowTerms>&, const S&) : f_(f) {}
  template <typename S>
  void go_to(const S&) {}
  template <typename State>
  sms_status operator()(const State& state, State& rate) {
    NoSlowTerms none;
    return f_(state, none, rate);
  }

 private:
  System& f_;
};

// One attempt: where a step of size h leads, and by how much its tolerance is missed.
template <typename State, typename Slow>
struct Attempt {
  State end;
  State rate;  // there
  Slow slow;
  typename State::Scalar error;
};

template <typename State, typename System, typename Slow = typename System::Slow>
sms_status attempt_step(System& f, const StepControl<State>& control, const Run<State, Slow>& run,
                        const typename State::Scalar& h, Attempt<State, Slow>& a) {
  using S = typename State::Scalar;
  State k2, k3, k4;
  const auto x = vector_of(run.state);
  const auto k1 = vector_of(run.rate);
  auto end = vector_of(a.end);
  const State& at = a.end;
  const S half = S(0.5) * h;
  sms_status status;
  Stages<System, Slow> rate_of(f, run.slow, run.time + h);
  rate_of.go_to(run.time + half);
  end = x + half * k1;
  if ((status = rate_of(at, k2)) != SMS_OK) {
    return status;
  }
  end = x + half * vector_of(k2);
  if ((status = rate_of(at, k3)) != SMS_OK) {
    return status;
  }
  rate_of.go_to(run.time + h);
  end = x + h * vector_of(k3);
  if ((status = rate_of(at, k4)) != SMS_OK) {
    return status;
  }
  end = x + (h / S(6)) * (k1 + S(2) * (vector_of(k2) + vector_of(k3)) + vector_of(k4));
  if ((status = f(at, a.slow, a.rate)) != SMS_OK) {
    return status;
  }
  const auto size = end.cwiseAbs().cwiseMax(vector_of(control.scale));
  const auto change = (vector_of(a.rate) - vector_of(k4)).cwiseAbs();
  a.error = h / (S(6) * control.tolerance) * change.cwiseQuotient(size).template maxCoeff<Eigen::PropagateNaN>();
  return SMS_OK;
}

// The state at a time within the last step.
template <typename State, typename Slow>
State state_at(const Run<State, Slow>& run, const typename State::Scalar& time) {
  using S = typename State::Scalar;
  const S h = run.time - run.began;
  const S part = (time - run.began) / h, rest = S(1) - part;
  const auto from = vector_of(run.before), to = vector_of(run.state);
  const typename StateVector<State>::Vector chord = to - from;
  State state;
  vector_of(state) =
      from + part * chord +
      part * rest * (rest * (h * vector_of(run.rate_before) - chord) + part * (chord - h * vector_of(run.rate)));
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

// How the size of a step changes after an error, over its tolerance, and the one before it.
template <typename S>
S growth(const S& error, const S& error_before) {
  using std::pow;
  return limited<S>(S(0.9) * pow(error, S(-0.18)) * pow(error_before, S(0.1)), S(0.2), S(5));
}

// How a step that failed is shortened. Its error may be no number.
template <typename S>
S shrinking(const S& error) {
  using std::pow;
  const S shrink = error < S(1e6) ? S(0.9) * pow(error, S(-0.25)) : S(0.1);
  return shrink > S(0.1) ? shrink : S(0.1);
}

// Chooses the next step after one of size h. What was left before the end, `last`, may be short and says nothing.
template <typename State, typename Slow>
void choose_next(const typename State::Scalar& h, bool last, const typename State::Scalar& error,
                 Run<State, Slow>& run) {
  using S = typename State::Scalar;
  const S seen = error > S(1e-4) ? error : S(1e-4);
  const S wanted = h * growth<S>(seen, run.last_error);
  if (!last || wanted > run.next) {
    run.next = wanted;
    run.last_error = seen;
  }
}

template <typename State, typename Slow>
void accept_step(const Attempt<State, Slow>& a, const typename State::Scalar& end, Run<State, Slow>& run) {
  run.began = run.time;
  run.before = run.state;
  run.rate_before = run.rate;
  run.time = end;
  run.state = a.end;
  run.rate = a.rate;
  add_place(run.slow, a.slow, end);
  ++run.steps;
}

// One accepted step that does not pass `end`. Where it would have to be smaller than control.smallest: what the
// derivative said ahead, else SMS_NOT_CONVERGED; the run stands where it was.
template <typename State, typename System, typename Slow = typename System::Slow>
sms_status adaptive_step(System& f, const StepControl<State>& control, const typename State::Scalar& end,
                         Run<State, Slow>& run) {
  using S = typename State::Scalar;
  S before[System::switch_count], after[System::switch_count];
  f.switches(run.state, before);
  Attempt<State, Slow> a;
  S h = run.next < control.largest ? run.next : control.largest;
  bool shortened = false;  // by a switch: the size says nothing about the next
  sms_status ahead = SMS_NOT_CONVERGED;
  for (;;) {
    const bool last = run.time + h * (S(1) + S(1e-6)) >= end;
    h = last ? end - run.time : h;
    const sms_status status = attempt_step(f, control, run, h, a);
    run.evaluations += 4;
    if (status != SMS_OK || !(a.error <= S(1))) {
      ++run.rejected;
      ahead = status == SMS_OK ? ahead : status;
      h *= status == SMS_OK ? shrinking(a.error) : S(0.1);
      run.next = h;
      if (h < control.smallest) {
        return ahead;
      }
      continue;
    }
    if (!shortened) {
      f.switches(a.end, after);
      const S part = first_switch(before, after);
      shortened = part < S(0.999) && part > S(1e-3) && part * h > control.smallest;
      if (shortened) {
        ++run.rejected;
        h *= part;
        continue;
      }
      choose_next(h, last, a.error, run);
    }
    accept_step(a, last ? end : S(run.time + h), run);
    return SMS_OK;
  }
}

}  // namespace sms
