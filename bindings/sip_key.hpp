// A key of the bus: 16 bytes in Python, two words in the core.
#pragma once

#include <string>

#include "bind.hpp"
#include "sms/siphash.hpp"

namespace sms_python {

// No bytes: no key, which the core writes as zeros.
inline sms::SipKey sip_key(const py::bytes& key) {
  const auto octets = static_cast<std::string>(key);
  if (!octets.empty() && octets.size() != 16) {
    throw py::value_error("a key has 16 octets");
  }
  sms::Octets8 half[2] = {0, 0};
  for (std::size_t i = 0; i < octets.size(); ++i) {
    half[i / 8] |= sms::Octets8(static_cast<unsigned char>(octets[i])) << (8 * (i % 8));
  }
  return {half[0], half[1]};
}

}  // namespace sms_python
