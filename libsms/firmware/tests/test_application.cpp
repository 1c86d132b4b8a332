// The application: transitions without a jump, tests as the sequencer runs them, capture, parameters never by halves,
// frames of a stranger without effect.
#include <doctest/doctest.h>

#include <cstring>

#include "bench.hpp"
#include "random_cases.hpp"

namespace {

namespace fw = sms::firmware;
using bench::Bench;
using sms::ControlLaw;
using sms::Long;
using sms::Mode;

// Largest change of a command within one period, V, over so many ms.
double largest_step(Bench& b, int milliseconds) {
  double largest = 0.0;
  for (int k = 0; k < milliseconds; ++k) {
    const float before[3] = {b.app->leg[0].command, b.app->leg[1].command, b.app->leg[2].command};
    b.step();
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(double(b.app->leg[i].command - before[i])));
  }
  return largest;
}

bool write(Bench& b, const std::vector<std::pair<const char*, float>>& values) {
  b.host.send(sms::frame::ParameterBegin{0, 0, fw::parameter_hash()});
  b.run(2);
  for (const auto& [name, value] : values) {
    b.host.send(sms::frame::ParameterWrite{0, 0, Long(fw::parameter_index(name)), value});
    b.run(2);
  }
  const Long applied = b.app->log.count;
  b.host.send(sms::frame::ParameterCommit{0, 0, 0, Long(values.size())});
  b.run(2);
  return b.app->log.entry[applied % fw::events_kept].kind == sms::EventKind::parameters_applied;
}

}  // namespace

TEST_CASE("application: the defaults are a machine that can be levelled") {
  fw::Derived derived;
  CHECK(fw::derive(fw::Parameters(), derived) == SMS_OK);
  CHECK(derived.level_extension[0] == doctest::Approx(0.20042).epsilon(1e-4));
}

TEST_CASE("application: it levels the platform and holds it") {
  Bench b;
  b.run(200);
  b.host.request(Mode::levelling);
  b.run(15000);
  CHECK(b.mode() == Mode::levelling);
  for (int i = 0; i < 3; ++i) {
    CHECK(b.plant.extension[i] == doctest::Approx(double(b.app->derived.level_extension[i])).epsilon(0.02));
  }
  CHECK(double(b.app->pose.height) == doctest::Approx(0.5).epsilon(0.01));
  CHECK(b.within_limits());
}

TEST_CASE("application: no transition makes the valves jump") {
  // With the dead-band compensation off the commands are smooth, and any step would be the transition's.
  Bench b;
  b.run(200);
  REQUIRE(write(b, {{"dead_band_step", 0.0f},
                    {"proportional_gain", 20.0f},
                    {"integral_gain", 5.0f},
                    {"acceleration_gain", 0.0f},
                    {"excitation_amplitude_1", 0.7f},
                    {"excitation_level_time", 0.3f},
                    {"excitation_duration", 0.6f}}));
  const double smooth = 0.06;  // V: one count of the sensor moves 40 V/m by 4 mV, a set-point's step of 10 ms by more
  CHECK(largest_step(b, 50) < smooth);
  b.host.request(Mode::levelling);
  CHECK(largest_step(b, 400) < smooth);
  b.host.request(Mode::tracking);
  CHECK(largest_step(b, 100) < smooth);
  for (const ControlLaw law : {ControlLaw::pid, ControlLaw::state_feedback, ControlLaw::proportional}) {
    b.host.request(Mode::tracking, false, Long(law));
    CHECK(largest_step(b, 500) < smooth);
    CHECK(b.app->law == law);
  }
  b.host.request(Mode::levelling);
  CHECK(largest_step(b, 300) < smooth);
  b.host.request(Mode::excitation);
  CHECK(largest_step(b, 1500) < smooth);  // level, excite open loop, level again
  CHECK(b.mode() == Mode::levelling);
  b.host.request(Mode::disabled);
  CHECK(largest_step(b, 500) < smooth);
  CHECK(b.at_centre());
}

