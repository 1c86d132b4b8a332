#define SMS_REAL float
#define SMS_F(name) name##f
#include "abi_dynamics.inc"
#include "abi_kinematics.inc"
#include "abi_params.inc"
#include "abi_table.inc"
