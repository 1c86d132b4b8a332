// Every fault of docs/faults.md as a case: how it is made, when it is seen, what the platform does, how it comes back.
#pragma once

#include "faults_of_frames.hpp"
#include "faults_of_hosts.hpp"
#include "faults_of_machine.hpp"

namespace bench {

inline const std::vector<FaultCase>& fault_cases() {
  static const std::vector<FaultCase> kCases = {
      {"frames lost", "30 percent of the command frames for a minute", 21,
       "goes on; after 100 ms without a set-point it levels", "by itself; when it has levelled, by a request",
       &lost_frames},
      {"frames corrupted", "one bit in 30 percent of them", 1, "refuses and counts them", "by itself",
       &corrupted_frames},
      {"frames duplicated", "30 percent come twice", 1, "refuses the second, counts it", "by itself",
       &duplicated_frames},
      {"frames reordered", "30 percent are overtaken by the next one", 1, "refuses the late ones, counts them",
       "by itself", &reordered_frames},
      {"frames delayed", "30 percent come 20 to 80 ms late", 1, "refuses the late ones", "by itself", &delayed_frames},
      {"frames replayed", "a recording of the same session between the host's own frames", 21,
       "refuses those out of sequence; the rest moves within the limits", "by itself", &replayed_frames},
      {"recording played", "a recording after its host is gone", 1, "refuses all of it: the challenge is another",
       "by itself", &replayed_recording},
      {"bus off", "the CAN controller withdraws", 1, "as for host gone", "bus on and heartbeats; then requests",
       &bus_off},
      {"set-points gone", "heartbeats, but no set-points", 101, "levels", "set-points and a request", &setpoints_gone},
      {"host gone", "nothing from the host", 301, "levels, releases control", "heartbeats; then requests", &host_gone},
      {"two hosts", "heartbeats and set-points of another session", 1,
       "the first stays in control; the second may only stop", "by itself, 1 s after its last frame", &two_hosts},
      {"wrong params.def", "a heartbeat with another hash", 1, "gives no control", "a host with the right hash",
       &wrong_hash},
      {"sensor broken", "a position sensor at 0 counts", 3, "closes all valves",
       "acknowledge when the sensor is good again", &sensor_broken},
      {"sensor jumping", "a position sensor 33 mm off at once", 3, "closes all valves", "acknowledge", &sensor_jumping},
      {"sensor stuck", "a position sensor stands still while pressures follow the command", 502, "closes all valves",
       "acknowledge", &sensor_stuck},
      {"valve stuck closed", "neither piston nor pressures follow the command", 502, "closes all valves", "acknowledge",
       &valve_stuck},
      {"valve stuck open", "the piston runs against the command", 1100, "closes all valves", "acknowledge",
       &valve_stuck_open},
      {"supply lost", "supply pressure at ambient", 50, "closes all valves", "acknowledge when the pressure is back",
       &supply_lost},
      {"enable switch opened", "the valves lose their power", 1, "disabled, commands at the centre",
       "close it, request", &enable_opened},
      {"set-point not a number", "a signal without a value", 1, "refuses it, keeps the last", "the next good one",
       &setpoint_nan},
      {"set-point out of the workspace", "0.3 rad roll and pitch at 0.6 m", 11,
       "goes as far as the stroke allows and says so", "the next good one", &setpoint_out_of_workspace},
      {"parameter write while moving", "a transaction while tracking", 1, "refuses it, nothing changes",
       "disable, then write", &write_while_moving},
      {"loop overrun, once", "one period missed", 1, "says so, goes on", "by itself, after 1 s", &single_overrun},
      {"loop overrun, again", "one period in ten missed", 31, "closes all valves", "acknowledge when it has ended",
       &loop_overrun},
      {"watchdog", "a state that is not a number", 1, "does not feed it; after the reset disabled", "acknowledge",
       &watchdog},
  };
  return kCases;
}

}  // namespace bench