TEST_CASE("application: an open-loop test sends the excitation to the valves as it is") {
  Bench b;
  b.run(200);
  REQUIRE(write(b, {{"excitation_amplitude_2", 0.7f},
                    {"excitation_frequency_2", 0.5f},
                    {"excitation_offset_1", 0.05f},
                    {"excitation_level_time", 0.1f},
                    {"excitation_duration", 4.0f}}));
  b.host.request(Mode::levelling);
  b.run(6000);
  b.host.request(Mode::excitation);
  REQUIRE(b.until([&b] { return b.app->phase == sms::TestPhase::excite; }, 1000) > 0);
  b.run(1000);  // ten blend times
  for (int k = 1001; k < 3900; ++k) {
    b.step();
    REQUIRE(double(b.app->leg[0].command) == doctest::Approx(5.05).epsilon(1e-4));
    REQUIRE(double(b.app->leg[1].command) == doctest::Approx(5.0 + 0.7 * std::sin(M_PI * 1e-3 * k)).epsilon(1e-3));
    REQUIRE(double(b.app->leg[2].command) == doctest::Approx(5.0).epsilon(1e-4));
  }
  b.run(200);
  CHECK(b.mode() == Mode::levelling);
}

TEST_CASE("application: an open-loop test that runs into the end of the stroke is ended") {
  Bench b;
  b.run(200);
  REQUIRE(write(b, {{"excitation_offset_1", 1.5f}, {"excitation_level_time", 0.1f}, {"excitation_duration", 60.0f}}));
  b.host.request(Mode::levelling);
  b.run(3000);
  b.host.request(Mode::excitation);
  CHECK(b.until([&b] { return b.mode() == Mode::levelling; }, 3000) > 0);
  CHECK(b.plant.extension[0] < 0.395);
  CHECK(b.app->log.entry[(b.app->log.count - 1) % fw::events_kept].detail == sms::Word(sms::Reason::stroke_limit));
}

TEST_CASE("application: a closed-loop chirp is the set-point, within its limits") {
  Bench b;
  b.run(200);
  REQUIRE(write(b, {{"excitation_closed_loop", 1.0f},
                    {"excitation_waveform", 1.0f},
                    {"excitation_amplitude_1", 0.05f},
                    {"excitation_frequency_1", 0.1f},
                    {"excitation_last_frequency", 1.0f},
                    {"excitation_level_time", 4.0f},
                    {"excitation_duration", 10.0f}}));
  b.host.request(Mode::levelling);
  b.run(3000);
  b.host.request(Mode::excitation);
  REQUIRE(b.until([&b] { return b.app->phase == sms::TestPhase::excite; }, 5000) > 0);
  for (int k = 1; k < 9900; ++k) {
    b.step();
    const double wanted = double(b.app->derived.level_extension[0]) +
                          double(sms::excitation_at(b.app->derived.excitation, 0, 1e-3f * float(k)));
    if (k > 500) REQUIRE(double(b.app->leg[0].setpoint.position) == doctest::Approx(wanted).epsilon(1e-3));
  }
  CHECK(b.within_limits());
}

