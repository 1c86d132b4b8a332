// The dynamics of the mechanism in double are in the archive libsms (src/mechanism_double.cpp): a file that includes this
// in place of dynamics.hpp takes them from there, and compiles some seconds faster. Without the archive include
// dynamics.hpp.
#pragma once

#include "sms/dynamics.hpp"

// which: `template` in the one file that compiles them, `extern template` in all others.
#define SMS_MECHANISM_IN_DOUBLE(which)                                                                                 \
  which sms::Mechanism<double> sms::make_mechanism(const sms::Params<double>&, sms::MassModel);                        \
  which void sms::evaluate_dynamics(const sms::Mechanism<double>&, const sms::Pose<double>&, const sms::Vec3<double>&, \
                                    sms::DynamicsTerms<double>&);

SMS_MECHANISM_IN_DOUBLE(extern template)
