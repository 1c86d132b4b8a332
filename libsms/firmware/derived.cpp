// What follows from the parameters, and a new set of them put into effect.
#include "application.hpp"

namespace sms {
namespace firmware {
namespace {

// What no bound of a single parameter can say: sensors that are calibrated between two places, and the period that the
// times of the application are counted in.
bool is_possible(const Parameters& p) {
  const Settings& s = p.settings;
  const float span[SMS_LEGS] = {s.calibration_extended_1 - s.calibration_retracted_1,
                                s.calibration_extended_2 - s.calibration_retracted_2,
                                s.calibration_extended_3 - s.calibration_retracted_3};
  bool possible = p.machine.control_period > 0.999e-3f && p.machine.control_period < 1.001e-3f;
  for (const float counts : span) {
    possible = possible && (counts > 100.0f || counts < -100.0f);
  }
  return possible;
}

// Of a number that is not negative.
unsigned long nearest(float x) {
  using std::floor;
  return static_cast<unsigned long>(floor(x + 0.5f));
}

}  // namespace

sms_status derive(const Parameters& p, Derived& derived) {
  if (!is_possible(p)) {
    return SMS_OUT_OF_RANGE;
  }
  Derived d;
  d.geometry = make_geometry(p.machine);
  Vec3<float> level;
  const sms_status status = inverse_kinematics(d.geometry, Vec3<float>(0.0f, 0.0f, p.settings.level_height),
                                               rest_pose(d.geometry), d.level_pose, level);
  if (status != SMS_OK) {
    return status;
  }
  d.leg = leg_settings(p);
  for (int i = 0; i < SMS_LEGS; ++i) {
    if (level(i) < d.leg.limits.lower || level(i) > d.leg.limits.upper) {
      return SMS_OUT_OF_WORKSPACE;
    }
    d.level_extension[i] = level(i);
  }
  const Settings& s = p.settings;
  d.excitation = {s.excitation_waveform > 0.5f ? Waveform::chirp : Waveform::sine,
                  {s.excitation_amplitude_1, s.excitation_amplitude_2, s.excitation_amplitude_3},
                  {s.excitation_frequency_1, s.excitation_frequency_2, s.excitation_frequency_3},
                  {s.excitation_offset_1, s.excitation_offset_2, s.excitation_offset_3},
                  s.excitation_last_frequency,
                  s.excitation_duration};
  d.excitation_closed_loop = s.excitation_closed_loop > 0.5f;
  const float rate = 1.0f / p.machine.control_period;
  d.sequence = {nearest(s.excitation_level_time * rate), nearest(s.excitation_duration * rate),
                nearest(s.excitation_cycles)};
  derived = d;
  return SMS_OK;
}

WriteAccess write_access(const Application& app) {
  const bool at_rest = app.mode == Mode::disabled || app.mode == Mode::fault;
  return at_rest ? WriteAccess::all : (app.mode == Mode::levelling ? WriteAccess::live : WriteAccess::none);
}

ParameterResult commit_parameters(Application& app, Word count) {
  ParameterStore& store = app.parameters;
  ParameterResult result = parameters_ready(store, write_access(app), count);
  if (result == ParameterResult::ok) {
    exchange_staged(store);
    if (derive(store.active, app.derived) != SMS_OK) {
      exchange_staged(store);
      result = ParameterResult::impossible_machine;
    }
  }
  note(app, result == ParameterResult::ok ? EventKind::parameters_applied : EventKind::parameters_discarded,
       Word(result));
  return result;
}

}  // namespace firmware
}  // namespace sms
