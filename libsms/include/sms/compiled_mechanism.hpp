// The dynamics of the mechanism in double take a compiler seconds. Who links the archive libsms and includes this in place
// of dynamics.hpp takes them from there (src/mechanism_double.cpp).
#pragma once

#include "sms/dynamics.hpp"

// which: template, for what compiles them, or extern template
#define SMS_MECHANISM_IN_DOUBLE(which)                                                                                 \
  which sms::Mechanism<double> sms::make_mechanism(const sms::Params<double>&, sms::MassModel);                        \
  which void sms::evaluate_dynamics(const sms::Mechanism<double>&, const sms::Pose<double>&, const sms::Vec3<double>&, \
                                    sms::DynamicsTerms<double>&);

SMS_MECHANISM_IN_DOUBLE(extern template)