TEST_CASE("application: a set of parameters takes effect whole, or not at all") {
  Bench b;
  b.run(200);
  const fw::Parameters before = b.app->parameters.active;
  const auto unchanged = [&] { return std::memcmp(&before, &b.app->parameters.active, sizeof before) == 0; };
  const Long gain = Long(sms::index_of_proportional_gain), stroke = Long(sms::index_of_stroke);
  const auto begin = [&] {
    b.host.send(sms::frame::ParameterBegin{0, 0, fw::parameter_hash()});
    b.host.send(sms::frame::ParameterWrite{0, 0, gain, 7.0f});
    b.run(2);
  };
  SUBCASE("a write is missing") {
    begin();
    b.host.send(sms::frame::ParameterCommit{0, 0, 0, 2});
  }
  SUBCASE("the host falls silent") {
    begin();
    b.run(1100);
    b.host.send(sms::frame::ParameterCommit{0, 0, 0, 1});
  }
  SUBCASE("the host discards it") {
    begin();
    b.host.send(sms::frame::ParameterCommit{0, 0, 1, 1});
    b.host.send(sms::frame::ParameterCommit{0, 0, 0, 1});
  }
  SUBCASE("the machine would be impossible") {
    begin();
    b.host.send(sms::frame::ParameterWrite{0, 0, stroke, 0.1f});
    b.host.send(sms::frame::ParameterCommit{0, 0, 0, 2});
  }
  SUBCASE("a sensor would have no span") {
    begin();
    b.host.send(sms::frame::ParameterWrite{0, 0, Long(fw::index_of_calibration_extended_1), 228.0f});
    b.host.send(sms::frame::ParameterCommit{0, 0, 0, 2});
  }
  SUBCASE("a value is out of range") {
    begin();
    b.host.send(sms::frame::ParameterWrite{0, 0, stroke, -1.0f});
    b.host.send(sms::frame::ParameterCommit{0, 0, 0, 2});
  }
  SUBCASE("there are more than a transaction holds") {
    begin();
    for (int i = 0; i < fw::most_staged; ++i) {
      const int place = i < int(gain) ? i : i + 1;
      b.host.send(sms::frame::ParameterWrite{0, 0, Long(place), sms::param(b.app->parameters.active.machine, place)});
      b.run(2);
    }
    b.host.send(sms::frame::ParameterCommit{0, 0, 0, Long(fw::most_staged) + 1u});
  }
  SUBCASE("the hash is another's") {
    b.host.send(sms::frame::ParameterBegin{0, 0, fw::parameter_hash() ^ 1u});
    b.host.send(sms::frame::ParameterWrite{0, 0, gain, 7.0f});
    b.host.send(sms::frame::ParameterCommit{0, 0, 0, 1});
  }
  b.run(5);
  CHECK(unchanged());
  CHECK(write(b, {{"proportional_gain", 7.0f}}));
  CHECK(double(b.app->parameters.active.machine.proportional_gain) == doctest::Approx(7.0));
  CHECK(write(b, {{"proportional_gain", 6.0f}, {"derivative_gain", 0.2f}, {"proportional_gain", 5.0f}}));
  CHECK(double(b.app->parameters.active.machine.proportional_gain) == doctest::Approx(5.0));
}

TEST_CASE("application: a capture holds what the telemetry said") {
  Bench b;
  REQUIRE(b.track());
  const auto extension_2 = Long(sms::CaptureSignal::extension_2), command_3 = Long(sms::CaptureSignal::valve_command_3);
  const auto roll = Long(sms::CaptureSignal::roll);
  const Long level = sms::to_unsigned(0.2f, 1e-5f, -0.1f);
  b.host.send(
      sms::frame::CaptureSetup{0, 0, extension_2, command_3, roll, Long(sms::CaptureTrigger::crossing), 10, level});
  std::vector<sms::frame::Extension> extensions;
  std::vector<sms::frame::CaptureData> captured;
  for (int k = 0; k < 8000; ++k) {
    if (b.app->capture.state == sms::CaptureState::complete && captured.empty()) {
      b.host.send(sms::frame::CaptureRead{0, 0, 0, 200});
      captured.push_back({});
    }
    b.step();
    for (const sms::Frame& f : b.heard) {
      sms::frame::CaptureData d;
      if (f.identifier == sms::Word(sms::frame::CaptureData::identifier) && sms::unpack(f, d)) captured.push_back(d);
      sms::frame::Extension e;
      if (f.identifier == sms::Word(sms::frame::Extension::identifier) && sms::unpack(f, e)) extensions.push_back(e);
    }
  }
  REQUIRE(captured.size() == 201);
  for (size_t i = 1; i < captured.size(); ++i) {
    CHECK(captured[i].capture_number == i - 1);
    const Long time = (b.app->capture.start + 10u * Long(i - 1)) & 0xFFFFu;
    const float value = sms::from_unsigned(captured[i].capture_value_1, 1e-5f, -0.1f);
    for (size_t k = 1; k < extensions.size(); ++k) {  // telemetry every 10 ms: the capture lies between two of them
      if (extensions[k - 1].sample_time <= time && time <= extensions[k].sample_time) {
        const float low = std::min(extensions[k - 1].extension_2, extensions[k].extension_2);
        const float high = std::max(extensions[k - 1].extension_2, extensions[k].extension_2);
        CHECK(value >= low - 2e-4f);
        CHECK(value <= high + 2e-4f);
      }
    }
  }
}

