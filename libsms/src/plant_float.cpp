#define SMS_REAL float
#define SMS_F(name) name##f
#include "abi_controller.inc"
#include "abi_friction.inc"
#include "abi_plant.inc"
#include "abi_pneumatics.inc"
