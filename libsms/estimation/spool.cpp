#include "estimation/spool.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "estimation/jets.hpp"
#include "estimation/recorded.hpp"
#include "sms/valve.hpp"

namespace sms {
namespace estimation {
namespace {

constexpr double kLongestStep = 2.5e-4;  // s
constexpr double kRunUp = 0.1;           // s

void check(const SpoolRecord& record, std::size_t number) {
  const auto refuse = [number](const std::string& what) {
    throw std::invalid_argument("spool record " + std::to_string(number) + ": " + what);
  };
  if (!(record.step > 0.0) || record.command.size() < 20) {
    refuse("a step of time above zero and 20 samples at least are needed");
  }
  if (record.position.size() != record.command.size()) {
    refuse("position has " + std::to_string(record.position.size()) + " samples, command has " +
           std::to_string(record.command.size()));
  }
  if (!record.command.allFinite() || !record.position.allFinite()) {
    refuse("command or position holds a value that is not a finite number");
  }
}

// From one place on the record's clock to another, both in samples.
template <typename S>
Lag<S> followed(const Params<S>& p, const SpoolRecord& record, const S& late, const Lag<S>& spool, double from,
                double to) {
  const S h((to - from) * record.step);
  const auto rate = [&](double at, const Lag<S>& y) {
    return spool_rate(p, y, detail::command_at<S>(record.command, S(at) - late));
  };
  const auto moved = [](const Lag<S>& y, const S& dt, const Lag<S>& k) {
    return Lag<S>{y.value + dt * k.value, y.rate + dt * k.rate};
  };
  const double middle = 0.5 * (from + to);
  const Lag<S> k1 = rate(from, spool);
  const Lag<S> k2 = rate(middle, moved(spool, S(0.5) * h, k1));
  const Lag<S> k3 = rate(middle, moved(spool, S(0.5) * h, k2));
  const Lag<S> k4 = rate(to, moved(spool, h, k3));
  const S sixth = h / S(6);
  return {spool.value + sixth * (k1.value + S(2) * (k2.value + k3.value) + k4.value),
          spool.rate + sixth * (k1.rate + S(2) * (k2.rate + k3.rate) + k4.rate)};
}

// Writes the compared samples' residuals and returns where the next begin.
template <typename S>
S* residuals_of(const Params<S>& p, const SpoolRecord& record, SpoolLaw law, S* out) {
  const S late = p.command_delay / S(record.step);
  const int steps = std::max(1, static_cast<int>(std::ceil(record.step / kLongestStep - 1e-9)));
  const int first = SpoolProblem::first_compared(record);
  Lag<S> spool{S(record.command[0]), S(0)};
  for (int k = 0; k < record.command.size(); ++k) {
    if (k >= first) {
      const S place = law == SpoolLaw::cubic ? spool_cubic(p, spool.value) : spool_linear(p, spool.value);
      *out++ = limited<S>(place, -p.spool_limit, p.spool_limit) - S(record.position[k]);
    }
    for (int i = 0; i < steps; ++i) {
      spool = followed(p, record, late, spool, k + double(i) / steps, k + double(i + 1) / steps);
    }
  }
  return out;
}

}  // namespace

int SpoolProblem::first_compared(const SpoolRecord& record) {
  return std::min(static_cast<int>(record.command.size()) / 2, static_cast<int>(std::lround(kRunUp / record.step)));
}

SpoolProblem::SpoolProblem(std::vector<SpoolRecord> records, SpoolLaw law) : records_(std::move(records)), law_(law) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    check(records_[i], i);
    rows_ += static_cast<int>(records_[i].command.size()) - first_compared(records_[i]);
  }
}

void SpoolProblem::evaluate(const Params<double>& params, const std::vector<int>& free, Eigen::VectorXd* residual,
                            RowMatrix* jacobian) const {
  const auto model = [this](const auto& p, auto* out) {
    for (const SpoolRecord& record : records_) {
      out = residuals_of(p, record, law_, out);
    }
  };
  evaluate_with_jets(model, rows_, params, free, residual, jacobian);
}

}  // namespace estimation
}  // namespace sms
