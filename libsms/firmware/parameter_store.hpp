// Parameters in two phases: a transaction writes to a copy, and the whole copy takes effect at once, or nothing of it.
#pragma once

#include "settings.hpp"
#include "sms/scalar.hpp"

namespace sms {
namespace firmware {

// Who may write what now.
enum class WriteAccess { none, live, all };

struct ParameterStore {
  Parameters active;
  Parameters staged;
  bool open;    // a transaction is going on
  Word writes;  // accepted in it
  Long used;    // ms, when it was last touched
};

enum { transaction_timeout = 1000 /* ms */ };

inline ParameterResult parameters_begin(ParameterStore& store, WriteAccess access, Long hash, Long now) {
  store.open = false;
  if (hash != parameter_hash()) {
    return ParameterResult::wrong_hash;
  }
  if (access == WriteAccess::none) {
    return ParameterResult::moving;
  }
  store.staged = store.active;
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
  *parameter(store.staged, index) = value;
  ++store.writes;
  return ParameterResult::ok;
}

// Whether the staged set may take effect; it is the caller who puts it there, after making sure of the machine.
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
