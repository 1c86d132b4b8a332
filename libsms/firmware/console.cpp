// What the console understands, and what it answers.
#include "console.hpp"

#include "application.hpp"

namespace sms {
namespace firmware {
namespace {

const char kHelp[] =
    "m MODE    disabled, levelling, tracking, excitation\r\n"
    "l LAW     proportional, pid, state_feedback\r\n"
    "k         acknowledge faults\r\n"
    "x A B C   set-point, extensions, m\r\n"
    "a R P H   set-point: roll, pitch, rad; height, m\r\n"
    "g NAME    read a parameter\r\n"
    "p NAME V  write one to the copy\r\n"
    "c         put the copy into effect\r\n"
    "u         discard the copy\r\n"
    "s         state: mode, extensions, m, commands, V, faults\r\n"
    "t MS      state again and again; t 0 ends it\r\n"
    "e         the log\r\n"
    "r         give up control\r\n"
    "v         version\r\n"
    "A line may end in *HH, the CRC-8 of what is before the star.\r\n";

constexpr int kLongestLine = 80;  // of what is written at once

void end_line(Console& c) { put(c.waiting, "\r\n"); }

void answer(Console& c, const char* what, const char* why = "") {
  put(c.waiting, what);
  put(c.waiting, why);
  end_line(c);
}

void answer(Console& c, Reason why) { why == Reason::none ? answer(c, "ok") : answer(c, "refused: ", name_of(why)); }

void answer(Console& c, ParameterResult result) {
  result == ParameterResult::ok ? answer(c, "ok") : answer(c, "refused: ", name_of(result));
}

bool same(const char* a, const char* b) {
  for (; *a != '\0' && *a == *b; ++a, ++b) {
  }
  return *a == *b;
}

// Control for the console when nobody has it.
bool has_control(Application& app) {
  if (app.link.session == nobody) {
    take_control_by(app, console_session);
  }
  if (app.link.session != console_session) {
    answer(app.console, Reason::not_in_control);
    return false;
  }
  return true;
}

void state(Application& app) {
  Console& c = app.console;
  put(c.waiting, name_of(app.mode));
  for (int i = 0; i < SMS_LEGS; ++i) {
    put(c.waiting, ' ');
    put_fixed(c.waiting, app.sensed.extension[i], 4);
  }
  for (int i = 0; i < SMS_LEGS; ++i) {
    put(c.waiting, ' ');
    put_fixed(c.waiting, app.leg[i].command, 2);
  }
  put(c.waiting, ' ');
  put(c.waiting, name_of(app.first_fault));
  end_line(c);
}

void mode(Application& app, Text t) {
  char word[16];
  Mode wanted = Mode::fault;
  if (read_word(t, word)) {
    for (int i = int(Mode::disabled); i <= int(Mode::excitation); ++i) {
      wanted = same(word, name_of(Mode(i))) ? Mode(i) : wanted;
    }
  }
  if (wanted == Mode::fault) {
    return answer(app.console, "which mode? disabled, levelling, tracking, excitation");
  }
  if (wanted == Mode::disabled || has_control(app)) {  // anybody may stop
    answer(app.console, request_mode(app, wanted, Reason::console));
  }
}

void law(Application& app, Text t) {
  char word[16];
  if (read_word(t, word)) {
    for (int i = int(ControlLaw::proportional); i <= int(ControlLaw::state_feedback); ++i) {
      if (same(word, name_of(ControlLaw(i)))) {
        if (has_control(app)) {
          request_law(app, ControlLaw(i));
          answer(app.console, "ok");
        }
        return;
      }
    }
  }
  answer(app.console, "which law? proportional, pid, state_feedback");
}

void setpoint(Application& app, Text t, bool is_attitude) {
  float value[3];
  if (!read_all_numbers(t, value, 3)) {
    return answer(app.console, is_attitude ? "three numbers: roll, pitch, rad; height, m" : "three numbers, m");
  }
  if (has_control(app)) {
    is_attitude ? take_attitude_setpoint(app, value, 0, console_session)
                : take_extension_setpoint(app, value, 0, console_session);
    answer(app.console, "ok");
  }
}

void read_parameter(Application& app, Text t) {
  char name[48];
  const int index = read_word(t, name) ? parameter_index(name) : -1;
  if (index < 0) {
    return answer(app.console, "there is no such parameter");
  }
  put_scientific(app.console.waiting, *parameter(app.parameters.active, index));
  end_line(app.console);
}

void write_parameter(Application& app, Text t) {
  char name[48];
  float value = 0.0f;
  const int index = read_word(t, name) ? parameter_index(name) : -1;
  if (index < 0 || !read_all_numbers(t, &value, 1)) {
    return answer(app.console, index < 0 ? "there is no such parameter" : "a name and a number");
  }
  if (!has_control(app)) {
    return;
  }
  const WriteAccess access = write_access(app);
  ParameterResult result = ParameterResult::ok;
  if (!app.parameters.open) {
    result = parameters_begin(app.parameters, access, parameter_hash(), app.now);
  }
  answer(app.console,
         result == ParameterResult::ok ? parameters_write(app.parameters, access, index, value, app.now) : result);
}

void commit(Application& app) {
  if (has_control(app)) {
    answer(app.console, commit_parameters(app, app.parameters.writes));
  }
}

void discard(Application& app) {
  if (has_control(app)) {
    app.parameters.open = false;
    answer(app.console, "ok");
  }
}

void repeat(Application& app, Text t) {
  float period = 0.0f;
  if (!read_all_numbers(t, &period, 1) || period < 0.0f || period > 60000.0f) {
    return answer(app.console, "a number of ms, to 60000");
  }
  app.console.repeat = Word(period);
  app.console.countdown = 0;
  answer(app.console, "ok");
}

void release(Application& app) {
  if (app.link.session != console_session) {
    return answer(app.console, Reason::not_in_control);
  }
  give_up_control(app);
  answer(app.console, "ok");
}

void obey(Application& app, char control, Text t) {
  Console& c = app.console;
  switch (control) {
    case 'h':
    case '?':
      c.help = kHelp;
      return;
    case 'm':
      return mode(app, t);
    case 'l':
      return law(app, t);
    case 'k':
      if (has_control(app)) {
        acknowledge(app);
        answer(c, "ok");
      }
      return;
    case 'x':
      return setpoint(app, t, false);
    case 'a':
      return setpoint(app, t, true);
    case 'g':
      return read_parameter(app, t);
    case 'p':
      return write_parameter(app, t);
    case 'c':
      return commit(app);
    case 'u':
      return discard(app);
    case 's':
      return state(app);
    case 't':
      return repeat(app, t);
    case 'e':
      c.log_to = app.log.count;
      c.log_from = c.log_to > Long(events_kept) ? c.log_to - Long(events_kept) : 0u;
      return;
    case 'r':
      return release(app);
    case 'v':
      return answer(c, SMS_VERSION);
    default:
      return answer(c, "unknown; help lists what there is");
  }
}

// Takes a check off the end of the line; false when it is wrong.
bool check(Text& t) {
  if (t.end - t.at < 3 || *(t.end - 3) != '*') {
    return true;
  }
  const int high = hexadecimal(*(t.end - 2)), low = hexadecimal(*(t.end - 1));
  Word crc = 0xFF;
  for (const char* c = t.at; c < t.end - 3; ++c) {
    crc = crc8_octet(crc, Word(*c & 0xFF));
  }
  t.end -= 3;
  return high >= 0 && low >= 0 && Word(16 * high + low) == Word(crc ^ 0xFFu);
}

void end_of_line(Application& app) {
  Console& c = app.console;
  Text t = {c.line, c.line + c.length};
  const bool too_long = c.too_long;
  c.length = 0;
  c.too_long = false;
  if (too_long) {
    return answer(c, "too long");
  }
  if (!check(t)) {
    return answer(c, "the check is wrong");
  }
  skip_spaces(t);
  if (t.at < t.end) {
    const char control = *t.at++;
    obey(app, control, t);
  }
}

void write_event(Application& app, const Event& e) {
  Console& c = app.console;
  put_fixed(c.waiting, 1.0e-3f * float(e.time), 3);
  put(c.waiting, ' ');
  put(c.waiting, name_of(e.kind));
  put(c.waiting, ' ');
  if (e.kind == EventKind::fault_raised || e.kind == EventKind::fault_cleared) {
    put(c.waiting, name_of(Fault(int(e.detail))));
  } else if (e.kind == EventKind::mode_changed || e.kind == EventKind::mode_refused) {
    put(c.waiting, name_of(e.after));
    put(c.waiting, ' ');
    put(c.waiting, name_of(Reason(int(e.detail))));
  } else {
    put_integer(c.waiting, e.detail);
  }
  end_line(c);
}

// Longer answers, as far as there is room.
void go_on(Application& app) {
  Console& c = app.console;
  while (c.help != nullptr && *c.help != '\0' && c.waiting.count < console_waiting / 2) {
    put(c.waiting, *c.help++);
  }
  if (c.log_from < c.log_to && c.waiting.count + kLongestLine < console_waiting) {
    write_event(app, app.log.entry[c.log_from++ % events_kept]);
  }
  if (c.repeat > 0 && c.countdown-- == 0) {
    c.countdown = Word(c.repeat - 1);
    if (c.waiting.count + kLongestLine < console_waiting) {
      state(app);
    }
  }
}

}  // namespace

void read_console(Application& app, const sms_hardware_inputs& in) {
  Console& c = app.console;
  for (int i = 0; i < SMS_CHARACTERS_IN && i < int(in.character_count); ++i) {
    const char character = char(in.characters[i] & 0x7F);
    if (character == '\r') {
      end_of_line(app);
    } else if (character >= ' ' && c.length < console_line) {
      c.line[c.length++] = character;
    } else if (character >= ' ') {
      c.too_long = true;
    }
  }
}

void write_console(Application& app, sms_hardware_outputs& out) {
  Console& c = app.console;
  go_on(app);
  while (out.character_count < Word(SMS_CHARACTERS_OUT) && c.waiting.count > 0) {
    out.characters[out.character_count++] = Word(c.waiting.character[c.waiting.first] & 0x7F);
    c.waiting.first = Word((c.waiting.first + 1) % console_waiting);
    --c.waiting.count;
  }
}

}  // namespace firmware
}  // namespace sms
