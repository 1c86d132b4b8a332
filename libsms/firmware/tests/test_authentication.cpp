// Authentic commands: the published vectors of the hash, what a desk with the key may, and what nobody without it can.
#include <doctest/doctest.h>

#include "bench.hpp"
#include "random_cases.hpp"

namespace {

namespace fw = sms::firmware;
using bench::Bench;
using sms::Authenticity;
using sms::Frame;
using sms::Long;
using sms::Mode;
using sms::Octets8;
using sms::Word;

constexpr sms::SipKey kKey = {0x0706050403020100u, 0x0F0E0D0C0B0A0908u};
constexpr sms::SipKey kOther = {0x0706050403020100u, 0x0F0E0D0C0B0A0909u};

// Of the message 00 01 02 ... so long.
Octets8 hash_of_octets(int length) {
  sms::SipState s = sms::siphash_begin(kKey);
  Octets8 block = 0;
  for (int i = 0; i < length; ++i) {
    block |= Octets8(unsigned(i)) << (8 * (i % 8));
    if (i % 8 == 7) {
      s = sms::siphash_stir(s, block);
      block = 0;
    }
  }
  return sms::siphash_end(sms::siphash_stir(s, block | (Octets8(unsigned(length)) << 56)));
}

Bench keyed(const sms::SipKey& hosts = kKey) {
  Bench b;
  b.authenticate(kKey, hosts);
  return b;
}

Authenticity last_refusal(const Bench& b) {
  for (Long i = b.app->log.count; i > 0; --i) {
    const fw::Event& e = b.app->log.entry[(i - 1) % fw::events_kept];
    if (e.kind == sms::EventKind::not_authentic) return Authenticity(int(e.detail));
  }
  return Authenticity::authentic;
}

}  // namespace

TEST_CASE("authentication: SipHash-2-4 as its authors publish it") {
  // Appendix A of the paper, and vectors_sip64 of the reference implementation.
  CHECK(hash_of_octets(15) == 0xA129CA6149BE45E5u);
  CHECK(hash_of_octets(0) == 0x726FDB47DD0E0E31u);
  CHECK(hash_of_octets(1) == 0x74F839C593DC67FDu);
  CHECK(hash_of_octets(7) == 0xAB0200F58B01D137u);
  CHECK(hash_of_octets(8) == 0x93F5F5799A932462u);
  CHECK(hash_of_octets(22) == 0x93536795E3A33E88u);
  CHECK(hash_of_octets(63) == 0x958A324CEB064572u);
}

TEST_CASE("authentication: with the key a host does all that it does on an open bus") {
  Bench open, b = keyed();
  REQUIRE(open.track());
  REQUIRE(b.track());
  for (int k = 0; k < 3000; ++k) {
    open.step();
    b.step();
    for (int i = 0; i < 3; ++i) REQUIRE(open.out.pulse_width[i] == b.out.pulse_width[i]);
  }
  CHECK(b.app->link.corrupted == open.app->link.corrupted);
  CHECK(b.app->link.refused == open.app->link.refused);
  b.host.request(Mode::disabled);
  b.run(2);
  CHECK(b.mode() == Mode::disabled);
}

TEST_CASE("authentication: a wrong key, or none, moves nothing and is said") {
  Bench wrong = keyed(kOther), none = keyed();
  none.host.authenticates = false;
  for (Bench* b : {&wrong, &none}) {
    CHECK_FALSE(b->track());
    CHECK(b->mode() == Mode::disabled);
    CHECK(b->app->link.session == fw::nobody);
    CHECK(b->at_centre());
    CHECK(b->has(sms::Fault::link_disturbed));
  }
  CHECK(last_refusal(wrong) == Authenticity::wrong_mac);
  CHECK(wrong.app->link.corrupted > 30);
  CHECK(last_refusal(none) == Authenticity::no_authenticator);
  CHECK(none.app->link.refused > 30);
}

TEST_CASE("authentication: a stop needs the key too, but not control") {
  Bench b = keyed();
  REQUIRE(b.track());
  bench::Host other = b.host;
  other.session = 9;
  other.counter = 0;
  other.authenticates = false;
  other.request(Mode::disabled);
  b.others.push_back(other);
  b.others[0].heartbeats = b.others[0].setpoints = false;
  b.run(5);
  CHECK(b.mode() == Mode::tracking);
  b.others[0].authenticates = true;
  b.others[0].request(Mode::disabled);
  b.run(2);
  CHECK(b.mode() == Mode::disabled);
}

