// What the sensors of a platform see whose pistons move along a measured path: those of its three legs
// (plant_sensors.hpp), of the first one's reservoir, and roll and pitch.
#pragma once

#include "estimation/platform_rates.hpp"
#include "sms/plant_sensors.hpp"

namespace sms {
namespace estimation {

// Roll, pitch and height of these pistons, and their rates, by the slopes at the measured place.
template <typename S>
struct PoseSeen {
  Vec3<S> pose, rate;
};

template <typename S>
PoseSeen<S> pose_seen(const PathPoint<S>& place, const Pistons<S>& state) {
  Vec3<S> aside, speed;
  for (int i = 0; i < 3; ++i) {
    aside(i) = state.leg[i].extension - place.extension(i);
    speed(i) = state.leg[i].velocity;
  }
  return {place.q + place.to_pose * aside, place.to_pose * speed};
}

template <typename S>
LegSeen<S> seen(const Pistons<S>& y, const Pistons<S>& rate, int leg) {
  return {y.leg[leg].extension, y.leg[leg].velocity, y.leg[leg].actuator, rate.leg[leg].actuator};
}

template <typename S>
struct PathSensors {
  // step: of the simulation, s. moved: which way the readings of extension went last, as ActuatorSensors has it.
  PathSensors(const LegMachines<S>& machines, const S& step, const Vec3<double>& moved)
      : leg{{machines.leg[0], step, moved(0)}, {machines.leg[1], step, moved(1)}, {machines.leg[2], step, moved(2)}},
        supply(supply_pressure_sensor(machines.common), step),
        roll(roll_sensor(machines.common), step),
        pitch(pitch_sensor(machines.common), step) {}

  // From the next look on they are this far apart, s.
  void look_every(const S& step_now) {
    for (ActuatorSensors<S>& sensors : leg) {
      sensors.look_every(step_now);
    }
    for (Sensor<S>* sensor : {&supply, &roll, &pitch}) {
      sensor->look_every(step_now);
    }
  }

  // The state a step after the last call, where the platform is, and the forces on the pistons.
  void follow(const LegMachines<S>& machines, const PathPoint<S>& place, const Pistons<S>& y, const Pistons<S>& rate,
              const PistonTerms<S>& t) {
    for (int i = 0; i < 3; ++i) {
      leg[i].follow(machines.leg[i], seen(y, rate, i), platform_mount_force(t.actuator[i], S(t.friction(i))));
    }
    if (roll.follows() || pitch.follows()) {
      const PoseSeen<S> q = pose_seen(place, y);
      roll.follow(q.pose(0), q.rate(0));
      pitch.follow(q.pose(1), q.rate(1));
    }
  }

  ActuatorSensors<S> leg[3];
  Sensor<S> supply, roll, pitch;
};

}  // namespace estimation
}  // namespace sms
