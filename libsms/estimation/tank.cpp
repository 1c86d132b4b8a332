#include "estimation/tank.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "estimation/jets.hpp"
#include "sms/integrate.hpp"

namespace sms {
namespace estimation {
namespace {

constexpr int kOpeningSteps = 8;
constexpr double kStepsToRise = 60.0;  // in the time of 63 % of the way
constexpr double kSettled = 1e-9;      // relative change in a step

// The pressure around the component at a time of the record: constant, or linear between measured samples.
template <typename S>
S outside_pressure(const Params<S>& p, const TankRecord& record, const S& time) {
  if (!record.charge) {
    return p.ambient_pressure;
  }
  const Eigen::Index n = record.supply.size();
  if (n == 0) {
    return p.supply_pressure;
  }
  const double* const begin = record.time.data();
  const Eigen::Index above =
      std::clamp<Eigen::Index>(std::upper_bound(begin, begin + n, value_of(time)) - begin, 1, n - 1);
  const double slope =
      (record.supply[above] - record.supply[above - 1]) / (record.time[above] - record.time[above - 1]);
  const bool inside = value_of(time) > record.time[0] && value_of(time) < record.time[n - 1];
  return inside ? S(record.supply[above - 1] + slope * (time - record.time[above - 1]))
                : S(value_of(time) > record.time[0] ? record.supply[n - 1] : record.supply[0]);
}

// d/dt over the test's own clock.
template <typename S>
struct System {
  const Params<S>& p;
  const TankRecord& record;
  FlowTestKind kind;

  FlowTest<S> rate(const S& time, const FlowTest<S>& test) const {
    return flow_test_rate<S>(p, kind, time, test, outside_pressure<S>(p, record, time + p.opening_time));
  }
};

// The system through one step, whose first rate is known from the step before.
template <typename S>
struct OneStep {
  const System<S>& system;
  const FlowTest<S>& first;
  bool begun = false;

  sms_status operator()(const S& time, const FlowTest<S>& test, FlowTest<S>& rate) {
    rate = begun ? system.rate(time, test) : first;
    begun = true;
    return SMS_OK;
  }
};

// State and rate at the end of a step.
template <typename S>
struct Node {
  S time;
  FlowTest<S> test;
  FlowTest<S> rate;
};

template <typename S>
bool has_settled(const Node<S>& node, double dt) {
  const auto slow = [dt](const S& rate, const S& x) {
    return std::abs(value_of(rate)) * dt < kSettled * std::abs(value_of(x));
  };
  return slow(node.rate.pressure, node.test.pressure) && slow(node.rate.temperature, node.test.temperature) &&
         slow(node.rate.thermocouple, node.test.thermocouple);
}

// The cubic through the values and rates at both ends of a step of size h.
template <typename S>
struct Cubic {
  S c0{}, c1{}, c2{}, c3{};

  Cubic() = default;
  Cubic(const S& value_a, const S& rate_a, const S& value_b, const S& rate_b, const S& h) : c0(value_a), c1(rate_a) {
    const S per_step = S(1) / h;
    const S secant = (value_b - value_a) * per_step;
    c2 = (S(3) * secant - S(2) * rate_a - rate_b) * per_step;
    c3 = (rate_a + rate_b - S(2) * secant) * (per_step * per_step);
  }
  S operator()(const S& x) const { return c0 + x * (c1 + x * (c2 + x * c3)); }
};

// Runs through the test once, while its reader asks for later and later times.
template <typename S>
class Run {
 public:
  Run(const Params<S>& p, const TankRecord& record, FlowTestKind kind, double step)
      : p_(p), record_(record), system_{p, record, kind}, step_(step) {
    const FlowTest<S> start = flow_test_start(p, kind);
    from_ = to_ = {S(0), start, system_.rate(S(0), start)};
  }

  FlowTest<S> at(const S& time) {
    if (value_of(time) <= 0.0) {
      return flow_test_start(p_, system_.kind);
    }
    while (!settled_ && to_.time < time) {
      from_ = to_;
      const S h = step_count_ < kOpeningSteps ? opening_step() : S(step_);
      runge_kutta_step(OneStep<S>{system_, from_.rate}, from_.time, h, to_.test);
      to_.time += h;
      to_.rate = system_.rate(to_.time, to_.test);
      ++step_count_;
      settled_ = record_.supply.size() == 0 && step_count_ > kOpeningSteps && has_settled(to_, step_);
      drawn_ = false;
    }
    return to_.time < time ? to_.test : between(S(time - from_.time));
  }