TEST_CASE("authentication: each frame once, in its order, in its time, and only of this session") {
  Bench b = keyed();
  REQUIRE(b.track());
  std::vector<Frame> pair, late;
  b.host.setpoints = false;
  const auto send = [&b](const std::vector<Frame>& frames) {
    b.host.out.insert(b.host.out.end(), frames.begin(), frames.end());
    b.run(1);
  };
  const auto setpoint = [&b] {
    b.host.setpoint(0.0f, 0.0f, 0.5f);
    std::vector<Frame> made;
    made.swap(b.host.out);
    return made;
  };
  b.run(1);
  const auto taken_at = [&b] { return b.app->target.when; };
  const auto is_taken = [&](const std::vector<Frame>& frames) {
    send(frames);
    return taken_at() == b.app->now;
  };
  pair = setpoint();
  CHECK(is_taken(pair));
  CHECK_FALSE(is_taken(pair));  // again
  late = setpoint();
  pair = setpoint();
  CHECK(is_taken(pair));
  CHECK_FALSE(is_taken(late));  // after its successor
  pair = setpoint();
  CHECK_FALSE(is_taken({pair[1]}));  // without
  CHECK_FALSE(is_taken({pair[0]}));  // its authenticator alone
  b.run(fw::authenticator_timeout);
  CHECK_FALSE(is_taken({pair[1]}));  // too late
  pair = setpoint();
  pair[1].octet[2] ^= 1u;
  sms::seal(pair[1], b.host.challenge);
  pair[0].octet[2] = pair[1].octet[0];
  CHECK_FALSE(is_taken(pair));  // another content
  CHECK(is_taken(setpoint()));
  b.host.counter += fw::largest_counter_step;
  CHECK_FALSE(is_taken(setpoint()));  // beyond the window
  // The same after control was released: the nonce is another.
  const Octets8 before = b.app->authentication.nonce;
  pair = setpoint();
  b.host.heartbeats = false;
  b.run(400);
  CHECK(b.app->link.session == fw::nobody);
  CHECK(b.app->authentication.nonce != before);
  b.host.heartbeats = true;
  b.run(200);
  REQUIRE(b.app->link.session == b.host.session);
  sms::seal(pair[1], b.app->link.challenge);
  pair[0].octet[2] = pair[1].octet[0];
  CHECK_FALSE(is_taken(pair));
}

TEST_CASE("authentication: an open controller does not mind authenticators, and sends no nonce") {
  Bench b;
  b.host.authenticates = true;
  CHECK(b.track());
  CHECK(b.host.nonce == 0);
  CHECK(b.app->link.corrupted == 0);
}

namespace {

// Somebody on the bus who hears all, knows the protocol and lacks the key.
struct Attacker {
  sms_test::Random random;
  std::vector<Frame> heard;  // authenticator, command, authenticator, ...
  Word any(double most) { return Word(random.uniform(0.0, most + 0.999)); }

  void listen(const std::vector<Frame>& all) {
    for (size_t i = 0; i + 1 < all.size(); ++i) {
      const bool pair = all[i].identifier == Word(sms::frame::CommandAuthenticator::identifier);
      if (pair && heard.size() < 2000) heard.insert(heard.end(), {all[i], all[i + 1]});
    }
  }
  // CRC, and the authenticator's copy of it, as they have to be.
  static void fit(Frame& authenticator, Frame& command, Word challenge) {
    sms::seal(command, challenge);
    authenticator.octet[2] = command.octet[0];
    authenticator.octet[1] = Word((authenticator.octet[1] & 0xFu) | (command.octet[1] & 0xF0u));
  }
  std::vector<Frame> attack(const fw::Application& app) {
    const size_t which = 2 * size_t(random.uniform(0.0, double(heard.size() / 2) - 0.001));
    Frame authenticator = heard[which], command = heard[which + 1];
    const Word session = app.link.session;
    const Long next = app.authentication.counter[session & 0xFu] + 1u + any(3);
    const auto continued = [&] {  // session and counters go on where the host's are
      const int number = fw::command_number(command.identifier);
      command.octet[1] = Word(((app.link.alive[number].last + 1u) & 0xFu) | unsigned(session << 4));
      authenticator.octet[0] = Word(next & 0xFFu);
      authenticator.octet[1] = Word((next >> 8) & 0xFu);
    };
    switch (any(7)) {
      case 0:  // replayed
        break;
      case 1:  // replayed, with a fresh counter and CRC
        continued();
        fit(authenticator, command, app.link.challenge);
        break;
      case 2:  // other content, its MAC kept
        continued();
        command.octet[2 + any(5)] = any(255);
        fit(authenticator, command, app.link.challenge);
        break;
      case 3:  // forged: a guessed MAC
        continued();
        for (int i = 3; i < 8; ++i) authenticator.octet[i] = any(255);
        fit(authenticator, command, app.link.challenge);
        break;
      case 4:  // a forged stop, of any session
        command = sms::pack(sms::frame::ModeRequest{any(15), Long(1 + any(13)), 0, 0, 0});
        for (int i = 3; i < 8; ++i) authenticator.octet[i] = any(255);
        fit(authenticator, command, app.link.challenge);
        break;
      case 5:  // a bit of the MAC, or the length of a frame
        continued();
        any(1) == 0 ? void(authenticator.octet[3 + any(4)] ^= Word(1u << any(7))) : void(command.length = any(7));
        fit(authenticator, command, app.link.challenge);
        break;
      case 6:  // a right CRC and nothing before it
        continued();
        sms::seal(command, app.link.challenge);
        return {command};
      default:  // another's authenticator
        continued();
        authenticator = heard[2 * size_t(random.uniform(0.0, double(heard.size() / 2) - 0.001))];
        fit(authenticator, command, app.link.challenge);
    }
    return {authenticator, command};
  }
};

// Attacks, one a millisecond, which with the host's pair fills the bus, until there were so many, or until a valve command
// differs from that of a bus without them. flooded: until a set-point of the host was refused, since by chance so many
// authenticators had its CRC that the period's checks were used up.
long attacked(Attacker& attacker, Bench& quiet, Bench& noisy, long most, bool& flooded) {
  attacker.heard.clear();
  long attacks = 0;
  noisy.disturb = [&](std::vector<Frame>& all) {
    attacker.listen(all);
    if (attacker.heard.size() < 20) return;
    size_t at = 0;
    for (const Frame& f : attacker.attack(*noisy.app)) {  // anywhere, between the host's two also
      at = size_t(attacker.random.uniform(double(at), double(all.size()) + 0.999));
      all.insert(all.begin() + long(at), f);
      at += 1;
    }
    ++attacks;
  };
  while (attacks < most) {
    quiet.step();
    noisy.step();
    const Long wanted = quiet.app->target.when, taken = noisy.app->target.when;
    flooded = taken < wanted && noisy.app->authentication.checks == Word(fw::most_checks);
    if (flooded) return attacks;
    for (int i = 0; i < 3; ++i) {
      if (quiet.out.pulse_width[i] != noisy.out.pulse_width[i]) return attacks;
    }
  }
  return attacks;
}

}  // namespace

