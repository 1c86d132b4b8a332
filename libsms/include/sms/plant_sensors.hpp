// The sensors of a plant, one a row of signals.def: what they see of its state, and what they say (sensor.hpp).
//
// All have one shape. follow() is one look at the plant, a step after the last one; each() then calls
//
//   visit(name, leg, sensor, value, rate)
//
// for every sensor: its signal, its actuator from 1 on (0: of the whole), and the truth with its rate, which
// sensor.reading(value, rate, late) makes a reading. Readings come in the order of signals.def, leg by leg.
#pragma once

#include "sms/bench.hpp"
#include "sms/platform.hpp"
#include "sms/sensor.hpp"
#include "sms/tank.hpp"

namespace sms {

// What the sensors of one actuator look at.
template <typename S>
struct LegSeen {
  S eye;  // where the position sensor's eye is, m
  S velocity;
  const ActuatorState<S>& air;
  const ActuatorState<S>& rate;
};

// Those of one actuator. Play between rod and position sensor is carried along.
template <typename S>
class ActuatorSensors {
 public:
  ActuatorSensors() = default;
  // step: from one look to the next, s. moved: 1 if the extension's reading rose last, -1 if it fell, 0 if that is not
  // known.
  ActuatorSensors(const Params<S>& p, const S& step, double moved = 0.0)
      :
#define SMS_LEG_SENSOR(name, unit, zero, zero_known, gain_known, linearity_known, label, value, rate_, ...) \
  name##_(name##_sensor(p), step),
#include "sms/signals.def"
        pushed_(moved) {
  }

  // `leg` with its eye where the piston is; `force` bends the mount, N.
  void follow(const Params<S>& p, LegSeen<S> leg, const S& force) {
    const S eye = yielded_extension<S>(p, leg.eye, force);
    if (begun_ && !is_absent(p.backlash)) {
      eye_ = played<S>(eye_, eye, p.backlash);
    } else {
      eye_ = eye - S(0.5 * pushed_) * p.backlash;
    }
    begun_ = true;
    leg.eye = eye_;
#define SMS_LEG_SENSOR(name, unit, zero, zero_known, gain_known, linearity_known, label, value, rate_, ...) \
  name##_.follow(value, rate_);
#include "sms/signals.def"
  }

  // From the next look on they are this far apart, s.
  void look_every(const S& step) {
#define SMS_LEG_SENSOR(name, ...) name##_.look_every(step);
#include "sms/signals.def"
  }

  // At the last look.
  template <typename Visit>
  void each(LegSeen<S> leg, int number, const Visit& visit) const {
    leg.eye = eye_;
#define SMS_LEG_SENSOR(name, unit, zero, zero_known, gain_known, linearity_known, label, value, rate_, ...) \
  visit(#name, number, name##_, S(value), S(rate_));
#include "sms/signals.def"
  }

  S extension_reading(const S& velocity) const { return extension_.reading(eye_, velocity); }

 private:
#define SMS_LEG_SENSOR(name, unit, zero, zero_known, gain_known, linearity_known, label, value, rate_, ...) \
  Sensor<S> name##_;
#include "sms/signals.def"
  double pushed_ = 0.0;
  S eye_{0};
  bool begun_ = false;
};

// ---- bench ----

// N, of the cylinder on its mount.
template <typename S>
S mount_force(const BenchTerms<S>& t) {
  return t.actuator.force - t.balance.friction;
}

template <typename S>
class BenchSensors {
 public:
  BenchSensors() = default;
  BenchSensors(const Bench<S>& bench, const S& step, double moved = 0.0)
      : leg_(bench.params, step, moved), supply_(supply_pressure_sensor(bench.params), step) {}

  void follow(const Bench<S>& bench, const BenchState<S>& state, const BenchState<S>& rate, const BenchTerms<S>& t) {
    leg_.follow(bench.params, seen(state, rate), mount_force(t));
    supply_.follow(state.actuator.supply_pressure, rate.actuator.supply_pressure);
  }
  void look_every(const S& step) {
    leg_.look_every(step);
    supply_.look_every(step);
  }
  template <typename Visit>
  void each(const Bench<S>&, const BenchState<S>& state, const BenchState<S>& rate, const BenchTerms<S>&,
            const Visit& visit) const {
    leg_.each(seen(state, rate), 0, visit);
    visit("supply_pressure", 0, supply_, S(state.actuator.supply_pressure), S(rate.actuator.supply_pressure));
  }
  const ActuatorSensors<S>& leg() const { return leg_; }
  // What a controller takes for the extension.
  S extension_reading(const BenchState<S>& state, const BenchTerms<S>&, int) const {
    return leg_.extension_reading(state.velocity);
  }

