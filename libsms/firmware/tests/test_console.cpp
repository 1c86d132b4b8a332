// The console: what a person types, what comes back, and that nothing else changes anything.
#include <doctest/doctest.h>

#include <cstring>
#include <string>

#include "bench.hpp"
#include "random_cases.hpp"

namespace {

using bench::Bench;
using sms::Mode;

// Types a line and gives what was written within `wait` ms.
std::string type(Bench& b, const std::string& line, int wait = 100) {
  std::string written;
  size_t next = 0;
  for (int i = 0; i < wait || next < line.size(); ++i) {
    for (; next < line.size() && b.in.character_count < sms::Word(SMS_CHARACTERS_IN); ++next) {
      b.in.characters[b.in.character_count++] = sms::Word(line[next]);
    }
    b.step();
    for (int k = 0; k < int(b.out.character_count); ++k) written += char(b.out.characters[k]);
  }
  return written;
}

Bench alone() {
  Bench b;
  b.host.heartbeats = b.host.setpoints = false;
  return b;
}

std::string with_check(const std::string& line) {
  sms::Word crc = 0xFF;
  for (const char c : line) crc = sms::crc8_octet(crc, sms::Word(c));
  char text[8];
  std::snprintf(text, sizeof text, "*%02X", unsigned(crc ^ 0xFFu));
  return line + text;
}

}  // namespace

TEST_CASE("console: help lists every control character it knows") {
  Bench b = alone();
  const std::string help = type(b, "help\r", 400);
  for (const char c : std::string("lkxagpcusterv")) CHECK(help.find(std::string("\n") + c + " ") != std::string::npos);
  CHECK(help.compare(0, 2, "m ") == 0);
  CHECK(help.find('~') == std::string::npos);
}

TEST_CASE("console: a person levels and moves the platform without a host") {
  Bench b = alone();
  CHECK(type(b, "m levelling\r") == "ok\r\n");
  CHECK(b.mode() == Mode::levelling);
  CHECK(b.app->link.session == bench::fw::console_session);
  CHECK(type(b, "a 0.02 -0.01 0.5\r") == "ok\r\n");
  CHECK(type(b, "m tracking\r") == "ok\r\n");
  b.run(4000);  // nobody types: the set-point holds
  CHECK(b.mode() == Mode::tracking);
  CHECK(b.app->leg[0].setpoint.position == doctest::Approx(double(b.app->target.extension[0])));
  CHECK(type(b, "l state_feedback\r") == "ok\r\n");
  CHECK(b.app->law == sms::ControlLaw::state_feedback);
  CHECK(type(b, "m disabled\r") == "ok\r\n");
  CHECK(b.mode() == Mode::disabled);
  CHECK(type(b, "r\r") == "ok\r\n");
  CHECK(b.app->link.session == bench::fw::nobody);
}

TEST_CASE("console: parameters in two phases") {
  Bench b = alone();
  CHECK(type(b, "g proportional_gain\r") == "2.000000e+00\r\n");
  CHECK(type(b, "p proportional_gain 12.5\r") == "ok\r\n");
  CHECK(type(b, "g proportional_gain\r") == "2.000000e+00\r\n");
  CHECK(type(b, "c\r") == "ok\r\n");
  CHECK(type(b, "g proportional_gain\r") == "1.250000e+01\r\n");
  CHECK(type(b, "p adc_bits 99\r") == "refused: out_of_range\r\n");
  CHECK(type(b, "p no_such_thing 1\r") == "there is no such parameter\r\n");
  CHECK(type(b, "m levelling\r") == "ok\r\n");
  CHECK(type(b, "p proportional_gain 3\r") == "refused: moving\r\n");
  CHECK(type(b, "p excitation_amplitude_1 0.7\r") == "ok\r\n");
  CHECK(type(b, "c\r") == "ok\r\n");
  CHECK(b.app->derived.excitation.amplitude[0] == doctest::Approx(0.7));
}

TEST_CASE("console: a check, when there is one, has to be right") {
  Bench b = alone();
  CHECK(type(b, with_check("m levelling") + "\r") == "ok\r\n");
  CHECK(b.mode() == Mode::levelling);
  std::string wrong = with_check("m disabled");
  wrong[2] = 'D';
  CHECK(type(b, wrong + "\r") == "the check is wrong\r\n");
  CHECK(b.mode() == Mode::levelling);
}

TEST_CASE("console: what is not understood is answered and changes nothing") {
  Bench b = alone();
  CHECK(type(b, "m\r").find("which mode") == 0);
  CHECK(type(b, "m flying\r").find("which mode") == 0);
  CHECK(type(b, "x 0.1 0.2\r") == "three numbers, m\r\n");
  CHECK(type(b, "x 0.1 0.2 nan\r") == "three numbers, m\r\n");
  CHECK(type(b, "x 0.1 0.2 1e99\r") == "three numbers, m\r\n");
  CHECK(type(b, "z\r").find("unknown") == 0);
  CHECK(type(b, std::string(200, 'a') + "\r") == "too long\r\n");
  CHECK(type(b, "\r") == "");
  CHECK(b.mode() == Mode::disabled);
  CHECK(b.app->link.session == bench::fw::nobody);
}

TEST_CASE("console: with a host in control it may look and stop, no more") {
  Bench b;
  REQUIRE(b.track());
  CHECK(type(b, "m levelling\r") == "refused: not_in_control\r\n");
  CHECK(type(b, "a 0 0 0.5\r") == "refused: not_in_control\r\n");
  CHECK(type(b, "s\r").find("tracking 0.") == 0);
  CHECK(b.mode() == Mode::tracking);
  CHECK(type(b, "m disabled\r") == "ok\r\n");
  CHECK(b.mode() == Mode::disabled);
}

TEST_CASE("console: the log tells every transition") {
  Bench b;
  REQUIRE(b.track());
  const std::string log = type(b, "e\r", 400);
  CHECK(log.find("reset 0\r\n") != std::string::npos);
  CHECK(log.find("mode_changed levelling request\r\n") != std::string::npos);
  CHECK(log.find("mode_changed tracking request\r\n") != std::string::npos);
}

TEST_CASE("console: numbers are written and read back") {
  sms_test::Random random;
  for (int k = 0; k < 2000; ++k) {
    const float value = float(random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-30.0, 30.0)));
    sms::firmware::TextRing<64> ring = {};
    sms::firmware::put_scientific(ring, value);
    sms::firmware::Text text = {ring.character, ring.character + ring.count};
    float read = 0.0f;
    REQUIRE(sms::firmware::read_number(text, read));
    CHECK(double(read) == doctest::Approx(double(value)).epsilon(2e-5));
  }
  sms::firmware::TextRing<64> ring = {};
  sms::firmware::put_fixed(ring, -0.99996f, 4);
  CHECK(std::string(ring.character, ring.count) == "-1.0000");
}

TEST_CASE("console: whatever is typed, the platform of a host goes on") {
  sms_test::Random random;
  Bench b;
  REQUIRE(b.track());
  for (int k = 0; k < 20000; ++k) {
    b.in.character_count = 0;
    for (int i = 0; i < 12; ++i) {
      const char c = char(random.uniform(0.0, 1.0) < 0.1 ? '\r' : random.uniform(0.0, 127.99));
      b.in.characters[b.in.character_count++] = sms::Word(c == 'm' ? 'M' : c);  // `m disabled` would be obeyed
    }
    b.step();
    REQUIRE(b.mode() == Mode::tracking);
  }
  CHECK(b.within_limits());
}