 private:
  S opening_step() const {
    return p_.opening_duration > S(0) ? S(p_.opening_duration / S(kOpeningSteps)) : S(step_ / kOpeningSteps);
  }

  // Where temperature is constant, only the pressure has a curve.
  FlowTest<S> between(const S& x) {
    const bool heat = system_.kind.heat == ChamberLaw::energy;
    if (!drawn_) {
      const S h = to_.time - from_.time;
      const auto curve = [&](S FlowTest<S>::*field) {
        return Cubic<S>(from_.test.*field, from_.rate.*field, to_.test.*field, to_.rate.*field, h);
      };
      pressure_ = curve(&FlowTest<S>::pressure);
      if (heat) {
        temperature_ = curve(&FlowTest<S>::temperature);
        thermocouple_ = curve(&FlowTest<S>::thermocouple);
      }
      drawn_ = true;
    }
    return heat ? FlowTest<S>{pressure_(x), temperature_(x), thermocouple_(x)}
                : FlowTest<S>{pressure_(x), from_.test.temperature, from_.test.thermocouple};
  }

  const Params<S>& p_;
  const TankRecord& record_;
  System<S> system_;
  double step_;
  Node<S> from_, to_;
  Cubic<S> pressure_, temperature_, thermocouple_;
  bool drawn_ = false;
  int step_count_ = 0;
  bool settled_ = false;
};

double median(Eigen::VectorXd values) {
  double* const middle = values.data() + values.size() / 2;
  std::nth_element(values.data(), middle, values.data() + values.size());
  return *middle;
}

// A sixtieth of the time in which the pressure went from 5 to 63 % of its way.
double choose_step(const TankRecord& record) {
  const Eigen::Index n = record.time.size(), few = std::min<Eigen::Index>(n, 5);
  const double first = median(record.pressure.head(few)), last = median(record.pressure.tail(few));
  const auto reached = [&](double share) {
    Eigen::Index i = 0;
    while (i < n - 1 && std::abs(record.pressure[i] - first) < share * std::abs(last - first)) {
      ++i;
    }
    return record.time[i];
  };
  const double span = record.time[n - 1] - record.time[0];
  return std::clamp((reached(0.63) - reached(0.05)) / kStepsToRise, 1e-4 * span, 0.02 * span);
}

void check(const TankRecord& record) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument("tank record: " + what); };
  const Eigen::Index n = record.time.size();
  if (n < 2) {
    refuse("at least two samples are needed");
  }
  const auto check_one = [&](const Eigen::VectorXd& signal, const char* name, bool may_lack) {
    if (signal.size() != n && !(may_lack && signal.size() == 0)) {
      refuse(std::string(name) + " has " + std::to_string(signal.size()) + " samples, time has " + std::to_string(n));
    }
    if (!signal.allFinite()) {
      refuse(std::string(name) + " holds a value that is not a finite number");
    }
  };
  check_one(record.time, "time", false);
  check_one(record.pressure, "pressure", false);
  check_one(record.temperature, "temperature", true);
  check_one(record.supply, "supply", true);
  if (!((record.time.tail(n - 1) - record.time.head(n - 1)).array() > 0.0).all()) {
    refuse("time does not rise from sample to sample");
  }
}

}  // namespace

TankProblem::TankProblem(TankRecord record, FlowTestKind kind) : record_(std::move(record)), kind_(kind) {
  check(record_);
  step_ = choose_step(record_);
}

void TankProblem::evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                           RowMatrix* jacobian) const {
  const auto model = [this](const auto& p, auto* out) {
    using S = typename std::decay<decltype(*out)>::type;
    Run<S> run(p, record_, kind_, step_);
    for (Eigen::Index i = 0; i < record_.time.size(); ++i) {
      const S time = record_.time[i] - p.opening_time;
      const FlowTest<S> test = run.at(time);
      S inflow(0);
      if (!is_absent(p.tank_line_resistance)) {
        inflow = flow_test_inflow(p, kind_.law, time, test, outside_pressure<S>(p, record_, S(record_.time[i])));
      }
      out[i] = tank_pressure_reading(p, test.pressure, inflow) - record_.pressure[i];
      if (record_.temperature.size() > 0) {
        out[record_.time.size() + i] = test.thermocouple - record_.temperature[i];
      }
    }
  };
  evaluate_with_jets<8>(model, rows(), params, free, residual, jacobian);
}

}  // namespace estimation
}  // namespace sms
