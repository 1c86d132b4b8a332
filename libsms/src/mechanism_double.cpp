#include "sms/compiled_mechanism.hpp"

SMS_MECHANISM_IN_DOUBLE(template)

#define SMS_REAL double
#define SMS_F(name) name
#include "abi_dynamics.inc"
#include "abi_kinematics.inc"
#include "abi_params.inc"
#include "abi_table.inc"
