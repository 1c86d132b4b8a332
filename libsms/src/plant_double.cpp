#include "sms/compiled_mechanism.hpp"

#define SMS_REAL double
#define SMS_F(name) name
#include "abi_controller.inc"
#include "abi_friction.inc"
#include "abi_plant.inc"
#include "abi_pneumatics.inc"
