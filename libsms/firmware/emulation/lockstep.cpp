// The host's side of the processor in the loop: the simulated platform, a desk on the bus, and the application either
// here or on the emulated target, in lockstep.
//
//   lockstep here FILE        the application runs in this process
//   lockstep target FILE      it runs behind the pipes to_target and from_target
//
// FILE gets one line a period: what went on, so that two runs can be compared. The test is the source's (section 7.3.6):
// the platform is levelled, then a closed-loop chirp in heave from 0.05 to 1 Hz within 60 s.
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <memory>

#include "bench.hpp"
#include "exchange.hpp"
#include "platform_sensors.hpp"

namespace {

namespace fw = sms::firmware;
using Platform = sms::Platform<double>;

enum { level_time = 6000, chirp_time = 60000, after_time = 500 /* ms */ };

// ---- plant ----

struct Machine {
  sms::Params<double> params;
  sms::Simulation<Platform> simulation{sms::make_platform(params, sms::ActuatorLaws{}, sms::MassModel::corrected)};

  sms_status begin() {
    sms::PlatformState<double> state;
    const sms_status status = sms::platform_at_rest(simulation.plant, sms::Vec3<double>(0.0, 0.0, 0.45), 333e3, state);
    if (status != SMS_OK) return status;
    sms::PlatformInput<double> input{sms::Vec3<double>::Zero(), {sms::Vec3<double>::Zero(), sms::Vec3<double>::Zero()}};
    input.command.setConstant(params.valve_centre);
    const sms_status begun =
        sms::begin_simulation(state, input, params, sms::PositionControl::open_loop, false, true, 1e-6, simulation);
    simulation.fixed_step = 5e-4;
    return begun;
  }
  double extension(int leg) const { return sms::extension_of(simulation.run.state, simulation.system.terms, leg); }
  void fill(const fw::Parameters& p, sms_hardware_inputs& in) {
    sms::look(simulation);
    for (int i = 0; i < SMS_LEGS; ++i) {
      in.converted[i] = fw::counts_of_extension(p, i, sms::measure(simulation, params, i, 0.0));
    }
    fw::each_pressure(simulation,
                      [&](int channel, double reading) { in.converted[channel] = fw::counts_of_pressure(p, reading); });
    in.enabled = 1;
  }
};

// ---- the application, here or there ----

sms::SipKey whole_key() {
  const auto joined = [](int i) { return sms::Octets8(lockstep_key[i]) | (sms::Octets8(lockstep_key[i + 1]) << 32); };
  return {joined(0), joined(2)};
}

struct Here {
  std::unique_ptr<fw::Application> app = std::make_unique<fw::Application>();
  Here() {
    fw::reset(*app, sms::ResetCause::power_on, 1);
    fw::set_key(*app, whole_key(), 0);
  }
  bool tick(const sms_hardware_inputs& in, FromTarget& out) {
    fw::tick(*app, in, out.outputs);
    return true;
  }
};

struct There {
  FILE* to = std::fopen("to_target", "wb");
  FILE* from = std::fopen("from_target", "rb");
  bool tick(const sms_hardware_inputs& in, FromTarget& out) {
    if (to == nullptr || from == nullptr || std::fwrite(&in, sizeof in, 1, to) != 1) return false;
    std::fflush(to);
    return std::fread(&out, sizeof out, 1, from) == 1;
  }
};

// ---- the test ----

void schedule(bench::Host& host, long k) {
  const std::pair<const char*, float> settings[] = {
      {"excitation_closed_loop", 1.0f},  {"excitation_waveform", 1.0f},     {"excitation_amplitude_1", 0.15f},
      {"excitation_amplitude_2", 0.15f}, {"excitation_amplitude_3", 0.15f}, {"excitation_frequency_1", 0.05f},
      {"excitation_frequency_2", 0.05f}, {"excitation_frequency_3", 0.05f}, {"excitation_last_frequency", 1.0f},
      {"excitation_duration", 60.0f},    {"excitation_level_time", 1.0f}};
  const long count = long(sizeof settings / sizeof settings[0]);
  if (k == 110) host.send(sms::frame::ParameterBegin{0, 0, fw::parameter_hash()});
  for (long i = 0; i < count; ++i) {
    if (k == 120 + 5 * i) {
      const sms::Long index = sms::Long(fw::parameter_index(settings[i].first));
      host.send(sms::frame::ParameterWrite{0, 0, index, settings[i].second});
    }
  }
  if (k == 200) host.send(sms::frame::ParameterCommit{0, 0, 0, sms::Long(count)});
  if (k == 250) host.request(sms::Mode::levelling);
  if (k == 2000) host.request(sms::Mode::tracking);
  if (k == 4500) host.request(sms::Mode::levelling);
  if (k == level_time) host.request(sms::Mode::excitation);
}

// Every third period somebody without the key fills the mailboxes behind the host's frames: four authenticators, and as
// many set-points as still go in, each of which fits all four. It costs the controller the most, and moves nothing.
void flood(const bench::Host& host, long k, sms_hardware_inputs& in) {
  if (k < 100 || k % 3 != 0) return;
  sms::Frame setpoint = sms::pack(sms::frame::AttitudeSetpoint{0, host.session, 0.1f, 0.1f, 0.5f});
  sms::seal(setpoint, host.challenge);
  for (sms::Long i = 0; in.frame_count < SMS_FRAMES_IN; ++i) {
    in.frames[in.frame_count++] =
        i < 4 ? sms::pack(sms::frame::CommandAuthenticator{(host.counter + 1u + i) & 0xFFFu, host.session,
                                                           setpoint.octet[0], sms::Long(k), i})
              : setpoint;
  }
}

uint32_t hash_of(const sms_hardware_outputs& out) {
  uint32_t hash = 0x811C9DC5u;
  const auto add = [&hash](unsigned word) { hash = (hash ^ word) * 0x01000193u; };
  for (int i = 0; i < int(out.frame_count); ++i) {
    add(out.frames[i].identifier);
    for (int k = 0; k < 8; ++k) add(out.frames[i].octet[k]);
  }
  return hash;
}

template <typename Application>
int run(Application& application, FILE* file) {
  Machine machine;
  if (machine.begin() != SMS_OK) return 1;
  bench::Host host;
  host.authenticates = true;
  host.key = whole_key();
  const fw::Parameters parameters;
  sms_hardware_inputs in = {};
  FromTarget out = {};
  unsigned mode = 0, faults = 0, phase = 0;
  for (long k = 0; k < level_time + 1000 + chirp_time + after_time; ++k) {
    host.setpoints = k < level_time;
    host.live(k);
    schedule(host, k);
    machine.fill(parameters, in);
    in.frame_count = 0;
    for (const sms::Frame& f : host.out) in.frames[in.frame_count++] = f;
    host.out.clear();
    flood(host, k, in);
    if (!application.tick(in, out)) return 1;
    for (int i = 0; i < int(out.outputs.frame_count); ++i) {
      const sms::Frame& f = out.outputs.frames[i];
      host.listen(f);
      sms::frame::Status s;
      if (f.identifier == sms::Word(sms::frame::Status::identifier) && sms::unpack(f, s)) {
        mode = unsigned(s.mode);
        faults = unsigned(s.faults);
        phase = unsigned(s.phase);
      }
    }
    const uint_least16_t* width = out.outputs.pulse_width;
    std::fprintf(file, "%ld,%.9g,%.9g,%.9g,%u,%u,%u,%u,%u,%u,%08" PRIx32 ",%u,%" PRIu32 ",%" PRIu32 "\n", k,
                 machine.extension(0), machine.extension(1), machine.extension(2), unsigned(width[0]),
                 unsigned(width[1]), unsigned(width[2]), mode, phase, faults, hash_of(out.outputs),
                 unsigned(in.frame_count), out.instructions, out.stack);
    for (int i = 0; i < SMS_LEGS; ++i) {
      machine.simulation.command[i] = fw::voltage_of(parameters, width[i]);
    }
    if (sms::run_period(machine.simulation) != SMS_OK) return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: lockstep here|target FILE\n");
    return 2;
  }
  FILE* file = std::fopen(argv[2], "w");
  if (file == nullptr) return 2;
  int failed = 1;
  if (std::strcmp(argv[1], "target") == 0) {
    There there;
    failed = run(there, file);
  } else {
    Here here;
    failed = run(here, file);
  }
  std::fclose(file);
  return failed;
}