 private:
  static LegSeen<S> seen(const BenchState<S>& state, const BenchState<S>& rate) {
    return {state.extension, state.velocity, state.actuator, rate.actuator};
  }
  ActuatorSensors<S> leg_;
  Sensor<S> supply_;
};

// ---- platform ----

// N, of an actuator on the frame that its sensor sits on: it sees more of the rod where the frame yields below it.
template <typename S>
S platform_mount_force(const ActuatorTerms<S>& actuator, const S& friction) {
  return friction - actuator.force;
}

// Those of the actuators, of the first one's reservoir, and of the platform itself.
template <typename S>
class PlatformSensors {
 public:
  PlatformSensors() = default;
  PlatformSensors(const Platform<S>& platform, const S& step)
      : leg_{{platform.params[0], step}, {platform.params[1], step}, {platform.params[2], step}},
        supply_(supply_pressure_sensor(platform.params[0]), step),
        roll_(roll_sensor(platform.params[0]), step),
        pitch_(pitch_sensor(platform.params[0]), step) {}

  void follow(const Platform<S>& platform, const PlatformState<S>& state, const PlatformState<S>& rate,
              const PlatformTerms<S>& t) {
    for (int i = 0; i < 3; ++i) {
      leg_[i].follow(platform.params[i], seen(state, rate, t, i),
                     platform_mount_force(t.actuator[i], S(t.friction(i))));
    }
    supply_.follow(state.actuator[0].supply_pressure, rate.actuator[0].supply_pressure);
    roll_.follow(state.q(0), state.rate(0));
    pitch_.follow(state.q(1), state.rate(1));
  }
  template <typename Visit>
  void each(const Platform<S>&, const PlatformState<S>& state, const PlatformState<S>& rate, const PlatformTerms<S>& t,
            const Visit& visit) const {
    for (int i = 0; i < 3; ++i) {
      leg_[i].each(seen(state, rate, t, i), i + 1, visit);
    }
    visit("supply_pressure", 0, supply_, S(state.actuator[0].supply_pressure), S(rate.actuator[0].supply_pressure));
    visit("roll", 0, roll_, S(state.q(0)), S(state.rate(0)));
    visit("pitch", 0, pitch_, S(state.q(1)), S(state.rate(1)));
  }
  S extension_reading(const PlatformState<S>&, const PlatformTerms<S>& t, int leg) const {
    return leg_[leg].extension_reading(t.velocity(leg));
  }

 private:
  static LegSeen<S> seen(const PlatformState<S>& state, const PlatformState<S>& rate, const PlatformTerms<S>& t,
                         int i) {
    return {t.extension(i), t.velocity(i), state.actuator[i], rate.actuator[i]};
  }
  ActuatorSensors<S> leg_[3];
  Sensor<S> supply_, roll_, pitch_;
};

// ---- tank ----

template <typename S>
class TankSensors {
 public:
  TankSensors() = default;
  TankSensors(const Tank<S>& tank, const S& step)
      : pressure_(tank_pressure_sensor(tank.params), step),
        temperature_(tank_temperature_sensor(tank.params), step),
        supply_(supply_pressure_sensor(tank.params), step) {
    pressure_.limit(tank.params.tank_pressure_floor, tank.params.tank_pressure_ceiling);
  }

  // The thermocouple at a temperature of its own at the first look, K.
  void begin(const S& thermocouple) { temperature_.begin(thermocouple); }

  void look_every(const S& step) {
    pressure_.look_every(step);
    temperature_.look_every(step);
    supply_.look_every(step);
  }

  void follow(const Tank<S>& tank, const TankState<S>& state, const TankState<S>& rate, const TankTerms<S>&) {
    pressure_.follow(state.gas.pressure, rate.gas.pressure);
    temperature_.follow(temperature(tank, state), temperature_rate(tank, rate));
    supply_.follow(state.supply_pressure, rate.supply_pressure);
  }
  template <typename Visit>
  void each(const Tank<S>& tank, const TankState<S>& state, const TankState<S>& rate, const TankTerms<S>&,
            const Visit& visit) const {
    visit("tank_pressure", 0, pressure_, S(state.gas.pressure), S(rate.gas.pressure));
    visit("tank_temperature", 0, temperature_, temperature(tank, state), temperature_rate(tank, rate));
    visit("supply_pressure", 0, supply_, S(state.supply_pressure), S(rate.supply_pressure));
  }
  S extension_reading(const TankState<S>&, const TankTerms<S>&, int) const { return S(0); }

 private:
  static S temperature(const Tank<S>& tank, const TankState<S>& state) {
    return seen_air(tank.params, tank.laws.chamber, state.gas).temperature;
  }
  static S temperature_rate(const Tank<S>& tank, const TankState<S>& rate) {
    return seen_temperature_rate(tank.params, tank.laws.chamber, rate.gas.temperature);
  }
  Sensor<S> pressure_, temperature_, supply_;
};

// ---- by plant ----

template <typename Plant>
struct SensorsOf;
template <typename S>
struct SensorsOf<Bench<S>> {
  using Type = BenchSensors<S>;
};
template <typename S>
struct SensorsOf<Platform<S>> {
  using Type = PlatformSensors<S>;
};
template <typename S>
struct SensorsOf<Tank<S>> {
  using Type = TankSensors<S>;
};

}  // namespace sms
