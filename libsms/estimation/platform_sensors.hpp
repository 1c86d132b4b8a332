// What the platform's sensors see: those of its three legs (actuator_sensors.hpp), and roll and pitch.
#pragma once

#include "estimation/actuator_sensors.hpp"
#include "estimation/platform_rates.hpp"

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
struct PlatformSensors {
  // step: of the simulation, s. moved: which way the readings of extension went last, as ActuatorSensors has it.
  PlatformSensors(const LegMachines<S>& machines, const S& step, const Vec3<double>& moved)
      : leg{{machines.leg[0], step, moved(0)}, {machines.leg[1], step, moved(1)}, {machines.leg[2], step, moved(2)}},
        roll(machines.common.sensor_lag_roll, step),
        pitch(machines.common.sensor_lag_pitch, step) {}

  // The state a step after the last call, where the platform is, and the forces on the pistons.
  void follow(const LegMachines<S>& machines, const PathPoint<S>& place, const Pistons<S>& y, const Pistons<S>& rate,
              const PistonTerms<S>& t) {
    for (int i = 0; i < 3; ++i) {
      // The sensor sits on the cylinder, and sees more of the rod where the frame yields below it.
      leg[i].follow(machines.leg[i], y.leg[i], rate.leg[i], t.friction(i) - t.actuator[i].force);
    }
    if (roll.follows || pitch.follows) {
      const PoseSeen<S> q = pose_seen(place, y);
      roll.follow(q.pose(0), q.rate(0));
      pitch.follow(q.pose(1), q.rate(1));
    }
  }

  ActuatorSensors<S> leg[3];
  detail::FollowingSensor<S> roll, pitch;
};

}  // namespace estimation
}  // namespace sms
