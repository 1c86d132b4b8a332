// The rates of three pistons under one mechanism, along the path on which they were measured (measured_path.hpp): each is
// what it is on the bench, and the mechanism couples their accelerations.
#pragma once

#include <utility>
#include <vector>

#include "estimation/leg_params.hpp"
#include "estimation/measured_path.hpp"
#include "sms/bench.hpp"

namespace sms {
namespace estimation {

template <typename S>
struct Pistons {
  using Scalar = S;
  BenchState<S> leg[3];
};

// Parameters of one run: of the mechanism, and of each leg.
template <typename S>
struct LegMachines {
  Params<S> common;
  Params<S> leg[3];
};

// conditions: ParamIndex, and by how much it is larger in this run.
template <typename S>
LegMachines<S> machines_of(LegParams<S> params, const std::vector<std::pair<int, double>>& conditions) {
  for (const auto& condition : conditions) {
    param(params, condition.first) += S(condition.second);
  }
  return {params, {params_of_leg(params, 0), params_of_leg(params, 1), params_of_leg(params, 2)}};
}

template <typename S>
struct PistonTerms {
  ActuatorTerms<S> actuator[3];
  Vec3<S> friction;
  Vec3<S> along;  // accelerations of the pistons by the law of their friction; the next balance begins there
};

// The path between two samples.
template <typename S>
PathPoint<S> place_between(const std::vector<PathPoint<S>>& path, int sample, double part) {
  const std::size_t k = static_cast<std::size_t>(sample);
  PathPoint<S> place = path[k];
  if (part > 0.0) {
    vector_of(place) += S(part) * (vector_of(path[k + 1]) - vector_of(path[k]));
  }
  return place;
}

// push: hidden inputs, three forces, N, flows into three lower and three upper chambers, kg/s; nullptr for none.
template <typename S>
void piston_rates(const LegMachines<S>& machines, const ActuatorLaws& laws, const PathPoint<S>& place,
                  const Mat3<S>& leaning, const Pistons<S>& state, const Vec3<S>& command, const S* push,
                  PistonTerms<S>& t, Pistons<S>& rate) {
  Vec3<S> drive = place.load, aside, speed;
  Piston<S> piston[3];
  SealState<S> seals[3];
  for (int i = 0; i < 3; ++i) {
    const Params<S>& p = machines.leg[i];
    const BenchState<S>& leg = state.leg[i];
    ActuatorTerms<S>& a = t.actuator[i];
    fill_chambers(p, laws, leg.actuator, leg.extension, leg.velocity, a);
    actuator_rates(p, laws, leg.actuator, S(command(i)), a, rate.leg[i].actuator);
    const S warm = p.gas_constant * p.air_temperature;
    if (push != nullptr) {
      drive(i) += push[i];
      rate.leg[i].actuator.lower.pressure += push[3 + i] * warm / a.lower.volume;
      rate.leg[i].actuator.upper.pressure += push[6 + i] * warm / a.upper.volume;
    }
    drive(i) += a.force;
    piston[i] = a.piston;
    seals[i] = seals_of(leg.actuator);
    aside(i) = leg.extension - place.extension(i);
    speed(i) = leg.velocity;
    rate.leg[i].extension = leg.velocity;
  }
  drive += leaning * aside;
  if (!is_absent(machines.common.panhard_friction)) {
    drive -= machines.common.panhard_friction * (place.drag * speed);
  }
  ForceBalance<S> balance[3];
  if (balance_pistons(machines.leg, laws.friction, piston, seals, place.mass, drive, t.along, balance) != SMS_OK) {
    rate = Pistons<S>{};  // where it cannot go on it stands still: a search then turns back
    return;
  }
  for (int i = 0; i < 3; ++i) {
    t.friction(i) = balance[i].friction;
    rate.leg[i].velocity = balance[i].acceleration;
    seal_rates(balance[i], rate.leg[i].actuator);
  }
}

}  // namespace estimation
}  // namespace sms
