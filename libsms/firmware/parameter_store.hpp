// Parameters in two phases: the writes of a transaction wait in a list, and take effect together at once, or none does.
#pragma once

#include <utility>

#include "settings.hpp"
#include "sms/scalar.hpp"

namespace sms {
namespace firmware {

// Who may write what now.
enum class WriteAccess { none, live, all };

enum { transaction_timeout = 1000 /* ms */, most_staged = 128 };

// What a transaction changes: each parameter once, with the last value written to it. A list, for a second set of all
// parameters takes more memory than the rest of the store.
struct StagedWrites {
  Word index[most_staged];
  float value[most_staged];
  Word count;
};

struct ParameterStore {
  Parameters active;
  StagedWrites staged;
  bool open;    // a transaction is going on
  Word writes;  // accepted in it
  Long used;    // ms, when it was last touched
};

// The place of a parameter among the staged writes, staged.count when it is not among them.
inline int staged_place(const StagedWrites& staged, int index) {
  int place = 0;
  while (place < int(staged.count) && int(staged.index[place]) != index) {
    ++place;
  }
  return place;
}

// As the open transaction has it, or else as it is in effect; nullptr when there is no such index.
inline const float* stored_parameter(ParameterStore& store, int index) {
  const int place = staged_place(store.staged, index);
  return place < int(store.staged.count) ? &store.staged.value[place] : parameter(store.active, index);
}

// Puts the staged values into effect and the active ones into the list: called again, it takes that back.
inline void exchange_staged(ParameterStore& store) {
  for (int i = 0; i < int(store.staged.count); ++i) {
    std::swap(*parameter(store.active, int(store.staged.index[i])), store.staged.value[i]);
  }
}

inline ParameterResult parameters_begin(ParameterStore& store, WriteAccess access, Long hash, Long now) {
  store.open = false;
  if (hash != parameter_hash()) {
    return ParameterResult::wrong_hash;
  }
  if (access == WriteAccess::none) {
    return ParameterResult::moving;
  }
  store.staged.count = 0;
  store.open = true;
  store.writes = 0;
  store.used = now;
  return ParameterResult::ok;
}

inline ParameterResult parameters_write(ParameterStore& store, WriteAccess access, int index, float value, Long now) {
  if (!store.open) {
    return ParameterResult::no_transaction;
  }
  store.used = now;
  const ParameterBounds* bounds = parameter_bounds(index);
  if (bounds == nullptr) {
    return ParameterResult::unknown_index;
  }
  if (access == WriteAccess::none || (access == WriteAccess::live && !is_live(index))) {
    return ParameterResult::moving;
  }
  if (!is_finite(value)) {
    return ParameterResult::not_a_number;
  }
  if (value < bounds->lower || value > bounds->upper) {
    return ParameterResult::out_of_range;
  }
  const int place = staged_place(store.staged, index);
  if (place == most_staged) {
    return ParameterResult::too_many;
  }
  store.staged.index[place] = Word(index);
  store.staged.value[place] = value;
  if (place == int(store.staged.count)) {
    ++store.staged.count;
  }
  ++store.writes;
  return ParameterResult::ok;
}

// Whether the staged writes may take effect; it is the caller who exchanges them, and makes sure of the machine.
inline ParameterResult parameters_ready(ParameterStore& store, WriteAccess access, Word count) {
  if (!store.open) {
    return ParameterResult::no_transaction;
  }
  store.open = false;
  if (access == WriteAccess::none) {
    return ParameterResult::moving;
  }
  return count == store.writes ? ParameterResult::ok : ParameterResult::wrong_count;
}

}  // namespace firmware
}  // namespace sms