TEST_CASE("authentication: forged, replayed, reordered and stale frames change no valve command") {
  const long most = 3L * sms_test::count;
  Attacker attacker;
  long attacks = 0, floods = 0;
  while (attacks < most) {
    Bench quiet = keyed(), noisy = keyed();
    REQUIRE(quiet.track());
    REQUIRE(noisy.track());
    bool flooded = false;
    attacks += attacked(attacker, quiet, noisy, most - attacks, flooded);
    REQUIRE((flooded || attacks >= most));
    floods += flooded ? 1 : 0;
    CHECK(noisy.mode() == Mode::tracking);
    CHECK(quiet.mode() == Mode::tracking);
  }
  CHECK(floods <= 2 + attacks / 10000);  // a set-point that is late by one; nothing forged is obeyed
  MESSAGE(attacks << " attacks, " << floods << " times a set-point of the host refused");
}

TEST_CASE("authentication: the same attacks on an open controller do change one") {
  Bench quiet, noisy;
  quiet.host.authenticates = noisy.host.authenticates = true;  // so that there is the same to replay
  REQUIRE(quiet.track());
  REQUIRE(noisy.track());
  Attacker attacker;
  bool flooded = false;
  CHECK(attacked(attacker, quiet, noisy, 3000, flooded) < 3000);
  CHECK_FALSE(flooded);
}

TEST_CASE("authentication: a flood costs a bounded number of MACs, and the host goes on after it") {
  Bench b = keyed();
  REQUIRE(b.track());
  sms_test::Random random;
  bool flooded = true;
  b.disturb = [&](std::vector<Frame>& all) {
    if (!flooded) return;
    all.clear();
    for (Word i = 0; i < 4; ++i) {  // four authenticators that all fit four commands
      all.push_back(sms::pack(sms::frame::CommandAuthenticator{b.app->authentication.counter[5] + 1u + i, 5, 0,
                                                               Long(random.uniform(0.0, 4.0e9)), i}));
    }
    Frame f = sms::pack(sms::frame::AttitudeSetpoint{0, 5, 0.01f, 0.0f, 0.5f});
    sms::seal(f, b.app->link.challenge);
    for (int i = 0; i < 4; ++i) {
      all[size_t(i)].octet[2] = f.octet[0];
      all.push_back(f);
    }
  };
  for (int k = 0; k < 50; ++k) {
    b.step();
    REQUIRE(b.app->authentication.checks <= fw::most_checks);
  }
  CHECK(b.app->authentication.checks == fw::most_checks);
  flooded = false;
  b.run(20);
  CHECK(b.mode() == Mode::tracking);
  CHECK(b.app->target.fresh);
}
