// A bench for the application: a host that behaves, a bus that need not, and a plant simple enough to be sure of.
//
// The plant is no model of the machine: a piston runs at a speed that follows the valve beyond its dead band, a chamber's
// pressure moves with the command. It is there so that the reaction to a fault can be seen, the same on every machine.
#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "application.hpp"
#include "board_model.hpp"

namespace bench {

namespace fw = sms::firmware;
using sms::Fault;
using sms::Frame;
using sms::Mode;
using sms::Word;

// ---- plant ----

struct Plant {
  double extension[3] = {0.18, 0.18, 0.18};
  double lower[3] = {386e3, 386e3, 386e3}, upper[3] = {281e3, 281e3, 281e3};
  double supply = 486e3;
  bool valve_dead[3] = {false, false, false};  // its spool stays at the centre
  double valve_held[3] = {0.0, 0.0, 0.0};      // other than 0: V around the centre, whatever is commanded
  void step(const double (&command)[3]) {
    for (int i = 0; i < 3; ++i) {
      double v = valve_dead[i] ? 0.0 : command[i] - 5.0;
      v = std::abs(valve_held[i]) > 0.0 ? valve_held[i] : v;
      const double open = v > 0.56 ? v - 0.56 : (v < -0.56 ? v + 0.56 : 0.0);
      extension[i] = sms::limited(extension[i] + 1e-3 * 0.3 * open, 0.0, 0.4);
      lower[i] += 0.02 * (386e3 + 4e4 * open - lower[i]);
      upper[i] += 0.02 * (281e3 - 3e4 * open - upper[i]);
    }
  }
};

// ---- host ----

struct Host {
  Word session = 5;
  Word challenge = 0;
  bool synchronised = false;  // has heard a challenge
  int sent = 0;
  Word alive[fw::command_identifiers] = {};
  bool heartbeats = true, setpoints = true;
  sms::Long hash = fw::parameter_hash();
  std::vector<Frame> out;
  bool authenticates = false;
  sms::SipKey key = {0, 0};
  sms::Octets8 nonce = 0;
  sms::Long counter = 0;  // of the last authenticator

  // What goes before a command frame.
  Frame authenticator(const Frame& f) {
    counter += 1u;
    const sms::Octets8 mac = fw::command_mac(fw::begin_mac(key, nonce), counter, f);
    return sms::pack(sms::frame::CommandAuthenticator{counter & 0xFFFu, sms::Long(f.octet[1] >> 4), f.octet[0],
                                                      sms::Long(mac & 0xFFFFFFFFu), sms::Long(mac >> 32)});
  }

  template <typename Kind>
  Frame sealed(Kind s) {
    const int number = fw::command_number(Kind::identifier);
    alive[number] = Word((alive[number] + 1u) & 0xFu);
    s.alive = alive[number];
    s.session = session;
    Frame f = sms::pack(s);
    sms::seal(f, challenge);
    return f;
  }
  template <typename Kind>
  void send(const Kind& s) {
    const Frame f = sealed(s);
    if (authenticates) out.push_back(authenticator(f));
    out.push_back(f);
    ++sent;
  }
  void request(Mode mode, bool acknowledge = false, sms::Long law = 0) {
    send(sms::frame::ModeRequest{0, 0, sms::Long(mode), law, acknowledge ? 1u : 0u});
  }
  void setpoint(float roll, float pitch, float height) {
    send(sms::frame::AttitudeSetpoint{0, 0, roll, pitch, height});
  }
  // What it sends of itself in millisecond k.
  void live(long k) {
    if (!synchronised) return;
    if (heartbeats && k % 100 == 0) {
      send(sms::frame::HostHeartbeat{0, 0, hash, fw::protocol_version});
    }
    if (setpoints && k % 10 == 5) {
      const double t = 1e-3 * double(k);
      setpoint(float(0.03 * std::sin(2.0 * t)), float(0.02 * std::sin(1.3 * t)), 0.5f);
    }
  }
  void listen(const Frame& f) {
    sms::frame::ControllerHeartbeat s;
    if (f.identifier == Word(sms::frame::ControllerHeartbeat::identifier) && sms::unpack(f, s)) {
      challenge = Word(s.challenge);
      synchronised = true;
    }
    sms::frame::SessionNonce n;
    if (f.identifier == Word(sms::frame::SessionNonce::identifier) && sms::unpack(f, n)) {
      const sms::Octets8 said = n.nonce_low | (sms::Octets8(n.nonce_high) << 32);
      counter = said == nonce ? counter : 0u;
      nonce = said;
    }
  }
};

// ---- all together ----

struct Bench {
  std::unique_ptr<fw::Application> app = std::make_unique<fw::Application>();
  sms_hardware_inputs in = {};
  sms_hardware_outputs out = {};
  Plant plant;
  Host host;
  std::vector<Host> others;
  std::mt19937 random{1};
  long k = 0;
  bool plugged_in = true;                            // the controller to the bus
  std::function<void(std::vector<Frame>&)> disturb;  // what the bus does with the frames of a millisecond
  std::function<void(sms_hardware_inputs&)> bend;    // what is wrong with the hardware
  std::vector<Frame> heard;                          // from the controller, in the last millisecond
  std::deque<Frame> queue;
  double worst_rate = 0.0, worst_acceleration = 0.0, least = 1.0, most = 0.0;  // of the set-points

