// The mechanism along a motion, as a controller or a simulation works: every solve starts at the pose before it
// ("warm"). And a table and a batch of unrelated poses. Through the C ABI, except where C++ saves the simulation a
// solve.
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "bench.hpp"
#include "grid.hpp"
#include "sms/dynamics.hpp"
#include "sms/parallel_kinematics.hpp"
#include "sms/sms.h"

namespace sms_timing {
namespace {

constexpr int kSamples = 2000;
constexpr double kTimeStep = 1e-3;  // s

template <typename Real>
struct Machine;

template <>
struct Machine<double> {
  sms_mechanism mechanism;
  sms_pose rest;
  Machine() {
    sms_params params;
    sms_params_default(&params);
    sms_mechanism_from_params(&params, SMS_MASSES_CORRECTED, &mechanism);
    sms_rest_pose(&mechanism.geometry, &rest);
  }
};

template <>
struct Machine<float> {
  sms_mechanismf mechanism;
  sms_posef rest;
  Machine() {
    sms_paramsf params;
    sms_params_defaultf(&params);
    sms_mechanism_from_paramsf(&params, SMS_MASSES_CORRECTED, &mechanism);
    sms_rest_posef(&mechanism.geometry, &rest);
  }
};

template <typename Real>
struct Sample {
  Real q[3], qdot[3], extension[3], force[3];
};

void require(sms_status status) {
  if (status != SMS_OK) {
    std::abort();
  }
}

// A ship's motion: 2 s at 1 kHz, up to 4 deg and 0.1 m.
template <typename Real>
std::vector<Sample<Real>> ship_motion() {
  const Machine<double> machine;
  const double amplitude[3] = {0.07, 0.05, 0.1}, omega[3] = {2.9, 2.3, 3.4}, middle[3] = {0.0, 0.0, 0.5};
  std::vector<Sample<Real>> samples(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    double q[3], qdot[3], extension[3], force[3];
    for (int k = 0; k < 3; ++k) {
      q[k] = middle[k] + amplitude[k] * std::sin(omega[k] * kTimeStep * i);
      qdot[k] = amplitude[k] * omega[k] * std::cos(omega[k] * kTimeStep * i);
    }
    sms_pose pose;
    require(sms_inverse_kinematics(&machine.mechanism.geometry, q, nullptr, &pose, extension, nullptr));
    require(sms_inverse_dynamics(&machine.mechanism, q, qdot, nullptr, nullptr, nullptr, force));
    for (int k = 0; k < 3; ++k) {
      Sample<Real>& s = samples[std::size_t(i)];
      s.q[k] = Real(q[k]);
      s.qdot[k] = Real(qdot[k]);
      s.extension[k] = Real(extension[k]);
      s.force[k] = Real(force[k]);
    }
  }
  return samples;
}

// call(sample), which gives a status, for every sample of the motion.
template <typename Real, typename Call>
void along(const std::vector<Sample<Real>>& motion, const char* name, const Call& call) {
  measure(name, kSamples, [&] {
    for (const Sample<Real>& sample : motion) {
      require(call(sample));
    }
  });
}

void in_double() {
  const Machine<double> machine;
  const sms_geometry& geometry = machine.mechanism.geometry;
  const std::vector<Sample<double>> motion = ship_motion<double>();
  sms_pose pose = machine.rest;
  double out[3];
  along(motion, "inverse kinematics, warm",
        [&](const Sample<double>& s) { return sms_inverse_kinematics(&geometry, s.q, &pose, &pose, out, nullptr); });
  along(motion, "inverse kinematics, from rest",
        [&](const Sample<double>& s) { return sms_inverse_kinematics(&geometry, s.q, nullptr, &pose, out, nullptr); });
  pose = machine.rest;
  along(motion, "forward kinematics, warm",
        [&](const Sample<double>& s) { return sms_forward_kinematics(&geometry, s.extension, &pose, &pose, nullptr); });
  along(motion, "forward dynamics", [&](const Sample<double>& s) {
    return sms_forward_dynamics(&machine.mechanism, s.q, s.qdot, s.force, nullptr, nullptr, out);
  });
}

void in_float() {
  const Machine<float> machine;
  const sms_geometryf& geometry = machine.mechanism.geometry;
  const std::vector<Sample<float>> motion = ship_motion<float>();
  sms_posef pose = machine.rest;
  float out[3];
  along(motion, "inverse kinematics, warm, float",
        [&](const Sample<float>& s) { return sms_inverse_kinematicsf(&geometry, s.q, &pose, &pose, out, nullptr); });
  along(motion, "forward kinematics, warm, float",
        [&](const Sample<float>& s) { return sms_forward_kinematicsf(&geometry, s.extension, &pose, &pose, nullptr); });
}

// The same machine as one that is given by data (parallel_mechanism.hpp), along the same motion.
void by_data() {
  const sms::Geometry<double> g = sms::make_geometry(sms::Params<double>());
  sms::ParallelMechanism<double> mechanism = {};
  mechanism.legs = 6;
  for (int i = 0; i < 6; ++i) {
    mechanism.leg[i] = {g.base[i],
                        g.platform[i],
                        i < 3 ? sms::LegLength::actuated : sms::LegLength::fixed,
                        i < 3 ? 0.0 : g.panhard_length(i - 3),
                        false,
                        sms::Vec3<double>::Zero()};
  }
  mechanism.characteristic_length = sms::mean_platform_radius(mechanism);
  const sms::Pose<double> rest = sms::rest_pose(g);
  sms::PlatformPose<double> pose = {sms::Vec3<double>(rest.x, rest.y, -rest.height), sms::Mat3<double>::Identity()};
  along(ship_motion<double>(), "forward kinematics by data, warm", [&](const Sample<double>& s) {
    double length[3];
    for (int k = 0; k < 3; ++k) {
      length[k] = g.actuator_length(k) + s.extension[k];
    }
    sms::Search<double> search;
    return sms::parallel_forward(mechanism, length, pose, pose, search);
  });
}

// Free swinging on three springs, every step by the classical fourth-order Runge-Kutta method.
class Swing {
 public:
  Swing() : mechanism_(sms::make_mechanism(sms::Params<double>(), sms::MassModel::corrected)) { start(); }

