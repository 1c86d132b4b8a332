// Temperature from a type K thermocouple (dissertation, section 5.2.2, Table C.1).
//
//   T = T_cj + sum c_i E^i,   E in mV, amplified 500 times                       (eq. 5.11, 5.12)
//
// The coefficients are NIST's inverse function for 0 to 500 degC (E up to 20.644 mV; the text says 0 to 1372 degC).
// Adding the cold junction's temperature instead of its voltage, as the source does, is exact only at 0 degC: around
// room temperature the slope of the thermocouple changes little, and the error stays below about 1 K up to 200 K of
// difference.
#pragma once

#include "sms/params.hpp"

namespace sms {

// K over the cold junction, from the thermocouple's own voltage in V.
template <typename S>
S thermocouple_difference(const S& emf) {
  const S c[10] = {S(0.0),          S(2.508355e1),  S(7.860106e-2),  S(-2.503131e-1), S(8.315270e-2),
                   S(-1.228034e-2), S(9.804036e-4), S(-4.413030e-5), S(1.057734e-6),  S(-1.052755e-8)};
  const S millivolts = S(1e3) * emf;
  S sum = c[9];
  for (int i = 8; i >= 0; --i) {
    sum = sum * millivolts + c[i];
  }
  return sum;
}

// K, from the amplified voltage and the temperature of the cold junction.
template <typename S>
S thermocouple_temperature(const Params<S>& p, const S& voltage, const S& cold_junction) {
  return cold_junction + thermocouple_difference<S>(voltage / p.thermocouple_gain);
}

}  // namespace sms
