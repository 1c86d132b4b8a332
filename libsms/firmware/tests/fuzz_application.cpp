// libFuzzer on everything that comes from outside: frames and characters, in any order, whole or broken, with the right
// check or without.
//
//   clang++ -std=c++17 -O1 -g -fsanitize=fuzzer,address,undefined ... fuzz_application.cpp   (./dev test --full)
//
// The input is a script. Each step is one period: an octet says what happens in it, the octets behind it are the data.
// Whatever the script says, the outputs have to be commands, the set-points within their limits, and the state a number.
#include <cstdint>
#include <cstdlib>

#include "bench.hpp"

namespace {

namespace fw = sms::firmware;
using sms::Word;

struct Script {
  const uint8_t* at;
  const uint8_t* end;
  bool is_over() const { return at == end; }
  Word next() { return at < end ? Word(*at++) : Word(0); }
};

const Word kCommands[fw::command_identifiers] = {
    sms::frame::ModeRequest::identifier,      sms::frame::HostHeartbeat::identifier,
    sms::frame::AttitudeSetpoint::identifier, sms::frame::ExtensionSetpoint::identifier,
    sms::frame::ParameterBegin::identifier,   sms::frame::ParameterWrite::identifier,
    sms::frame::ParameterCommit::identifier,  sms::frame::ParameterRead::identifier,
    sms::frame::CaptureSetup::identifier,     sms::frame::CaptureRead::identifier};

// One frame of the script. Otherwise the fuzzer would spend its life guessing: on demand with the right check, counter,
// session and hash.
sms::Frame any_frame(Script& script, Word how, const fw::Application& app) {
  const Word choice = script.next();
  sms::Frame f = {kCommands[choice % fw::command_identifiers], 8, {}};
  if ((how & 0x10u) != 0u) {
    f.identifier = Word(choice * 8u);
    f.length = Word(script.next() % 9u);
  }
  for (Word& octet : f.octet) octet = script.next();
  const int number = fw::command_number(f.identifier);
  if ((how & 0x20u) != 0u && number >= 0) {
    const Word session = app.link.session == fw::nobody ? Word(5) : app.link.session;
    f.octet[1] = Word(((app.link.alive[number].last + 1u) & 0xFu) | unsigned(session << 4));
    const bool hashed = number == 1 || number == 4;
    for (int i = 0; hashed && i < 4; ++i) f.octet[2 + i] = Word((fw::parameter_hash() >> (8 * i)) & 0xFFu);
    if (number == 1) {
      f.octet[6] = fw::protocol_version;
      f.octet[7] = 0;
    }
    sms::seal(f, app.link.challenge);
  }
  return f;
}

void must(bool good) {
  if (!good) std::abort();
}

void check(const bench::Bench& b) {
  must(b.out.feed_watchdog == 1);
  must(b.out.frame_count <= Word(SMS_FRAMES_OUT) && b.out.character_count <= Word(SMS_CHARACTERS_OUT));
  const fw::LegSettings& s = b.app->derived.leg;
  for (int i = 0; i < SMS_LEGS; ++i) {
    must(float(b.out.pulse_width[i]) <= s.pulse_width.largest);
    must(sms::is_finite(b.app->leg[i].setpoint.position) && sms::is_finite(b.app->leg[i].setpoint.rate));
  }
  if (b.mode() == sms::Mode::disabled && b.app->leg[0].step * b.app->leg[0].step <= 0.0f) {
    must(std::abs(b.app->leg[0].command - s.centre) < 1e-3f);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  bench::Bench b;
  b.host.heartbeats = b.host.setpoints = false;
  Script script = {data, data + size};
  std::vector<sms::Frame> frames;
  b.disturb = [&](std::vector<sms::Frame>& all) { all = frames; };
  for (int steps = 0; !script.is_over() && steps < 4000; ++steps) {
    const Word how = script.next();
    frames.clear();
    b.in.character_count = 0;
    for (int i = 0; i < int(how & 3u); ++i) frames.push_back(any_frame(script, how, *b.app));
    if ((how & 0x40u) != 0u) {
      const int count = script.next() % SMS_CHARACTERS_IN;
      for (int i = 0; i < count; ++i) b.in.characters[b.in.character_count++] = script.next();
    }
    const int wait = (how & 0x80u) != 0u ? script.next() : 0;
    b.step();
    check(b);
    frames.clear();
    for (int i = 0; i < wait; ++i) {
      b.step();
      check(b);
    }
  }
  return 0;
}