  explicit Bench(sms::ResetCause cause = sms::ResetCause::power_on) { fw::reset(*app, cause, 17); }

  // The controller gets a key, and the host may have another.
  void authenticate(const sms::SipKey& controllers, const sms::SipKey& hosts) {
    fw::set_key(*app, controllers, 1);
    host.authenticates = true;
    host.key = hosts;
  }

  void step() {
    host.live(k);
    std::vector<Frame> frames;
    frames.swap(host.out);
    for (Host& other : others) {
      other.live(k);
      frames.insert(frames.end(), other.out.begin(), other.out.end());
      other.out.clear();
    }
    if (disturb) disturb(frames);
    queue.insert(queue.end(), frames.begin(), frames.end());
    const fw::Parameters& p = app->parameters.active;
    for (int i = 0; i < 3; ++i) {
      in.converted[i] = fw::counts_of_extension(p, i, plant.extension[i]);
      in.converted[3 + i] = fw::counts_of_pressure(p, plant.lower[i]);
      in.converted[6 + i] = fw::counts_of_pressure(p, plant.upper[i]);
    }
    in.converted[9] = fw::counts_of_pressure(p, plant.supply);
    in.enabled = 1;
    in.bus_off = 0;
    in.missed_ticks = 0;
    in.frame_count = 0;
    while (plugged_in && !queue.empty() && in.frame_count < Word(SMS_FRAMES_IN)) {
      in.frames[in.frame_count++] = queue.front();
      queue.pop_front();
    }
    if (!plugged_in) queue.clear();
    if (bend) bend(in);
    const double rate_before[3] = {double(app->leg[0].setpoint.rate), double(app->leg[1].setpoint.rate),
                                   double(app->leg[2].setpoint.rate)};
    const bool was_closed = app->drive == fw::Drive::closed_loop;
    fw::tick(*app, in, out);
    in.character_count = 0;
    heard.assign(out.frames, out.frames + out.frame_count);
    for (const Frame& f : heard) {
      if (plugged_in) host.listen(f);
      for (Host& other : others) other.listen(f);
    }
    double command[3];
    for (int i = 0; i < 3; ++i) {
      command[i] = in.enabled != 0 ? fw::voltage_of(p, out.pulse_width[i]) : 5.0;  // without power the spool is centred
      if (was_closed && app->drive == fw::Drive::closed_loop) watch_setpoint(i, rate_before[i]);
    }
    plant.step(command);
    ++k;
  }

  void watch_setpoint(int i, double rate_before) {
    const sms::Setpoint<float>& s = app->leg[i].setpoint;
    worst_rate = std::max(worst_rate, std::abs(double(s.rate)));
    worst_acceleration = std::max(worst_acceleration, std::abs(double(s.rate) - rate_before) / 1e-3);
    least = std::min(least, double(s.position));
    most = std::max(most, double(s.position));
  }

  // Whether the set-points of all this time kept within range, rate and acceleration, up to float's rounding.
  bool within_limits() const {
    const sms::SetpointLimits<float>& l = app->derived.leg.limits;
    return least >= double(l.lower) - 1e-6 && most <= double(l.upper) + 1e-6 &&
           worst_rate <= double(l.rate) * 1.000001 && worst_acceleration <= double(l.acceleration) * 1.001 + 0.01;
  }

  void run(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) step();
  }

  // Milliseconds until `happened`, at most `most_`; -1 when it did not.
  int until(const std::function<bool()>& happened, int most_) {
    for (int i = 1; i <= most_; ++i) {
      step();
      if (happened()) return i;
    }
    return -1;
  }

  bool has(Fault fault) const { return (fw::all(app->faults) & fw::bit(fault)) != 0u; }
  Mode mode() const { return app->mode; }

  // From whatever it is in to tracking, as a host does it; false when that does not work.
  bool track() {
    for (int i = 0; i < 2000 && (!host.synchronised || has(Fault::link_disturbed)); ++i) step();
    host.request(Mode::disabled, true);
    run(120);
    host.request(Mode::levelling);
    run(200);
    host.request(Mode::tracking);
    run(20);
    return mode() == Mode::tracking;
  }

  // Draws true with a probability of 30 percent.
  bool bad_luck() { return std::uniform_real_distribution<double>(0.0, 1.0)(random) < 0.3; }

  bool at_centre() const {
    const Word centre = 750;
    return out.pulse_width[0] == centre && out.pulse_width[1] == centre && out.pulse_width[2] == centre;
  }
};

}  // namespace bench
