// The rates of three pistons under one mechanism, along the path on which they were measured (measured_path.hpp): each is
// what it is on the bench, and the mechanism couples their accelerations.
#pragma once

#include <utility>
#include <vector>

#include "estimation/actuator_step.hpp"
#include "estimation/leg_params.hpp"
#include "estimation/measured_path.hpp"

namespace sms {
namespace estimation {

template <typename S>
struct Pistons {
  using Scalar = S;
  BenchState<S> leg[3];
};

template <typename S>
Vec3<S> speeds_of(const Pistons<S>& pistons) {
  return {pistons.leg[0].velocity, pistons.leg[1].velocity, pistons.leg[2].velocity};
}

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
  Vec3<S> along;  // accelerations of the pistons; the next balance begins there
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
                  const Mat3<S>& leaning, const Pistons<S>& state, const Vec3<S>& command, const Vec3<S>& film,
                  const S* push, PistonTerms<S>& t, Pistons<S>& rate) {
  Vec3<S> drive = place.load, aside, speed;
  Piston<S> piston[3];
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
    aside(i) = leg.extension - place.extension(i);
    speed(i) = leg.velocity;
    rate.leg[i].extension = leg.velocity;
    rate.leg[i].actuator.deflection = S(0);
  }
  drive += leaning * aside;
  if (!is_absent(machines.common.panhard_friction)) {
    drive -= machines.common.panhard_friction * (place.drag * speed);
  }
  if (depends_on_acceleration(laws.friction)) {
    coupled_accelerations<S>(machines.leg, laws.friction, piston, place.mass, drive, t.along);
    t.friction = drive - place.mass * t.along;
  } else {
    for (int i = 0; i < 3; ++i) {
      const ForceBalance<S> alone =
          force_balance<S>(machines.leg[i], laws.friction, piston[i], state.leg[i].actuator.deflection, S(1), S(0));
      t.friction(i) = alone.friction;
      rate.leg[i].actuator.deflection = alone.deflection_rate;
    }
    t.along = solution<S>(place.mass, drive - t.friction);
  }
  Vec3<S> deviation;
  bool deviates = false;
  for (int i = 0; i < 3; ++i) {
    const Params<S>& p = machines.leg[i];
    deviates = deviates || !is_absent(p.presliding_share) || !is_absent(p.friction_lag);
    deviation(i) = detail::seal_deviation<S>(p, piston[i], t.friction(i), state.leg[i].actuator.deflection, film(i),
                                             &rate.leg[i].actuator.deflection);
  }
  Vec3<S> acceleration = t.along;
  if (deviates) {
    acceleration -= solution<S>(place.mass, deviation);
  }
  for (int i = 0; i < 3; ++i) {
    rate.leg[i].velocity = acceleration(i);
  }
}

}  // namespace estimation
}  // namespace sms