  void start() {
    state_ << 0.03, -0.02, 0.5, 0.2, 0.1, -0.1;
    terms_.pose = sms::rest_pose(mechanism_.geometry);
  }

  void step(double h) {
    const State k1 = derivative(state_), k2 = derivative(state_ + 0.5 * h * k1);
    const State k3 = derivative(state_ + 0.5 * h * k2), k4 = derivative(state_ + h * k3);
    state_ += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
  }

 private:
  using State = Eigen::Matrix<double, 6, 1>;  // q, q'

  State derivative(const State& state) {
    const double weight_share = 1000.0, stiffness = 36e3, middle = 0.2;  // N, N/m, m
    const sms::Vec3<double> q = state.head<3>(), rate = state.tail<3>();
    sms::Pose<double> pose;
    sms::Vec3<double> extension;
    require(sms::inverse_kinematics(mechanism_.geometry, q, terms_.pose, pose, extension));
    sms::evaluate_dynamics(mechanism_, pose, rate, terms_);
    const sms::Vec3<double> stretch = extension.array() - middle;
    const sms::Vec3<double> force = sms::Vec3<double>::Constant(weight_share) - stiffness * stretch;
    State result;
    result << rate, sms::acceleration(terms_, sms::actuator_load(terms_, force));
    return result;
  }

  const sms::Mechanism<double> mechanism_;
  sms::DynamicsTerms<double> terms_;
  State state_;
};

void simulation() {
  constexpr int kSteps = 200;
  Swing swing;
  measure("simulation step", kSteps, [&] {
    swing.start();
    for (int i = 0; i < kSteps; ++i) {
      swing.step(kTimeStep);
    }
  });
}

// The table of section 3.5 by ik_tables' own loop, on one core.
void table() {
  ik_tables::Progress quiet(true);
  ik_tables::Table table;
  table.precision = ik_tables::Precision::kDouble;
  table.roll = table.pitch = ik_tables::nodes(-0.1, 0.1, 201, table.precision);
  table.height = {0.5};
  const sms::Geometry<double> geometry = sms::make_geometry(sms::Params<double>());
  measure("table", 1, [&] { ik_tables::solve(geometry, 1, quiet, table); });
}

// A million unrelated poses, all that is known of each kept: what sms.inverse_kinematics and sms.forward_kinematics of
// Python do.
void batch() {
  constexpr const char *kInverse = "inverse kinematics, batch", *kForward = "forward kinematics, batch";
  if (!wanted(kInverse) && !wanted(kForward)) {
    return;
  }
  constexpr std::size_t kPoses = 1000000;
  const Machine<double> machine;
  const sms_geometry& geometry = machine.mechanism.geometry;
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> angle(-0.1, 0.1), height(0.4, 0.6);
  std::vector<double> q;
  for (std::size_t i = 0; i < kPoses; ++i) {
    q.insert(q.end(), {angle(engine), angle(engine), height(engine)});
  }
  std::vector<sms_pose> pose(kPoses);
  std::vector<double> extension(3 * kPoses);
  std::vector<sms_convergence> convergence(kPoses);
  std::vector<sms_status> status(kPoses);
  const auto inverse = [&] {
    require(sms_inverse_kinematics_array(&geometry, kPoses, q.data(), nullptr, pose.data(), extension.data(),
                                         convergence.data(), status.data()));
  };
  inverse();
  measure(kInverse, int(kPoses), inverse);
  measure(kForward, int(kPoses), [&] {
    require(sms_forward_kinematics_array(&geometry, kPoses, extension.data(), nullptr, pose.data(), convergence.data(),
                                         status.data()));
  });
}

}  // namespace

void mechanism() {
  in_double();
  in_float();
  by_data();
  simulation();
  table();
  batch();
}

}  // namespace sms_timing
