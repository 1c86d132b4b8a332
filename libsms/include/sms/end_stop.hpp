// The ends of the stroke: contact and cushioning, forces on the piston rod, N, positive pushing it out.
//
// Beyond an end by d > 0 metal stands on metal. The contact pushes back and never pulls (Hunt and Crossley),
//
//   F = k d max(0, 1 + c d')
//
// which is continuous at touch. Its elastic part k d gives back what it took; the rest, k c d d', always takes energy
// (k c d d'^2 >= 0), and where the bracket is cut at zero less is given back. So no energy is made. The speed after an
// impact at v is about (1 - 2/3 c v) v for small c v.
//
// End cushioning throttles the exhaust over the last cushion_length before an end, and only on the way there (a check
// valve opens on the way back). What it takes belongs to the pneumatics; a cylinder whose cushion is known only as a
// damper has it here: a damper that grows from nothing to cushion_damping at the very end. Absent by default.
#pragma once

#include "sms/params.hpp"

namespace sms {

// Force that pushes away from an end, from the depth beyond it and its rate.
template <typename S>
S contact_force(const Params<S>& p, const S& depth, const S& depth_rate) {
  const S bracket = S(1) + p.end_stop_damping * depth_rate;
  return depth > S(0) && bracket > S(0) ? p.end_stop_stiffness * depth * bracket : S(0);
}

// Force against the approach to an end, from the distance to it and the speed towards it.
template <typename S>
S cushion_force(const Params<S>& p, const S& distance, const S& approach) {
  if (!(approach > S(0)) || !(distance < p.cushion_length)) {
    return S(0);
  }
  const S engaged = distance > S(0) ? S(1) - distance / p.cushion_length : S(1);
  return p.cushion_damping * engaged * approach;
}

template <typename S>
S end_stop_force(const Params<S>& p, const S& extension, const S& velocity) {
  const S left = p.stroke - extension;
  const S retracted = contact_force(p, S(-extension), S(-velocity)) + cushion_force(p, extension, S(-velocity));
  const S extended = contact_force(p, S(-left), velocity) + cushion_force(p, left, velocity);
  return retracted - extended;
}

// J, stored in the contact.
template <typename S>
S end_stop_energy(const Params<S>& p, const S& extension) {
  const S beyond = extension < S(0) ? extension : (extension > p.stroke ? extension - p.stroke : S(0));
  return S(0.5) * p.end_stop_stiffness * beyond * beyond;
}

}  // namespace sms
