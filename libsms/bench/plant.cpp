// The platform on its pneumatics under the published controller, and one evaluation of its derivative.
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include "bench.hpp"
#include "sms/simulate.hpp"

namespace sms_timing {
namespace {

using Platform = sms::Platform<double>;
using Simulation = sms::Simulation<Platform>;
using Vec3 = sms::Vec3<double>;

constexpr double kTolerance = 1e-4;  // sms.simulation.PLATFORM_TOLERANCE
constexpr int kPeriods = 4000;       // more than one period of the roll: every kind of kink is in it

void require(sms_status status) {
  if (status != SMS_OK) {
    std::abort();
  }
}

// Roll of 0.1 rad at 0.3 Hz from level at mid-stroke, P = 2 with dead-band compensation, 1 kHz.
class RollingPlatform {
 public:
  RollingPlatform() : platform_(sms::make_platform(params_, sms::published_laws(), sms::MassModel::corrected)) {
    sms::Pose<double> pose = sms::rest_pose(platform_.mechanism.geometry);
    for (int k = 0; k < kPeriods; ++k) {
      const Vec3 q(0.1 * std::sin(2.0 * 3.14159265358979324 * 0.3 * params_.control_period * k), 0.0, 0.5);
      require(sms::inverse_kinematics(platform_.mechanism.geometry, q, pose, pose, setpoint_[k]));
    }
    require(sms::platform_at_rest(platform_, Vec3(0.0, 0.0, 0.5), 333e3, start_));
  }

  // All of it; visit(simulation) before every period.
  template <typename Visit>
  void run(const Visit& visit) const {
    const auto s = std::make_unique<Simulation>(platform_);
    const Platform::Input input = {Vec3::Constant(params_.valve_centre), {Vec3::Zero(), Vec3::Zero()}};
    require(begin_simulation(start_, input, params_, sms::PositionControl::pid, true, false, kTolerance, *s));
    for (const Vec3& setpoint : setpoint_) {
      const double noise[3] = {0.0, 0.0, 0.0};
      visit(*s);
      require(sms::take_sample(params_, setpoint.data(), noise, *s));
      require(sms::run_period(*s));
    }
  }

  const Platform& platform() const { return platform_; }

 private:
  const sms::Params<double> params_;
  const Platform platform_;
  Platform::State start_;
  Vec3 setpoint_[kPeriods];
};

}  // namespace

void plant() {
  const RollingPlatform rolling;
  measure("closed-loop platform", kPeriods, [&] { rolling.run([](const Simulation&) {}); });

  struct Moment {
    Platform::State state;
    Platform::Input input;
  };
  std::vector<Moment> moments;
  rolling.run([&](const Simulation& s) {
    if (s.sample % 4 == 0) {
      moments.push_back({s.run.state, s.system.input});
    }
  });
  Platform::Terms terms;
  sms::prepare(rolling.platform(), terms);
  measure("derivative of the platform", int(moments.size()), [&] {
    Platform::State rate;
    for (const Moment& m : moments) {
      require(sms::derivative(rolling.platform(), m.state, m.input, terms, rate));
    }
  });
}

}  // namespace sms_timing
