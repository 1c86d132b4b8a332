// Frames that are lost, corrupted, duplicated, reordered, delayed or replayed.
#pragma once

#include "fault_case.hpp"

namespace bench {

// 30 percent of all command frames for a minute; `what` changes the frames of a millisecond.
inline Outcome disturbed_minute(Bench& b, const std::function<bool(std::vector<Frame>&)>& what,
                                Word (*counter)(const fw::CommandLink&)) {
  Outcome o = {-1, b.track(), false, false};
  int since = 0, tracking = 0;
  bool began = false;
  b.disturb = [&](std::vector<Frame>& frames) { began = what(frames) || began; };
  for (int i = 0; i < 60000; ++i) {
    b.step();
    since += began && o.detected < 0 ? 1 : 0;
    if (o.detected < 0 && b.has(Fault::link_disturbed)) o.detected = since;
    o.reaction = o.reaction && (b.mode() == Mode::tracking || b.mode() == Mode::levelling);
    tracking += b.mode() == Mode::tracking ? 1 : 0;
    if (b.mode() == Mode::levelling && i % 100 == 0) b.host.request(Mode::tracking);
  }
  o.reaction = o.reaction && counter(b.app->link) > 0 && tracking > 57000;
  b.disturb = nullptr;
  b.run(1200);
  o.back = !b.has(Fault::link_disturbed) && b.track();
  o.within = b.within_limits();
  return o;
}

inline Outcome lost_frames() {
  Bench b;
  const auto lose = [&b](std::vector<Frame>& frames) {
    std::vector<Frame> kept;
    for (const Frame& f : frames) {
      if (!b.bad_luck()) kept.push_back(f);
    }
    const bool lost = kept.size() < frames.size();
    frames = kept;
    return lost;
  };
  return disturbed_minute(b, lose, [](const fw::CommandLink& l) { return l.lost; });
}

inline Outcome corrupted_frames() {
  Bench b;
  const auto corrupt = [&b](std::vector<Frame>& frames) {
    bool any = false;
    for (Frame& f : frames) {
      if (!b.bad_luck()) continue;
      const unsigned bit = unsigned(b.random() % 64u);
      f.octet[bit / 8] = Word(f.octet[bit / 8] ^ (1u << (bit % 8)));
      any = true;
    }
    return any;
  };
  return disturbed_minute(b, corrupt, [](const fw::CommandLink& l) { return l.corrupted; });
}

inline Outcome duplicated_frames() {
  Bench b;
  const auto duplicate = [&b](std::vector<Frame>& frames) {
    std::vector<Frame> twice;
    for (const Frame& f : frames) {
      twice.push_back(f);
      if (b.bad_luck()) twice.push_back(f);
    }
    const bool any = twice.size() > frames.size();
    frames = twice;
    return any;
  };
  return disturbed_minute(b, duplicate, [](const fw::CommandLink& l) { return l.out_of_sequence; });
}

// A frame is held back until `delay` ms later, so that the ones behind it overtake it.
struct Late {
  Frame frame;
  long due;
};

// Whether a frame arrives whose predecessor has not.
struct Sequence {
  Word last[fw::command_identifiers] = {};
  bool known[fw::command_identifiers] = {};
  bool broken_by(const Frame& f) {
    const int number = fw::command_number(f.identifier);
    const Word alive = fw::alive_of(f);
    const bool broken = known[number] && alive != Word((last[number] + 1u) & 0xFu);
    last[number] = alive;
    known[number] = true;
    return broken;
  }
};

inline Outcome late_frames(int least, int most) {
  Bench b;
  std::vector<Late> held;
  Sequence sequence;
  const auto hold = [&](std::vector<Frame>& frames) {
    std::vector<Frame> now;
    for (const Frame& f : frames) {
      if (b.bad_luck()) {
        held.push_back({f, b.k + least + long(b.random() % unsigned(most - least + 1))});
      } else {
        now.push_back(f);
      }
    }
    for (size_t i = 0; i < held.size();) {
      if (held[i].due <= b.k) {
        now.push_back(held[i].frame);
        held.erase(held.begin() + long(i));
      } else {
        ++i;
      }
    }
    bool overtaken = false;
    for (const Frame& f : now) overtaken = sequence.broken_by(f) || overtaken;
    frames = now;
    return overtaken;
  };
  return disturbed_minute(b, hold, [](const fw::CommandLink& l) { return l.out_of_sequence; });
}

inline Outcome reordered_frames() { return late_frames(11, 19); }
inline Outcome delayed_frames() { return late_frames(20, 80); }

// Recorded frames played onto the bus while the host is at work.
inline Outcome replayed_frames() {
  Bench b;
  std::vector<Frame> recorded;
  const bool ready = b.track();
  b.disturb = [&](std::vector<Frame>& frames) { recorded.insert(recorded.end(), frames.begin(), frames.end()); };
  b.run(3000);
  b.disturb = nullptr;
  size_t next = 0;
  const auto play = [&](std::vector<Frame>& frames) {
    if (b.k % 7 != 0 || frames.size() > 3) return false;
    frames.push_back(recorded[next++ % recorded.size()]);
    return true;
  };
  Outcome o = disturbed_minute(b, play, [](const fw::CommandLink& l) { return l.out_of_sequence; });
  o.reaction = o.reaction && ready;
  return o;
}

// The same recording once its host is gone: nothing of it is obeyed.
inline Outcome replayed_recording() {
  Bench b;
  std::vector<Frame> recorded;
  Outcome o = {-1, b.track(), false, false};
  b.disturb = [&](std::vector<Frame>& frames) { recorded.insert(recorded.end(), frames.begin(), frames.end()); };
  b.host.request(Mode::levelling);
  b.run(500);
  b.host.request(Mode::tracking);
  b.run(500);
  b.disturb = nullptr;
  b.host.heartbeats = b.host.setpoints = false;
  b.run(1500);  // levelling, control released
  size_t next = 0;
  b.disturb = [&](std::vector<Frame>& frames) {
    if (next < recorded.size()) frames.push_back(recorded[next++]);
  };
  o.detected = b.until([&b] { return b.has(Fault::link_disturbed); }, 100);
  for (size_t i = 0; i < recorded.size(); ++i) {
    b.step();
    o.reaction = o.reaction && b.mode() == Mode::levelling && b.app->link.session == fw::nobody;
  }
  b.disturb = nullptr;
  b.host.heartbeats = b.host.setpoints = true;
  b.run(300);
  o.back = b.track();
  o.within = b.within_limits();
  return o;
}

}  // namespace bench