TEST_CASE("parameters: every name leads to its own place, and no other word does") {
  fw::Parameters p;
#define SMS_PARAM(name, unit, least, value, most, uncertainty, source, doc)   \
  CHECK(fw::parameter_index(#name) == sms::index_of_##name);                  \
  CHECK(fw::parameter(p, sms::index_of_##name) == &p.machine.name);           \
  CHECK_FALSE(fw::is_live(sms::index_of_##name));                             \
  CHECK(p.machine.name >= fw::parameter_bounds(sms::index_of_##name)->lower); \
  CHECK(p.machine.name <= fw::parameter_bounds(sms::index_of_##name)->upper);
#include "sms/params.def"
#define SMS_SETTING(name, unit, least, value, most, live, doc)                \
  CHECK(fw::parameter_index(#name) == fw::index_of_##name);                   \
  CHECK(fw::parameter(p, fw::index_of_##name) == &p.settings.name);           \
  CHECK(fw::is_live(fw::index_of_##name) == ((live) != 0));                   \
  CHECK(p.settings.name >= fw::parameter_bounds(fw::index_of_##name)->lower); \
  CHECK(p.settings.name <= fw::parameter_bounds(fw::index_of_##name)->upper);
#include "settings.def"
  for (const char* word : {"", "position", "position_gain_", "osition_gain", "level"}) {
    CAPTURE(word);
    CHECK(fw::parameter_index(word) == -1);
  }
  for (const int index : {-1, int(sms::param_count), int(fw::first_setting) - 1, int(fw::end_of_settings)}) {
    CAPTURE(index);
    CHECK(fw::parameter_bounds(index) == nullptr);
    CHECK(fw::parameter(p, index) == nullptr);
    CHECK_FALSE(fw::is_live(index));
  }
}

TEST_CASE("application: random frames have no effect on the outputs") {
  // Two applications, one host; one of them also hears noise. Its outputs have to stay the same to the bit.
  sms_test::Random random;
  Bench quiet, noisy;
  REQUIRE(quiet.track());
  REQUIRE(noisy.track());
  long frames = 0, checked = 0;
  noisy.disturb = [&](std::vector<sms::Frame>& all) {
    for (int i = 0; i < 6; ++i) {
      sms::Frame f = {sms::Word(random.uniform(0.0, 2047.99)), sms::Word(random.uniform(0.0, 8.99)), {}};
      for (sms::Word& octet : f.octet) octet = sms::Word(random.uniform(0.0, 255.99));
      if (random.uniform(0.0, 1.0) < 0.9) f.length = 8;
      all.push_back(f);
      ++frames;
    }
  };
  while (frames < 10L * sms_test::count) {
    quiet.step();
    noisy.step();
    for (int i = 0; i < 3; ++i) REQUIRE(quiet.out.pulse_width[i] == noisy.out.pulse_width[i]);
    REQUIRE(noisy.mode() == Mode::tracking);
  }
  checked = long(noisy.app->link.corrupted);
  MESSAGE(frames << " random frames; " << checked << " (modulo 65536) had the identifier of a command and a wrong CRC");
}
